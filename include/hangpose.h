// hangpose: predicts where and how to hang an object that a robot has never seen on a supporter that it has never
// seen.
//
// Generated from ffi/src by `make header`. Edit the sources, not this file.
//
// Use. (1) hangpose_params_init. (2) hangpose_object_create from a triangle mesh and hangpose_supporter_create from a
// point cloud, once each. (3) hangpose_predict. poses[0] is the best: place the object at its `position` and
// `quaternion` and release it. examples-c/01_static_memory.c is a complete program. A hangpose_request says how and
// where the object shall hang and what it must not touch, and hangpose_predict_many hangs several objects at once:
// examples-c/09_requests.cpp. hangpose_plan_path finds a way to a pose without collisions, and
// hangpose_predict_reachable the best pose that has one: examples-c/08_plan.cpp.
//
// From depth images. The mesh of an object that is held alone: hangpose_volume_room gives the crop box of a dense
// volume; then hangpose_volume_create, hangpose_volume_integrate once for each image, hangpose_volume_complete and
// hangpose_volume_surface. The cloud of a supporter: hangpose_depth_points. Each image has the pose of its camera
// in world coordinates, which become the coordinates of the object or of the supporter.
// examples-c/07_depth_images.cpp is a complete program.
//
// Memory. The caller owns all memory: static, on the heap or on the stack, beginning at any address. Each function
// that takes memory has a size query, and all but hangpose_mesh_sample a macro for static arrays. A model
// (hangpose_object, hangpose_supporter or hangpose_volume) lives in the memory in which it was created. There is
// nothing to free: once the last call that uses a model has returned, its memory may be reused. Models must not be
// copied or moved.
//
// Pointers. A pointer that is not null must lead to a valid value of its type, or to as many rows as the count
// beside it says, and nobody else may write there during the call. The library checks what it can: null,
// misaligned, too small, overlapping, NaN, out of range. The call then returns an error and does nothing. A pointer
// may be null only where its comment says so; `detail` always may.
//
// Threads. Any number of threads may pass the same pointer to const at the same time. The library has no state of
// its own, so calls with different arguments are independent, and every function may be called from any thread.
//
// Structs. Every struct that is not part of another begins with struct_size. The caller sets it to sizeof the
// struct, so that a program compiled with another header is refused instead of misread. Functions whose names end
// in _init set it themselves.
//
// Numbers. Metres, radians, seconds. Frames are right-handed; gravity is along -z unless hangpose_params.gravity
// says otherwise. Object coordinates are those of the mesh, supporter coordinates those of the cloud. A pose maps
// object coordinates to supporter coordinates, and that of a camera maps camera coordinates to world coordinates:
// rotate by the quaternion, then add the position. Quaternions are x, y, z, w. "eq." and "section" refer to the
// paper, doi:10.1109/LRA.2024.3368297. The same input gives the same bits on every machine.

#ifndef HANGPOSE_H
#define HANGPOSE_H

#include <stddef.h>
#include <stdint.h>

// Bytes for static arrays, constant expressions. They are never less than the size queries of the same names in lower
// case, and up to half as much again, because they add arrays that are never needed at once. The queries are exact.
#define HANGPOSE_LARGER(a, b) ((a) > (b) ? (a) : (b))
#define HANGPOSE_OBJECT_BYTES(vertices, triangles, samples, voxels)                                  \
  (HANGPOSE_OBJECT_BYTES_AT_LEAST + HANGPOSE_OBJECT_BYTES_EACH_TRIANGLE * (size_t)(triangles) +     \
   HANGPOSE_OBJECT_BYTES_EACH_VOXEL * (size_t)(voxels) +                                            \
   HANGPOSE_LARGER(HANGPOSE_OBJECT_BYTES_EACH_SAMPLE * (size_t)(samples),                           \
                   HANGPOSE_OBJECT_BYTES_WORK_EACH_VERTEX * (size_t)(vertices) +                    \
                       HANGPOSE_OBJECT_BYTES_WORK_EACH_TRIANGLE * (size_t)(triangles) +             \
                       HANGPOSE_OBJECT_BYTES_WORK_EACH_VOXEL * (size_t)(voxels)))
#define HANGPOSE_SUPPORTER_BYTES(points)                                                             \
  HANGPOSE_LARGER(                                                                                   \
      HANGPOSE_SUPPORTER_BYTES_FEW + HANGPOSE_SUPPORTER_BYTES_FEW_EACH_POINT * (size_t)(points),    \
      HANGPOSE_SUPPORTER_BYTES_MANY + HANGPOSE_SUPPORTER_BYTES_MANY_EACH_POINT * (size_t)(points))
#define HANGPOSE_PREDICT_BYTES(points, poses)                                                        \
  (HANGPOSE_PREDICT_BYTES_AT_LEAST + HANGPOSE_PREDICT_BYTES_EACH_POINT * (size_t)(points) +         \
   HANGPOSE_PREDICT_BYTES_EACH_POSE * (size_t)(poses))
#define HANGPOSE_PLAN_BYTES(points, scene_points, nodes, waypoints)                                  \
  (HANGPOSE_PLAN_BYTES_AT_LEAST + HANGPOSE_PLAN_BYTES_EACH_POINT * (size_t)(points) +               \
   HANGPOSE_PLAN_BYTES_EACH_SCENE_POINT * (size_t)(scene_points) +                                  \
   HANGPOSE_PLAN_BYTES_EACH_NODE * (size_t)(nodes) +                                                \
   HANGPOSE_PLAN_BYTES_EACH_WAYPOINT * (size_t)(waypoints))
#define HANGPOSE_REACHABLE_BYTES(points, poses, scene_points, nodes, waypoints)                      \
  (HANGPOSE_REACHABLE_BYTES_AT_LEAST + HANGPOSE_REACHABLE_BYTES_EACH_POINT * (size_t)(points) +     \
   HANGPOSE_REACHABLE_BYTES_EACH_POSE * (size_t)(poses) +                                           \
   HANGPOSE_REACHABLE_BYTES_EACH_SCENE_POINT * (size_t)(scene_points) +                             \
   HANGPOSE_REACHABLE_BYTES_EACH_NODE * (size_t)(nodes) +                                           \
   HANGPOSE_REACHABLE_BYTES_EACH_WAYPOINT * (size_t)(waypoints))
#define HANGPOSE_VOLUME_BYTES(blocks)                                                                \
  (HANGPOSE_VOLUME_BYTES_AT_LEAST + HANGPOSE_VOLUME_BYTES_EACH_BLOCK * (size_t)(blocks))
#define HANGPOSE_COMPLETE_BYTES(blocks)                                                              \
  (HANGPOSE_COMPLETE_BYTES_AT_LEAST + HANGPOSE_COMPLETE_BYTES_EACH_BLOCK * (size_t)(blocks))
#define HANGPOSE_SURFACE_BYTES(blocks)                                                               \
  (HANGPOSE_SURFACE_BYTES_AT_LEAST + HANGPOSE_SURFACE_BYTES_EACH_BLOCK * (size_t)(blocks))
// Terms of these macros: upper bounds of the growth of the queries per vertex, triangle, sample, voxel, point, pose,
// scene point, node, waypoint and block.
#define HANGPOSE_OBJECT_BYTES_AT_LEAST 52224
#define HANGPOSE_OBJECT_BYTES_EACH_SAMPLE 348
#define HANGPOSE_OBJECT_BYTES_WORK_EACH_VERTEX 28
#define HANGPOSE_OBJECT_BYTES_EACH_TRIANGLE 100
#define HANGPOSE_OBJECT_BYTES_WORK_EACH_TRIANGLE 80
#define HANGPOSE_OBJECT_BYTES_EACH_VOXEL 4
#define HANGPOSE_OBJECT_BYTES_WORK_EACH_VOXEL 14
#define HANGPOSE_SUPPORTER_BYTES_FEW 58368
#define HANGPOSE_SUPPORTER_BYTES_FEW_EACH_POINT 252
#define HANGPOSE_SUPPORTER_BYTES_MANY 17408
#define HANGPOSE_SUPPORTER_BYTES_MANY_EACH_POINT 293
#define HANGPOSE_PREDICT_BYTES_AT_LEAST 46080
#define HANGPOSE_PREDICT_BYTES_EACH_POINT 27
#define HANGPOSE_PREDICT_BYTES_EACH_POSE 432
#define HANGPOSE_PLAN_BYTES_AT_LEAST 1050624
#define HANGPOSE_PLAN_BYTES_EACH_POINT 9
#define HANGPOSE_PLAN_BYTES_EACH_SCENE_POINT 64
#define HANGPOSE_PLAN_BYTES_EACH_NODE 218
#define HANGPOSE_PLAN_BYTES_EACH_WAYPOINT 32
#define HANGPOSE_REACHABLE_BYTES_AT_LEAST 1050624
#define HANGPOSE_REACHABLE_BYTES_EACH_POINT 27
#define HANGPOSE_REACHABLE_BYTES_EACH_POSE 488
#define HANGPOSE_REACHABLE_BYTES_EACH_SCENE_POINT 64
#define HANGPOSE_REACHABLE_BYTES_EACH_NODE 218
#define HANGPOSE_REACHABLE_BYTES_EACH_WAYPOINT 32
#define HANGPOSE_VOLUME_BYTES_AT_LEAST 2048
#define HANGPOSE_VOLUME_BYTES_EACH_BLOCK 2072
#define HANGPOSE_COMPLETE_BYTES_AT_LEAST 2048
#define HANGPOSE_COMPLETE_BYTES_EACH_BLOCK 6784
#define HANGPOSE_SURFACE_BYTES_AT_LEAST 2048
#define HANGPOSE_SURFACE_BYTES_EACH_BLOCK 244

// Version of the structs and functions in this header. hangpose_params_init and hangpose_check_abi refuse a
// program whose header has another version than the library.
#define HANGPOSE_ABI_VERSION 3

// Value of an index that does not apply.
#define HANGPOSE_NO_INDEX 4294967295

// Length of hangpose_detail.field in characters, with the terminating NUL.
#define HANGPOSE_FIELD_CHARS 64

// Length of hangpose_detail.message in characters, with the terminating NUL.
#define HANGPOSE_MESSAGE_CHARS 256

// Value of `work_limit` for no limit.
#define HANGPOSE_NO_WORK_LIMIT 18446744073709551615ull

// Greatest hangpose_symmetry.fold.
#define HANGPOSE_MAX_FOLD 360

// Greatest number of objects that hang already, hangpose_request.hung_count, and of objects that hang at once, those
// of hangpose_predict_many included. Of more, pass points of their surfaces as hangpose_request.scene_points.
#define HANGPOSE_MAX_HUNG 32

// Greatest number of symmetries that are given, hangpose_request.symmetry_count.
#define HANGPOSE_MAX_SYMMETRIES 8

// Number of directions in which gravity is tilted.
#define HANGPOSE_DIRECTIONS 8

// Greatest number of contacts in a pose.
#define HANGPOSE_MAX_CONTACTS 8

// Greatest number of parts of a gripper, hangpose_motion.part_count.
#define HANGPOSE_MAX_PARTS 64

// An analysed object, at the front of the memory in which it was created. There is nothing to free. As long as it
// is used, its memory must not be moved and nobody else may write to it. Any number of threads may use it at the
// same time.
typedef struct hangpose_object hangpose_object;

// An analysed supporter, at the front of the memory in which it was created. There is nothing to free. As long as
// it is used, its memory must not be moved and nobody else may write to it. Any number of threads may use it at
// the same time, except during hangpose_supporter_update.
typedef struct hangpose_supporter hangpose_supporter;

// Depth images that are fused into a truncated signed distance volume, at the front of the memory in which it was
// created. There is nothing to free. As long as it is used, its memory must not be moved and nobody else may write to
// it. A thread that changes it must be the only one that uses it.
typedef struct hangpose_volume hangpose_volume;

// Result of a call. 0: done. Above 0: a valid result that is not, or not only, poses or a path. Below 0: an error of the
// caller; the call did nothing, and hangpose_detail says what to correct.
typedef int32_t hangpose_status;

// The step of the method that left no pose, one of HANGPOSE_STAGE_*.
typedef uint32_t hangpose_stage;

// Source of the object's centre of mass, one of HANGPOSE_CENTRE_OF_MASS_*.
typedef uint32_t hangpose_centre_of_mass;

// Source of the candidate poses, one of HANGPOSE_CANDIDATES_*.
typedef uint32_t hangpose_candidates;

// The constants of the method, with the symbols of the paper. The time step (0.004 s), the settle time (3 s) and the
// rest speed (0.005 m/s) of the simulation cannot be changed through this interface. Set the struct with hangpose_params_init, then
// change single fields. Every call that takes it checks each field against its range, which stands at the end of
// the comment of the field.
typedef struct hangpose_params {
  // sizeof(hangpose_params), set by hangpose_params_init.
  uint32_t struct_size;
  // Source of the centre of mass, one of HANGPOSE_CENTRE_OF_MASS_*.
  hangpose_centre_of_mass centre_of_mass;
  // Seed of the surface samples.
  uint64_t seed;
  // x, y, z of the direction of gravity in supporter coordinates; any length but zero.
  float gravity[3];
  // x, y, z of the centre of mass, metres, in object coordinates; used with HANGPOSE_CENTRE_OF_MASS_GIVEN.
  float given_centre_of_mass[3];
  // N: number of points sampled from the surface of the object; 100 to 500000.
  uint32_t samples;
  // alpha_h: least cosine between the normal of an object point and its direction to the centre of mass,
  // eq. (3); 0 to 1.
  float object_contact_cosine;
  // Radius of the flat mean-shift kernel, as a fraction of the diagonal of the bounding box; 0.001 to 1.
  float cluster_bandwidth;
  // l_c: object clusters of this many points or fewer are dropped, eq. (4); 0 to 500000.
  uint32_t min_cluster_points;
  // N_h: number of positions tried for the free space between a contact point and the opposite surface;
  // 2 to 1000.
  uint32_t free_space_steps;
  // r_alpha: least free-space radius, metres; 0 to 1.
  float min_free_space_radius;
  // N_p: number of hanging directions tried at an object site; 1 to 720.
  uint32_t object_directions;
  // N_r: number of rays cast around each hanging direction; 3 to 720.
  uint32_t rays_per_direction;
  // alpha_1: least fraction of the rays above the hanging position that must hit the object, eq. (6); 0 to 1.
  float min_encircled_above;
  // alpha_2: least fraction of the rays below the hanging position that must hit the object, eq. (6); 0 to 1.
  float min_encircled_below;
  // r_beta: relative difference of the free-space radii below which two object sites may be merged, eq. (7);
  // 0 to 1.
  float similar_radius;
  // beta: cosine between the hanging directions above which two object sites of similar radius are merged,
  // eq. (7); 0 to 1.
  float similar_direction;
  // alpha_s: least cosine between the normal of a supporter point and up, section II-C; 0 to 1.
  float supporter_contact_cosine;
  // M_s: number of directions in which the supporter is sliced at each site; 1 to 720.
  uint32_t supporter_directions;
  // d_l: half the thickness of a slice, metres; 0.00001 to 1.
  float slice_half_thickness;
  // Distance below which two points of a slice are linked into one cross-section, metres; 0.00001 to 1.
  float slice_link_distance;
  // alpha_m: least ratio of free-space radius to support radius; pairs of sites below it are dropped; 0 to 1.
  float radius_ratio;
  // Greatest fraction of the supporter points that may lie inside the object; poses above it are dropped;
  // 0 to 1.
  float max_collision;
  // gamma_1: weight of the collision cost S_c, eq. (11); 0 to 1.
  float collision_weight;
  // gamma_2: weight of the boundary cost S_b, eq. (11); 0 to 1.
  float boundary_weight;
  // gamma_3: weight of the contact-area cost S_a, eq. (11); 0 to 1.
  float contact_area_weight;
  // Source of the candidate poses, one of HANGPOSE_CANDIDATES_*. The fields from object_contact_cosine to
  // contact_area_weight apply to HANGPOSE_CANDIDATES_SITES only.
  hangpose_candidates candidates;
  // 1 to simulate the release of each pose under gravity and return only poses from which the object comes to
  // rest and stays; 0 to return poses without this test.
  uint32_t settle;
  // Coulomb friction coefficient between object and supporter; 0 to 2.
  float friction;
  // Distance between object and supporter at release, metres, where there is room for it; 0 to 0.01.
  float clearance;
  // Greatest number of nodes of the object's signed distance field; 0 to 10000000, at least 1 if `settle` is 1
  // or with HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t voxels;
  // Greatest number of poses that are released while none stays. Once one stays, a quarter of this number is the
  // limit. 0 to 10000.
  uint32_t settle_attempts;
  // Number of firm releases that ends the search. A release is firm if its rest pose stays when it is jolted and
  // when gravity tilts by about 1 rad; two releases to the same rest pose count twice. A larger number gives more
  // different poses to choose from. 0 to 10000.
  uint32_t firm_enough;
  // Least probability that the object hangs; poses below it are dropped; 0 to 1.
  float min_probability;
} hangpose_params;

// A set of default constants, one of HANGPOSE_PROFILE_*.
typedef uint32_t hangpose_profile;

// Diagnosis of a call: the argument or field that is wrong, its value and its valid range. Every function that can
// fail takes a pointer to one, which may be null, and writes it on success too. Concurrent calls need one each.
typedef struct hangpose_detail {
  // sizeof(hangpose_detail), set by the caller.
  uint32_t struct_size;
  // The status that the call returned.
  hangpose_status status;
  // Index of the wrong vertex, triangle, point, image or other element of an array, or HANGPOSE_NO_INDEX.
  uint32_t index;
  // The wrong value; NaN if it is not a number or does not apply.
  double value;
  // Least valid value; NaN if there is no range.
  double minimum;
  // Greatest valid value; NaN if there is no range.
  double maximum;
  // Name of the wrong argument or field, such as "params.radius_ratio" or "memory", or "".
  char field[HANGPOSE_FIELD_CHARS];
  // A sentence for people: what is wrong and how to correct it.
  char message[HANGPOSE_MESSAGE_CHARS];
} hangpose_detail;

// A triangle mesh in the caller's arrays. Corners are counter-clockwise seen from outside. Open, overlapping and
// multi-body meshes are valid; degenerate triangles are skipped. The library keeps no pointer to the arrays after
// the call.
typedef struct hangpose_mesh {
  // sizeof(hangpose_mesh), set by the caller.
  uint32_t struct_size;
  // Number of vertices.
  uint32_t vertex_count;
  // Number of triangles.
  uint32_t triangle_count;
  // Number of viewpoints; 0 if the mesh is all of the object.
  uint32_t viewpoint_count;
  // Array of vertex_count rows of x, y, z: metres, in object coordinates, each within +-1,000,000. For
  // hangpose_mesh_sample the coordinates are those of the supporter.
  const float *vertices;
  // Array of triangle_count rows of three vertex indices, counted from 0.
  const uint32_t *triangles;
  // Array of viewpoint_count rows of x, y, z: positions of the cameras whose images the mesh was made from, metres, in
  // object coordinates. What is in the shadow of the mesh for all of them was not seen: the object may be there as well,
  // and poses that have the supporter there are less probable. May be null if viewpoint_count is 0.
  const float *viewpoints;
} hangpose_mesh;

// A point cloud in the caller's arrays. The library keeps no pointer to the arrays after the call.
typedef struct hangpose_cloud {
  // sizeof(hangpose_cloud), set by the caller.
  uint32_t struct_size;
  // Number of points.
  uint32_t point_count;
  // Number of viewpoints; 0 if none is known.
  uint32_t viewpoint_count;
  // Array of point_count rows of x, y, z: metres, in supporter coordinates, each within +-1,000,000.
  const float *points;
  // Array of point_count rows of x, y, z: normals that point out of the solid, of any length. Normals that point
  // into the solid, or whose signs disagree with each other, are reversed. A row of zeros marks an unknown
  // normal. May be null: no normal is known. Unknown normals are estimated; they follow the known normals
  // around them.
  const float *normals;
  // Array of viewpoint_count rows of x, y, z: positions of the sensor from which the points were seen, metres, in
  // supporter coordinates. If no normal is known, the estimated normals face them. May be null if
  // viewpoint_count is 0: the normals are then oriented from point to point, and the pieces of the cloud vote on
  // their outside with the surfaces opposite to them.
  const float *viewpoints;
  // Array of point_count marks: 0 for points on which nothing shall hang, which are obstacles. May be null: an
  // object may hang on any point.
  const uint8_t *marks;
  // Two rows of x, y, z: lower and upper corner of the box within which objects may hang, metres, in supporter
  // coordinates. Points outside are obstacles. May be null: an object may hang anywhere.
  const float *region;
} hangpose_cloud;

// The largest inputs for which memory is reserved. Smaller inputs need no more memory.
typedef struct hangpose_limits {
  // sizeof(hangpose_limits), set by the caller.
  uint32_t struct_size;
  // Number of vertices of the object's mesh.
  uint32_t vertices;
  // Number of triangles of the object's mesh.
  uint32_t triangles;
  // Value of hangpose_params.samples.
  uint32_t samples;
  // Value of hangpose_params.voxels.
  uint32_t voxels;
  // Number of points of the supporter's cloud.
  uint32_t points;
  // Value of `pose_capacity` for hangpose_predict or hangpose_predict_reachable, or of `object_count` for
  // hangpose_predict_many.
  uint32_t poses;
  // Value of hangpose_request.scene_point_count, for planning.
  uint32_t scene_points;
  // Value of hangpose_motion.nodes.
  uint32_t nodes;
  // Value of `waypoint_capacity` for hangpose_plan_path or hangpose_predict_reachable.
  uint32_t waypoints;
} hangpose_limits;

// Lets other threads read the progress of a call and cancel it, and limits the work of each call. It must not be
// moved or overwritten while a call uses it. Its words are atomic: any thread, and a signal handler, may read the
// progress and cancel at any time.
typedef struct hangpose_monitor {
  // sizeof(hangpose_monitor), set by hangpose_monitor_init.
  uint32_t struct_size;
  // Private to the library.
  uint32_t magic;
  // Private to the library.
  uint64_t words[4];
} hangpose_monitor;

// A part of a call: to be called once with the argument that comes with it.
typedef void (*hangpose_task)(void *argument);

// Runs `first(first_argument)` and `second(second_argument)`, at the same time where that is possible, and returns when both have
// returned. `context` is that of hangpose_threads.
typedef void (*hangpose_join)(void *context,
                              hangpose_task first,
                              void *first_argument,
                              hangpose_task second,
                              void *second_argument);

// A second thread of the caller's, which the library uses but neither starts nor ends by itself. Results are the same without it.
typedef struct hangpose_threads {
  // sizeof(hangpose_threads).
  uint32_t struct_size;
  // Runs two functions at the same time. Several calls that use the monitor may call it at once.
  hangpose_join join;
  // Given to `join` as it is; may be null.
  void *context;
} hangpose_threads;

// Result of the analysis of an object.
typedef struct hangpose_object_info {
  // sizeof(hangpose_object_info), set by the caller.
  uint32_t struct_size;
  // HANGPOSE_WORK_LIMIT if the search for sites or contact candidates ended early, else HANGPOSE_OK.
  hangpose_status stopped;
  // 1 if the mesh is closed, so that it has a volume, else 0.
  uint32_t is_closed;
  // 1 if the mesh is closed and its triangles face inwards, else 0. The analysis corrects for this.
  uint32_t is_inside_out;
  // Surface area, square metres.
  float area;
  // Volume, cubic metres; NaN if the mesh is not closed.
  float volume;
  // x, y, z of the centre of mass for which poses are made, metres, in object coordinates.
  float centre_of_mass[3];
  // Number of samples whose normal points towards the centre of mass, eq. (3): with a cosine above
  // object_contact_cosine, or 0.3 with HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t contact_points;
  // Number of clusters of contact points, eq. (4); 0 with HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t clusters;
  // Number of clusters with a free space outside the object; 0 with HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t with_free_space;
  // Number of free spaces that the object encircles, eq. (6); 0 with HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t encircled;
  // Number of hanging sites: encircled free spaces that differ from each other, eq. (7); 0 with
  // HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t sites;
  // Number of contact candidates; 0 with HANGPOSE_CANDIDATES_SITES.
  uint32_t contacts;
  // Number of symmetries that were detected; 0 with hangpose_params.voxels = 0.
  uint32_t symmetries;
  // Number of rays cast.
  uint64_t rays;
  // Number of distance and inside-outside queries.
  uint64_t distance_queries;
} hangpose_object_info;

// A hanging site: a free space of the object into which a supporter can reach.
typedef struct hangpose_object_site {
  // sizeof(hangpose_object_site), set by the caller.
  uint32_t struct_size;
  // |P_h|: number of samples in the cluster of contact points.
  uint32_t contact_points;
  // c_h: x, y, z of the centre of the free space, metres, in object coordinates.
  float position[3];
  // v_h: x, y, z of the unit vector along which the supporter passes through, in object coordinates; the sign is
  // arbitrary.
  float hanging_direction[3];
  // p_h: x, y, z of the contact point from which the free space was found, metres, in object coordinates.
  float contact_point[3];
  // r_h: radius of the free space, metres.
  float free_space_radius;
  // m: fraction of the rays around the hanging direction that hit the object, 0 to 1, eq. (5).
  float encircled;
  // m_1: fraction of the rays above the hanging position that hit the object, 0 to 1.
  float encircled_above;
  // m_2: fraction of the rays below the hanging position that hit the object, 0 to 1.
  float encircled_below;
} hangpose_object_site;

// A contact candidate of an object: a point of its surface that can rest on a supporter.
typedef struct hangpose_object_contact {
  // sizeof(hangpose_object_contact), set by the caller.
  uint32_t struct_size;
  // x, y, z of the point on the surface, metres, in object coordinates.
  float position[3];
  // x, y, z of the unit normal, out of the solid, in object coordinates.
  float normal[3];
  // x, y, z of the direction in which the object catches a thin bar under the point best: a unit vector in
  // object coordinates; the sign is arbitrary.
  float bar_direction[3];
  // Distance that this bar must move from the point towards the centre of mass, which is down when the object hangs,
  // before it can escape sideways, metres; 0 if it is not caught. The bar is a line without thickness.
  float capture;
  // Distance from the point towards the centre of mass to the opposite surface, metres; infinite if there is none.
  float room;
  // Distance that this bar can extend along its direction before it meets the object, on the longer side,
  // metres; infinite if nothing stops it, as in a hole.
  float passage;
} hangpose_object_contact;

// Turns of an object after which it looks as before, about an axis through its centre of mass.
typedef struct hangpose_symmetry {
  // sizeof(hangpose_symmetry), set by the caller.
  uint32_t struct_size;
  // 0 for a solid of revolution, which may turn by any angle; n, from 2 to HANGPOSE_MAX_FOLD, for turns by multiples
  // of an n-th of a full turn.
  uint32_t fold;
  // x, y, z of the direction of the axis, in object coordinates; the sign is arbitrary. Its length is 1 where it was
  // detected; in a hangpose_request, any but zero.
  float axis[3];
} hangpose_symmetry;

// Result of the analysis of a supporter.
typedef struct hangpose_supporter_info {
  // sizeof(hangpose_supporter_info), set by the caller.
  uint32_t struct_size;
  // HANGPOSE_WORK_LIMIT if the search for sites or contact candidates ended early, else HANGPOSE_OK.
  hangpose_status stopped;
  // Number of points that are left of the cloud, without those that were merged and the strays, and with those that
  // were guessed.
  uint32_t points;
  // Number of points that were merged with others at the same place.
  uint32_t points_merged;
  // Number of points that were dropped as strays: alone in the air, or in a speck.
  uint32_t strays;
  // Number of points left on large planes, as walls and tables, on which nothing hangs.
  uint32_t points_on_planes;
  // Number of points that no viewpoint saw and that were guessed: the far sides of bars and plates.
  uint32_t points_guessed;
  // Number of normals that were missing or zero and were estimated from the neighbouring points: all of the
  // cloud, where the given ones are no normals of the surface on which the points are.
  uint32_t normals_estimated;
  // Number of normals that were not of unit length and were normalised.
  uint32_t normals_renormalised;
  // Number of given normals that were reversed, because they pointed into the solid or because their signs did not
  // agree with each other.
  uint32_t normals_reversed;
  // Number of points that face up, eq. (2): with a cosine above supporter_contact_cosine, or 0.3 with
  // HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t contact_points;
  // Number of clusters of contact points; 0 with HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t clusters;
  // Number of support sites: clusters at which a slice through the supporter holds together; 0 with
  // HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t sites;
  // Number of contact candidates; 0 with HANGPOSE_CANDIDATES_SITES.
  uint32_t contacts;
  // Number of rays cast.
  uint64_t rays;
  // Number of distance and inside-outside queries.
  uint64_t distance_queries;
} hangpose_supporter_info;

// A support site: a cross-section of the supporter on which an object can hang.
typedef struct hangpose_supporter_site {
  // sizeof(hangpose_supporter_site), set by the caller.
  uint32_t struct_size;
  // c_s: x, y, z of the centre of the cross-section, metres, in supporter coordinates.
  float position[3];
  // v_s: x, y, z of the horizontal unit vector along which the cross-section is smallest, in supporter
  // coordinates; the sign is arbitrary.
  float hanging_direction[3];
  // p_s: x, y, z of the contact point at which the supporter was sliced, metres, in supporter coordinates.
  float contact_point[3];
  // r_s: radius of the sphere around the cross-section, metres.
  float support_radius;
  // d_1, d_2: distances from the position to the convex hull of the supporter along the hanging direction and
  // against it, metres.
  float boundary_distances[2];
} hangpose_supporter_site;

// A contact candidate of a supporter: a point on which an object can rest.
typedef struct hangpose_supporter_contact {
  // sizeof(hangpose_supporter_contact), set by the caller.
  uint32_t struct_size;
  // x, y, z of the point, metres, in supporter coordinates.
  float position[3];
  // x, y, z of the unit normal, out of the solid, in supporter coordinates.
  float normal[3];
  // x, y, z of the unit vector along which the supporter extends around the point, in supporter coordinates; the
  // sign is arbitrary.
  float bar_direction[3];
} hangpose_supporter_contact;

// How an object hangs, one of HANGPOSE_KIND_*; or a set of kinds, joined with |. It is decided for the rest pose, from
// the shapes alone. A bar is the part of the supporter at a contact that carries the object.
typedef uint32_t hangpose_kind;

// What a region is made of, one of HANGPOSE_REGION_*.
typedef uint32_t hangpose_region_shape;

// A part of an object or of a supporter, in its coordinates; zeros for all of it. Part of hangpose_request. The
// library keeps no pointer to the arrays after the call.
typedef struct hangpose_region {
  // One of HANGPOSE_REGION_*.
  hangpose_region_shape shape;
  // With HANGPOSE_REGION_BOX: x, y, z of the lower corner, metres, each within +-1,000,000.
  float low[3];
  // With HANGPOSE_REGION_BOX: x, y, z of the upper corner, metres, each at least that of `low` and up to 1,000,000.
  float high[3];
  // Largest distance from the points or triangles, metres; 0 to 1,000,000.
  float radius;
  // Number of points, at least 1 with HANGPOSE_REGION_POINTS and HANGPOSE_REGION_TRIANGLES.
  uint32_t point_count;
  // Number of triangles, at least 1 with HANGPOSE_REGION_TRIANGLES.
  uint32_t triangle_count;
  // Number of indices, at least 1 if `indices` is not null.
  uint32_t index_count;
  // Array of point_count rows of x, y, z: metres, each within +-1,000,000. With HANGPOSE_REGION_TRIANGLES these are
  // the vertices of the mesh.
  const float *points;
  // Array of triangle_count rows of three indices of points, counted from 0.
  const uint32_t *triangles;
  // Array of index_count indices, counted from 0, of the points or triangles that count. With HANGPOSE_REGION_POINTS
  // it may be null if index_count is 0: all points count.
  const uint32_t *indices;
} hangpose_region;

// An object that hangs already. Part of hangpose_request.
typedef struct hangpose_hung {
  // The object. The object that is to be hung may hang already, too.
  const struct hangpose_object *object;
  // Its pose: x, y, z of its origin, metres, in supporter coordinates, each within +-1,000,000.
  float position[3];
  // Its pose: x, y, z, w of the quaternion that rotates object coordinates into supporter coordinates; any length
  // but zero.
  float quaternion[4];
} hangpose_hung;

// What hangpose_predict and hangpose_predict_many look for: how and where the object hangs, and what it must not touch.
// Set the struct with hangpose_request_init, then change single fields. The library keeps no pointer to the arrays after
// the call. With hangpose_params.settle = 0 only the regions count, and these only with HANGPOSE_CANDIDATES_CONTACTS.
typedef struct hangpose_request {
  // sizeof(hangpose_request), set by hangpose_request_init.
  uint32_t struct_size;
  // The kinds that are given at all: HANGPOSE_KIND_*, joined with |, at least one. Default: HANGPOSE_KIND_ALL.
  hangpose_kind allow;
  // The kinds that come first: HANGPOSE_KIND_*, joined with |, or 0. Of the others, HANGPOSE_KIND_CAPPED comes
  // before HANGPOSE_KIND_BALANCED. A pose of a kind that comes later is ranked before one that comes first only if
  // it is much more probable. Default: HANGPOSE_KIND_THREADED | HANGPOSE_KIND_HOOKED.
  hangpose_kind prefer;
  // 1 if the object must come to its release pose on a straight way without a collision, as the next three fields
  // say; 0, the default, for any way.
  uint32_t has_approach;
  // x, y, z of the direction in which the object moves, in supporter coordinates; any length but zero.
  float approach_direction[3];
  // Largest angle between the way and approach_direction, radians; 0 to pi.
  float approach_angle;
  // Length of the way that is free, metres; 0 to 10.
  float approach_length;
  // Two poses of the same kind differ by this distance of the centres of mass or by distinct_rotation, or by more,
  // whichever way the object is turned by its symmetries; metres; 0 to 10. Default: 0.02.
  float distinct_position;
  // Angle of the rotation from one pose to the other, radians; 0 to pi. Default: 0.35.
  float distinct_rotation;
  // Number of points of the scene; 0, the default, if there are none.
  uint32_t scene_point_count;
  // Number of objects that hang already; 0, the default, to HANGPOSE_MAX_HUNG.
  uint32_t hung_count;
  // 1 if the object has the symmetries in the array `symmetries` and no others; 0, the default, for those that were
  // detected, see hangpose_object_get_symmetry. Poses that differ by a symmetry, or by two about different axes one
  // after the other, are one pose.
  uint32_t has_symmetries;
  // Number of symmetries, 0 to HANGPOSE_MAX_SYMMETRIES. With has_symmetries = 1, 0 says that the object has none.
  uint32_t symmetry_count;
  // The part of the supporter that carries the object: at least half of its weight rests there. In supporter
  // coordinates. Default: everywhere.
  struct hangpose_region on;
  // The part of the object by which it hangs: at least half of its weight rests on it. In object coordinates.
  // Default: everywhere.
  struct hangpose_region by;
  // Array of scene_point_count rows of x, y, z: points of things near the supporter, metres, in supporter
  // coordinates, each within +-1,000,000. The object does not touch them and never hangs on them. They are not
  // simulated. May be null if scene_point_count is 0.
  const float *scene_points;
  // Array of hung_count objects that hang on the supporter already. As the scene, with their exact shapes. May be
  // null if hung_count is 0.
  const struct hangpose_hung *hung;
  // Array of symmetry_count symmetries. May be null if symmetry_count is 0.
  const struct hangpose_symmetry *symmetries;
} hangpose_request;

// Stability margins of a rest pose. Part of hangpose_pose.
typedef struct hangpose_margin {
  // Tilt of gravity at which the object last touched the supporter before it left, radians, in each of eight
  // horizontal directions, with 70 % of the friction; larger than the static limit, because leaving takes time. The first direction is the supporter's x axis, made perpendicular to gravity (the y axis if
  // gravity is along x); the others follow counter-clockwise seen from above. At most 1.2, where the test ends;
  // 0 for directions that were not tried because the tilt in an earlier one is too small for the pose to be of use.
  float tilts[HANGPOSE_DIRECTIONS];
  // Least of the tilts, radians.
  float least_tilt;
  // Time that the object stays, seconds, after gravity tilts by 21.8 degrees at once in the direction of the
  // least tilt, while only friction damps its swing. 1 if it is still there after 1 s; 0 if the test was skipped
  // because the tilt in some direction is too small.
  float jolt_time;
  // Greatest distance that the centre of mass sank, metres, while gravity tilted by up to 0.9 radians. An object
  // that settles deeper when it is shaken does not rest firmly.
  float tilted_sinking;
  // Least rise of the centre of mass, metres, over the escape paths that were found, an upper bound of the true
  // least; the greatest rise seen if no escape was found, which bounds nothing.
  float escape_rise;
  // escape_rise divided by the distance from the contacts to the centre of mass; no unit.
  float escape_ratio;
  // Speed of a knock that would carry the centre of mass over escape_rise, metres per second.
  float knock_speed;
  // Distance that the true centre of mass may be away from the assumed one, metres.
  float centre_of_mass_radius;
} hangpose_margin;

// A contact at which the supporter carries the object, in supporter coordinates. Part of hangpose_pose.
typedef struct hangpose_contact {
  // x, y, z of the contact, metres.
  float position[3];
  // x, y, z of the contact normal: the unit vector in which the supporter pushes.
  float normal[3];
  // Normal force, in multiples of the object's weight.
  float force;
} hangpose_contact;

// A pose in which the object hangs: the release pose, the rest pose to which gravity then takes the object, and
// the sites that it matches.
typedef struct hangpose_pose {
  // sizeof(hangpose_pose), set by the library.
  uint32_t struct_size;
  // 1 if there is a pose, as in all that hangpose_predict writes. 0 if hangpose_predict_many has none for the object:
  // then all fields from here on are HANGPOSE_NO_INDEX, NaN or 0.
  uint32_t has_pose;
  // Release pose: x, y, z of the origin of the object, metres, in supporter coordinates.
  float position[3];
  // Release pose: x, y, z, w of the unit quaternion that rotates object coordinates into supporter coordinates.
  float quaternion[4];
  // 1 with hangpose_params.settle. Else 0, and all fields from here to `contacts` are NaN or 0.
  uint32_t has_rest;
  // How the object hangs, one of HANGPOSE_KIND_*.
  hangpose_kind kind;
  // Probability that the object hangs and stays, 0 to 1.
  float probability;
  // Probability that it also stays when gravity tilts by 21.8 degrees towards any side, 0 to 1. Among poses that are sure to
  // hang it tells which is the firmest.
  float robustness;
  // Share of the directions from which no camera looked at the object, 0 to 1: the same for all poses. This and the next
  // two are 0 if no viewpoints are given, and lower the probability.
  float unseen_object;
  // Share of the supporter near the object that is in the shadow of the object's mesh, 0 to 1: no camera saw that the
  // object is not there. Another view of the object would then say more.
  float unseen_shadow;
  // Share of the supporter close to the object that no camera saw and that was guessed, 0 to 1. Another view of the
  // supporter would then say more.
  float unseen_supporter;
  // Direction from the object, in its coordinates, in which a camera would see most of what no camera saw: a unit vector,
  // or 0, 0, 0.
  float object_view[3];
  // Direction from the supporter, in its coordinates, in which a camera would see most of what was guessed close to the
  // object: a unit vector, or 0, 0, 0.
  float supporter_view[3];
  // Rest pose: x, y, z of the origin of the object, metres, in supporter coordinates.
  float rest_position[3];
  // Rest pose: x, y, z, w of the unit quaternion that rotates object coordinates into supporter coordinates.
  float rest_quaternion[4];
  // Distance that the centre of mass sinks from the release pose to the rest pose, metres.
  float sinking;
  // Distance between object and supporter in the release pose, metres: hangpose_params.clearance, or less if
  // there is no room.
  float clearance;
  // Distance that the object may be away from the release pose in any direction when it is let go, metres: it still
  // touches nothing, and comes to rest as it would have. This error and the next add up: half of either is fine
  // together.
  float tolerance_position;
  // Angle about the centre of mass by which the object may be rotated away from the release pose, radians.
  float tolerance_rotation;
  // Stability margins of the rest pose.
  struct hangpose_margin margin;
  // Number of valid contacts; the others are 0.
  uint32_t contact_count;
  // Contacts at which the supporter carries the object in the rest pose.
  struct hangpose_contact contacts[HANGPOSE_MAX_CONTACTS];
  // 1 with HANGPOSE_CANDIDATES_SITES. Else 0, and all fields from here on are HANGPOSE_NO_INDEX, NaN or 0.
  uint32_t is_matched;
  // Index of the hanging site, for hangpose_object_get_site.
  uint32_t object_site;
  // Index of the support site, for hangpose_supporter_get_site.
  uint32_t support_site;
  // 1 if the hanging direction of the object is opposite to that of the supporter, 0 if it is the same.
  uint32_t is_reversed;
  // S_c: number of supporter points inside the object, eq. (8).
  uint32_t collision;
  // S_b: distance of the hanging position from the middle of the supporter, from 0.5 in the middle to 1 at the
  // boundary, eq. (9).
  float boundary;
  // S_a: 0 to 1, larger for a smaller contact area relative to the largest of the object, eq. (10).
  float contact_area;
  // S_total: weighted sum of S_c, S_b and S_a, eq. (11); lower is better.
  float total;
} hangpose_pose;

// Result of hangpose_predict beside the poses: the number of candidates left after each step of the method, and
// the work done. The fields matching_* are 0 with HANGPOSE_CANDIDATES_CONTACTS.
typedef struct hangpose_prediction {
  // sizeof(hangpose_prediction), set by the caller.
  uint32_t struct_size;
  // Number of poses written.
  uint32_t pose_count;
  // The step that left no pose, one of HANGPOSE_STAGE_*; hangpose_stage_string gives a text.
  hangpose_stage stage;
  // HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT if this call or the analysis of one of its models ended early,
  // else HANGPOSE_OK.
  hangpose_status stopped;
  // With HANGPOSE_CANDIDATES_SITES: number of pairs of a hanging site and a support site.
  uint32_t matching_pairs;
  // Number of pairs in which the support fits into the free space.
  uint32_t matching_fitting;
  // Number of poses, two for each fitting pair, with no more collisions than allowed. Poses that are certain to
  // be outranked are neither completed nor counted.
  uint32_t matching_clear;
  // With HANGPOSE_CANDIDATES_CONTACTS: number of poses that bring a contact candidate of the object onto one of
  // the supporter.
  uint32_t settling_candidates;
  // Number of these candidates that are clear of the supporter, or could be moved clear of it.
  uint32_t settling_clear;
  // Number of poses whose release was simulated.
  uint32_t settling_released;
  // Number of releases after which the object rotated off.
  uint32_t settling_rotated_off;
  // Number of releases after which the object slid off or fell through.
  uint32_t settling_slid_off;
  // Number of releases after which the object still moved after 3 s, the settle time.
  uint32_t settling_moving;
  // Number of releases after which the object came to rest.
  uint32_t settling_at_rest;
  // Number of releases after which the object came to rest but is wedged: it would not come off again.
  uint32_t settling_wedged;
  // Number of releases that came to rest in a pose that would be probable enough if what no camera has seen were known to be
  // as it is guessed.
  uint32_t settling_unseen;
  // Number of different rest poses with at least hangpose_params.min_probability, with those that gave way to a better one.
  uint32_t settling_probable;
  // Number of firm releases, see hangpose_params.firm_enough.
  uint32_t settling_firm;
  // Number of firm releases that hang in a way that is preferred: hangpose_request.prefer.
  uint32_t settling_firm_as_preferred;
  // Number of poses that touch the scene or an object that hangs already.
  uint32_t settling_in_scene;
  // Number of rest poses that hang on or by another region than was asked for, and 1 if the regions have no place
  // for any.
  uint32_t settling_outside;
  // Number of rest poses that hang in a way that is not allowed.
  uint32_t settling_other_kind;
  // Number of poses that would stay, but have no way in the direction that was asked for.
  uint32_t settling_no_approach;
  // Number of releases that came to rest in a pose that would be probable enough if the supporter's points were closer
  // together.
  uint32_t settling_sparse;
  // Number of rays cast.
  uint64_t rays;
  // Number of distance and inside-outside queries.
  uint64_t distance_queries;
} hangpose_prediction;

// Result of hangpose_predict_many beside the poses.
typedef struct hangpose_many {
  // sizeof(hangpose_many), set by the caller.
  uint32_t struct_size;
  // Number of objects that have a pose.
  uint32_t placed;
  // Why the first object without a pose has none, one of HANGPOSE_STAGE_*; hangpose_stage_string gives a text.
  // HANGPOSE_STAGE_NONE if all have one, or if all for which HANGPOSE_MAX_HUNG leaves room have one.
  hangpose_stage stage;
  // HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT if this call or the analysis of one of its models ended early, else
  // HANGPOSE_OK.
  hangpose_status stopped;
  // Number of rays cast.
  uint64_t rays;
  // Number of distance and inside-outside queries.
  uint64_t distance_queries;
} hangpose_many;

// A part of a gripper: all points within `radius` of a segment; a ball if both ends are the same. In object coordinates.
typedef struct hangpose_capsule {
  // x, y, z of one end of the segment, metres, each within +-1,000,000.
  float from[3];
  // x, y, z of the other end, metres, each within +-1,000,000.
  float to[3];
  // Radius, metres; 0 to 10.
  float radius;
  // x, y, z of the displacement when the gripper opens, metres; zeros for parts that do not move, such as the palm.
  float opening[3];
} hangpose_capsule;

// Returns 1 if the robot can bring the object to a pose, 0 if not, for hangpose_motion.accepts. `context` is
// hangpose_motion.context. `position` is x, y, z of the origin of the object, metres, and `quaternion` x, y, z, w of the
// unit quaternion that rotates object coordinates into supporter coordinates; both are valid until it returns. It must
// not throw or jump out, and must always give the same answer for the same pose. It may cancel the monitor of the call. It
// must not write to what the call reads, nor touch what the call writes.
typedef int32_t (*hangpose_accepts)(void *context, const float *position, const float *quaternion);

// How an object moves to the pose in which it hangs, or away from it. Set the struct with hangpose_motion_init, then
// change single fields. The library keeps no pointer after the call.
typedef struct hangpose_motion {
  // sizeof(hangpose_motion), set by hangpose_motion_init.
  uint32_t struct_size;
  // 1 if the next two fields say where the object is grasped, or, to take it off, where it is brought; 0, the default,
  // for any pose outside of the supporter's bounds.
  uint32_t has_start;
  // x, y, z of the origin of the object at the start, metres, in supporter coordinates, each within +-1,000,000.
  float start_position[3];
  // x, y, z, w of the quaternion that rotates object coordinates into supporter coordinates; any length but zero.
  float start_quaternion[4];
  // 1 if the object is taken off instead of hung: the path begins at the rest pose and leads to the start. Default: 0.
  uint32_t take_off;
  // Number of parts of the gripper; 0, the default, if none is to be planned, up to HANGPOSE_MAX_PARTS.
  uint32_t part_count;
  // x, y, z of the displacement with which the opened gripper leaves the object, in object coordinates, metres; up to 10
  // metres long. If this straight way is blocked, another one is planned; zeros leave all of it to the planner.
  float retreat[3];
  // 1 if all of the object stays in the box of the next two fields; 0, the default, for no limit. The gripper may leave
  // it.
  uint32_t has_workspace;
  // x, y, z of the lower corner of the box, metres, in supporter coordinates.
  float workspace_low[3];
  // x, y, z of the upper corner, metres, each above that of the lower one.
  float workspace_high[3];
  // Distance from obstacles that the path keeps where there is room for it, metres; above 0, at most 0.1. At the release
  // pose, and where the way is narrow, it is less, but never a collision. Default: 0.005.
  float clearance;
  // Largest distance of the centres of mass at two waypoints one after the other, metres; 0.0001 to 1.
  // Default: 0.01.
  float step_position;
  // Largest rotation from one to the next, radians; 0.001 to pi. Default: 0.1.
  float step_rotation;
  // Largest speed of the centre of mass, m/s; above 0, at most 100. Default: 0.25.
  float speed;
  // Largest speed of rotation, rad/s; above 0, at most 100. Default: 1.
  float angular_speed;
  // Largest acceleration of the centre of mass, m/s^2; above 0, at most 1000. Default: 0.5.
  float acceleration;
  // Largest acceleration of rotation, rad/s^2; above 0, at most 1000. Default: 2.
  float angular_acceleration;
  // Number of poses that are sampled at most: the budget of the search; 1 to 10,000,000. Default: 400.
  uint32_t samples;
  // Capacity of either of the two trees, 64 to 1,000,000; the memory depends on it. Default: 4096.
  uint32_t nodes;
  // Seed of the samples: the same seed gives the same path. Default: 1.
  uint64_t seed;
  // Array of part_count parts of the gripper as it holds the object. They may touch the object. May be null if
  // part_count is 0.
  const struct hangpose_capsule *parts;
  // Decides which poses of the object the robot can reach, as its inverse kinematics does; null, the default, for all.
  // It is asked as late and as seldom as possible: first about the goal and the start, then about the waypoints of paths
  // without collisions. Called during the call only, by the thread that makes it.
  hangpose_accepts accepts;
  // What `accepts` is given; the library does not look at it.
  void *context;
} hangpose_motion;

// Why there is no path, one of HANGPOSE_PLAN_*.
typedef uint32_t hangpose_plan_reason;

// A pose of a path at a time. Written by hangpose_plan_path and hangpose_predict_reachable.
typedef struct hangpose_waypoint {
  // sizeof(hangpose_waypoint), set by the library.
  uint32_t struct_size;
  // Time since the start, seconds.
  float seconds;
  // x, y, z of the origin of the object, metres, in supporter coordinates; or, after the gripper has let go, of the
  // object coordinates in which the gripper is given.
  float position[3];
  // x, y, z, w of the unit quaternion that rotates object coordinates into supporter coordinates.
  float quaternion[4];
} hangpose_waypoint;

// What moves into a collision, one of HANGPOSE_MOVER_*.
typedef uint32_t hangpose_mover;

// What stands in the way, one of HANGPOSE_OBSTACLE_*.
typedef uint32_t hangpose_obstacle;

// Why there is no path to a pose. Part of hangpose_plan, and written by hangpose_predict_reachable for each pose.
typedef struct hangpose_plan_failure {
  // sizeof(hangpose_plan_failure), set by the library.
  uint32_t struct_size;
  // One of HANGPOSE_PLAN_*; hangpose_plan_reason_string gives a text.
  hangpose_plan_reason reason;
  // HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with HANGPOSE_PLAN_STOPPED, else HANGPOSE_OK.
  hangpose_status stopped;
  // With HANGPOSE_PLAN_BUDGET_USED_UP the number of samples, with HANGPOSE_PLAN_TREES_FULL that of the nodes of a full
  // tree; else 0.
  uint32_t count;
  // With HANGPOSE_PLAN_ENCLOSED the width of the gaps that are taken as closed, metres; else NaN.
  float resolution;
  // With a collision what moves, one of HANGPOSE_MOVER_*; else HANGPOSE_MOVER_NONE.
  hangpose_mover mover;
  // Index in hangpose_motion.parts, or HANGPOSE_NO_INDEX.
  uint32_t part;
  // With a collision what stands in the way, one of HANGPOSE_OBSTACLE_*; else HANGPOSE_OBSTACLE_NONE.
  hangpose_obstacle obstacle;
  // Index in hangpose_request.scene_points or hangpose_request.hung, or HANGPOSE_NO_INDEX.
  uint32_t obstacle_index;
  // With a collision x, y, z of its place, metres, in supporter coordinates; else NaN.
  float position[3];
  // With a collision the distance of the two, metres: negative in penetration, or less than the clearance; else NaN.
  float distance;
} hangpose_plan_failure;

// Result of hangpose_plan_path and hangpose_predict_reachable beside the waypoints.
typedef struct hangpose_plan {
  // sizeof(hangpose_plan), set by the caller.
  uint32_t struct_size;
  // 1 if there is a path. Else 0, and the fields from waypoint_count to clearance are 0 or NaN.
  uint32_t has_path;
  // With hangpose_predict_reachable the index of the pose for which the path was planned, HANGPOSE_NO_INDEX if there is
  // no pose; else 0.
  uint32_t pose_index;
  // Number of waypoints of the object, at the front of the array: from the start to the release pose, and on towards the rest
  // pose, to where the object is 0.3 mm from the supporter; with hangpose_motion.take_off the other way.
  uint32_t waypoint_count;
  // Index of the release pose. The waypoints after it lower the object until it nearly touches.
  uint32_t release;
  // Number of waypoints of the opened gripper, after those of the object: away from it once it rests; with
  // hangpose_motion.take_off towards it, before it moves. 0 without a gripper.
  uint32_t gripper_waypoint_count;
  // Least distance of the object, or of the gripper that holds it, from everything else between start and release pose,
  // metres: a lower bound, at most 0.05.
  float clearance;
  // Why there is no path; its `reason` is HANGPOSE_PLAN_FOUND if there is one.
  struct hangpose_plan_failure failure;
  // Number of poses sampled.
  uint32_t samples;
  // Number of nodes of the trees.
  uint32_t nodes;
  // Number of poses tested for collision.
  uint32_t tested;
  // Number of poses that hangpose_motion.accepts was asked about.
  uint32_t asked;
  // Number of rays cast.
  uint64_t rays;
  // Number of distance and inside-outside queries.
  uint64_t distance_queries;
} hangpose_plan;

// Resolution and extent of a volume, and how far its completion may go. Set the struct with
// hangpose_volume_settings_init, then change single fields.
typedef struct hangpose_volume_settings {
  // sizeof(hangpose_volume_settings), set by hangpose_volume_settings_init.
  uint32_t struct_size;
  // 1 to store all of the crop box, so that the volume can be completed; 0 to store only the surroundings of the
  // surfaces. Default: 0.
  uint32_t dense;
  // 1 if a camera sees past everything at pixels without a depth, except for gaps of up to 7 pixels. It holds for an
  // object that is held alone, with nothing behind it within the camera's range. Else 0, the default.
  uint32_t missing_is_free;
  // Distance between neighbouring voxels, metres. The voxels are at its integer multiples in world coordinates.
  float voxel;
  // Distance from the surface at which distances are cut off, metres: 2 to 32 voxels. Larger values bear more noise;
  // walls thinner than half of it become thicker than they are. Default: 4 voxels.
  float truncation;
  // Depth along the z axis of the camera beyond which surfaces are not stored, metres. What is before them is still
  // free. Default: 5.
  float max_depth;
  // For a completion: greatest thickness behind a surface that was seen from one side only and does not curve around
  // what is behind it, metres. Default: 0.01.
  float thickness;
  // For a completion: greatest radius of a ball that surfaces hold from two sides, metres. A bar of a greater radius
  // stays open. Default: 0.06.
  float radius;
  // Two rows of x, y, z: lower and upper corner of the box outside of which nothing is stored, metres, in world
  // coordinates. Null for everything within 32767 voxels of the origin, which a dense volume cannot store. Default:
  // null.
  const float *crop;
} hangpose_volume_settings;

// A pinhole camera with Brown-Conrady distortion. Its coordinates are those of OpenCV and of optical frames in ROS: x to
// the right, y down, z forward. Pixel (0, 0) is the centre of the upper left pixel.
typedef struct hangpose_camera {
  // Width of the image, pixels.
  uint32_t width;
  // Height of the image, pixels.
  uint32_t height;
  // fx, fy: focal lengths, pixels.
  float focal[2];
  // cx, cy: principal point, pixels.
  float centre[2];
  // k1, k2, p1, p2, k3: coefficients of the distortion, in the order of OpenCV and of plumb_bob in ROS, no unit; zeros
  // where there is none or it was removed.
  float distortion[5];
} hangpose_camera;

// A depth image in the caller's arrays, with its camera. The library keeps no pointer to the arrays after the call.
typedef struct hangpose_depth_image {
  // sizeof(hangpose_depth_image), set by the caller.
  uint32_t struct_size;
  // Number of depths: the width times the height of the camera's image.
  uint32_t depth_count;
  // Number of labels: depth_count, or 0 if there are none.
  uint32_t label_count;
  // Metres for each unit of depth: 0.001 where the depths are millimetres.
  float scale;
  // The camera that took the image.
  struct hangpose_camera camera;
  // Pose of the camera: x, y, z of its position, metres, in world coordinates, each within +-1,000,000.
  float position[3];
  // Pose of the camera: x, y, z, w of the quaternion that rotates camera coordinates into world coordinates; any length
  // but zero.
  float quaternion[4];
  // Array of depth_count distances along the z axis of the camera, row by row, in units of `scale`. 0 and 65535 mean
  // that nothing was seen.
  const uint16_t *depths;
  // Array of label_count labels, row by row: a segmentation of the image. Surfaces are taken only from pixels with the
  // label `label`; the others still show where space is free. May be null: all pixels count.
  const uint8_t *labels;
  // Label of the pixels that count.
  uint8_t label;
} hangpose_depth_image;

// Which pixels of a depth image become points. Set the struct with hangpose_points_settings_init, then change single
// fields.
typedef struct hangpose_points_settings {
  // sizeof(hangpose_points_settings), set by hangpose_points_settings_init.
  uint32_t struct_size;
  // Only every so many columns and rows give points; at least 1, the default.
  uint32_t stride;
  // Greatest depth along the z axis of the camera, metres. Default: 5.
  float max_depth;
  // Standard deviation of the depth at one metre, metres; 0 to 1. It grows with the square of the depth. Default:
  // 0.0014, that of structured light.
  float noise;
  // Least cosine of the angle between the normal and the direction to the camera; 0.01 to 0.99. Default: 0.2.
  float least_cosine;
  // Two rows of x, y, z: lower and upper corner of the box outside of which there are no points, metres, in world
  // coordinates. Null for no box, the default.
  const float *crop;
} hangpose_points_settings;

// The call is done.
#define HANGPOSE_OK 0

// No pose was found in which the object hangs; hangpose_prediction.stage names the step of the method that left
// none.
#define HANGPOSE_REJECTED 1

// hangpose_monitor_cancel was called. hangpose_predict returns the best poses found so far; a cancelled analysis
// creates no model, and a cancelled change of a volume may have changed a part of it.
#define HANGPOSE_CANCELLED 2

// The work limit of the monitor was reached, in this call or in the analysis of one of its models. The results
// found so far are returned. hangpose_volume_integrate has none, and leaves the volume as it was.
#define HANGPOSE_WORK_LIMIT 3

// No path was found to the pose, or to any of the poses; hangpose_plan.failure says why.
#define HANGPOSE_NO_PATH 4

// A required pointer is null.
#define HANGPOSE_ERROR_NULL (-1)

// A pointer is not aligned for its type. Memory for models and work may begin at any address.
#define HANGPOSE_ERROR_MISALIGNED (-2)

// A struct_size is not the size of its struct: it was not set, or the program was compiled with another header.
#define HANGPOSE_ERROR_STRUCT_SIZE (-3)

// The program was compiled with the header of another version of the library.
#define HANGPOSE_ERROR_ABI_VERSION (-4)

// The memory is smaller than its size query requires.
#define HANGPOSE_ERROR_MEMORY (-5)

// Memory that the call writes overlaps another argument.
#define HANGPOSE_ERROR_OVERLAP (-6)

// A model or a monitor was never created, was moved, or was overwritten.
#define HANGPOSE_ERROR_HANDLE (-7)

// A supporter or a volume cannot be changed while another thread uses it, or used while another thread changes it.
#define HANGPOSE_ERROR_BUSY (-8)

// The supporter is empty because its last update was cancelled.
#define HANGPOSE_ERROR_EMPTY (-9)

// A count is zero or above its maximum.
#define HANGPOSE_ERROR_COUNT (-10)

// A number is outside its range, infinite or not a number.
#define HANGPOSE_ERROR_VALUE (-11)

// An index refers to an element that does not exist.
#define HANGPOSE_ERROR_INDEX (-12)

// Every triangle of the mesh has zero area.
#define HANGPOSE_ERROR_DEGENERATE (-13)

// The params require a signed distance field, but the object was analysed with voxels = 0, or an object that hangs
// already was.
#define HANGPOSE_ERROR_NO_DISTANCE_FIELD (-14)

// The result does not fit into the caller's array or into the blocks of the volume. hangpose_detail.minimum is the
// least capacity that may hold it.
#define HANGPOSE_ERROR_CAPACITY (-15)

// Depth images show nothing: no pixel has a depth, or none that has one is of use.
#define HANGPOSE_ERROR_BLANK (-16)

// A sparse volume does not know what is free, so it cannot be completed.
#define HANGPOSE_ERROR_SPARSE (-17)

// No step: there are poses, or the search was stopped.
#define HANGPOSE_STAGE_NONE 0

// No part of the object's surface faces its centre of mass, or the parts that do are too small.
#define HANGPOSE_STAGE_NO_CONTACT_POINTS 1

// The object has no free space for a supporter beside its contact points.
#define HANGPOSE_STAGE_NO_FREE_SPACE 2

// The free spaces are open to the side, so a supporter would slip out.
#define HANGPOSE_STAGE_NOT_ENCIRCLED 3

// No part of the supporter faces up and holds together.
#define HANGPOSE_STAGE_NO_SUPPORT 4

// The supporter is too thick for every free space of the object.
#define HANGPOSE_STAGE_TOO_THICK 5

// The supporter penetrates the object in every pose.
#define HANGPOSE_STAGE_ALL_COLLIDE 6

// The released object rotates off the supporter, in all or most of the tried poses.
#define HANGPOSE_STAGE_ROTATES_OFF 7

// The released object slides off or falls through, in all or most of the tried poses.
#define HANGPOSE_STAGE_SLIDES_OFF 8

// The released object does not come to rest.
#define HANGPOSE_STAGE_NEVER_RESTS 9

// The object comes to rest, but a small disturbance would bring it down, it is wedged and would not come off again, or
// there is no room to release it there.
#define HANGPOSE_STAGE_TOO_LOOSE 10

// The object comes to rest firmly enough, but too much of what would carry it or be in its way was not seen by any camera.
#define HANGPOSE_STAGE_UNSEEN 11

// The region that was asked for has no place to hang on or by, or the object comes to rest outside of it:
// hangpose_request.on and hangpose_request.by.
#define HANGPOSE_STAGE_OUTSIDE_REGION 12

// The poses touch the scene or an object that hangs already: hangpose_request.scene_points and hangpose_request.hung.
#define HANGPOSE_STAGE_IN_SCENE 13

// The object stays, but hangs in another way than those that are allowed: hangpose_request.allow.
#define HANGPOSE_STAGE_OTHER_KIND 14

// The object stays, but no straight way in the direction that was asked for leads to the pose:
// hangpose_request.has_approach.
#define HANGPOSE_STAGE_NO_APPROACH 15

// The object comes to rest firmly enough, but where the supporter would carry its points are so far apart that they hardly
// tell its shape.
#define HANGPOSE_STAGE_TOO_SPARSE 16

// The library's own method.
#define HANGPOSE_PROFILE_DEFAULT 0

// The published method with the constants of its Table I.
#define HANGPOSE_PROFILE_PAPER 1

// The mean of the surface samples: h_c of eq. (3).
#define HANGPOSE_CENTRE_OF_MASS_SAMPLE_MEAN 0

// The centroid of the volume if the mesh is closed, else the mean of the surface samples.
#define HANGPOSE_CENTRE_OF_MASS_VOLUME 1

// The point hangpose_params.given_centre_of_mass.
#define HANGPOSE_CENTRE_OF_MASS_GIVEN 2

// Every hanging site of the object on every support site, as the paper matches them: section II-D.
#define HANGPOSE_CANDIDATES_SITES 0

// Every contact candidate of the object on every contact candidate of the supporter.
#define HANGPOSE_CANDIDATES_CONTACTS 1

// A bar of the supporter runs through a loop of the object. The two are linked: no motion frees the object but one
// past the end of the bar.
#define HANGPOSE_KIND_THREADED 1

// An open hook of the one holds the other: the object is caught on both sides of the bar, and comes free by lifting.
#define HANGPOSE_KIND_HOOKED 2

// The object stands over a tip of the supporter with its cavity, as a cap on a peg or a mug upside down.
#define HANGPOSE_KIND_CAPPED 4

// The object is caught on one side at most: friction or balance holds it.
#define HANGPOSE_KIND_BALANCED 8

// Every kind.
#define HANGPOSE_KIND_ALL 15

// All of the object or of the supporter. No other field counts.
#define HANGPOSE_REGION_EVERYWHERE 0

// What is in the box from hangpose_region.low to hangpose_region.high.
#define HANGPOSE_REGION_BOX 1

// What is within hangpose_region.radius of points: of one point for "here", or of a part of the supporter's cloud.
#define HANGPOSE_REGION_POINTS 2

// What is within hangpose_region.radius of triangles of a mesh.
#define HANGPOSE_REGION_TRIANGLES 3

// There is a path.
#define HANGPOSE_PLAN_FOUND 0

// No path was planned, because there is no pose, or because a better pose has a path.
#define HANGPOSE_PLAN_NOT_TRIED 1

// The release pose is in collision: hangpose_plan_failure.mover and the fields after it say where.
#define HANGPOSE_PLAN_GOAL_IN_COLLISION 2

// The given start is in collision.
#define HANGPOSE_PLAN_START_IN_COLLISION 3

// The release pose or the rest pose is outside of the workspace, or hangpose_motion.accepts refused it.
#define HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE 4

// The given start is outside of the workspace, or hangpose_motion.accepts refused it; or no start was given and none was
// found.
#define HANGPOSE_PLAN_START_OUTSIDE_WORKSPACE 5

// There is no path, whatever the budget: the object and the supporter are linked like two rings of a chain, or the object
// is in a cage. Gaps between points of the supporter that are narrower than hangpose_plan_failure.resolution are taken as
// closed.
#define HANGPOSE_PLAN_ENCLOSED 6

// No path was found within hangpose_motion.samples.
#define HANGPOSE_PLAN_BUDGET_USED_UP 7

// No path was found before the trees were full: hangpose_motion.nodes.
#define HANGPOSE_PLAN_TREES_FULL 8

// The object has a path, but when the gripper opens it collides.
#define HANGPOSE_PLAN_GRIPPER_CANNOT_OPEN 9

// The object has a path, but the opened gripper has no way out.
#define HANGPOSE_PLAN_GRIPPER_CANNOT_LEAVE 10

// The monitor stopped the search: hangpose_plan_failure.stopped.
#define HANGPOSE_PLAN_STOPPED 11

// Nothing: there is no collision.
#define HANGPOSE_MOVER_NONE 0

// The object.
#define HANGPOSE_MOVER_OBJECT 1

// A part of the gripper.
#define HANGPOSE_MOVER_GRIPPER 2

// Nothing: there is no collision.
#define HANGPOSE_OBSTACLE_NONE 0

// The supporter.
#define HANGPOSE_OBSTACLE_SUPPORTER 1

// A point of hangpose_request.scene_points.
#define HANGPOSE_OBSTACLE_SCENE 2

// An object of hangpose_request.hung.
#define HANGPOSE_OBSTACLE_HUNG 3

// The object that has been hung.
#define HANGPOSE_OBSTACLE_OBJECT 4

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Returns the HANGPOSE_ABI_VERSION with which the library was built.
uint32_t hangpose_abi_version(void);

// Returns HANGPOSE_OK if `abi_version` is the version of the library, else HANGPOSE_ERROR_ABI_VERSION. Pass
// HANGPOSE_ABI_VERSION.
hangpose_status hangpose_check_abi(uint32_t abi_version);

// Returns the version of the library, for example "0.1.0"; a static string, never null.
const char *hangpose_version(void);

// Returns the meaning of a status in English; a static string, never null.
const char *hangpose_status_string(hangpose_status status);

// Returns the meaning of a stage in English; a static string, never null.
const char *hangpose_stage_string(hangpose_stage stage);

// Sets all fields of `params` to the defaults of `profile`, one of HANGPOSE_PROFILE_*. `struct_size` is
// sizeof(hangpose_params), `abi_version` is HANGPOSE_ABI_VERSION. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_params_init(struct hangpose_params *params,
                                     size_t struct_size,
                                     hangpose_profile profile,
                                     uint32_t abi_version,
                                     struct hangpose_detail *detail);

// Sets `limits` to what `params`, `mesh` and `cloud` need, with `poses` 1, `nodes` that of hangpose_motion_init, and no
// scene points and waypoints. `mesh` or `cloud` may be null and then counts as empty. Only the counts are read, not the
// arrays. Set limits->struct_size before the call. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_limits_of(const struct hangpose_params *params,
                                   const struct hangpose_mesh *mesh,
                                   const struct hangpose_cloud *cloud,
                                   struct hangpose_limits *limits,
                                   struct hangpose_detail *detail);

// Returns the bytes of memory for any object within `limits`; depends on vertices, triangles, samples and voxels.
// Returns 0 if `limits` is null or its struct_size is wrong. For limits beyond any memory the result is larger
// than any memory; it does not wrap around.
size_t hangpose_object_bytes(const struct hangpose_limits *limits);

// Returns the bytes of memory for any supporter within `limits`; depends on points. Returns 0 if `limits` is null
// or its struct_size is wrong. For limits beyond any memory the result is larger than any memory; it does not wrap
// around.
size_t hangpose_supporter_bytes(const struct hangpose_limits *limits);

// Returns the bytes of working memory for hangpose_predict or hangpose_predict_many with any object and supporter
// within `limits`; depends on points and poses. Returns 0 if `limits` is null or its struct_size is wrong. For limits
// beyond any memory the result is larger than any memory; it does not wrap around.
size_t hangpose_predict_bytes(const struct hangpose_limits *limits);

// Returns the bytes of working memory for hangpose_plan_path with any object and supporter within `limits`; depends on
// points, scene_points, nodes and waypoints. Returns 0 if `limits` is null or its struct_size is wrong. For limits beyond
// any memory the result is larger than any memory; it does not wrap around.
size_t hangpose_plan_bytes(const struct hangpose_limits *limits);

// Returns the bytes of working memory for hangpose_predict_reachable with any object and supporter within `limits`;
// depends on points, poses, scene_points, nodes and waypoints. Returns 0 if `limits` is null or its struct_size is wrong.
// For limits beyond any memory the result is larger than any memory; it does not wrap around.
size_t hangpose_reachable_bytes(const struct hangpose_limits *limits);

// Initialises a monitor, or resets a used one for the next call: not cancelled, no progress. No call may be using
// it. `struct_size` is sizeof(hangpose_monitor). Returns HANGPOSE_OK, or an error.
//
// `work_limit` is the greatest number of rays and distance queries in each call that takes the monitor, or
// HANGPOSE_NO_WORK_LIMIT. A call that reaches it returns the best result so far. The limit counts work and not
// time, so a limited call gives the same result on every machine.
hangpose_status hangpose_monitor_init(struct hangpose_monitor *monitor,
                                      size_t struct_size,
                                      uint64_t work_limit,
                                      struct hangpose_detail *detail);

// Makes the call that uses this monitor stop soon; later calls stop at once, until hangpose_monitor_init. Does
// nothing if the monitor is null or was never initialised.
void hangpose_monitor_cancel(struct hangpose_monitor *monitor);

// Returns 1 if hangpose_monitor_cancel was called, else 0; 0 if the monitor is null or was never initialised.
uint32_t hangpose_monitor_is_cancelled(const struct hangpose_monitor *monitor);

// Returns the progress of the call that uses this monitor, from 0 to 1; 0 if the monitor is null or was never
// initialised.
float hangpose_monitor_progress(const struct hangpose_monitor *monitor);

// Lends the calls that use `monitor` a second thread, until hangpose_monitor_init. `threads` must stay where it is and as it is until
// then. No call may be using the monitor. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_monitor_use_threads(struct hangpose_monitor *monitor,
                                             const struct hangpose_threads *threads,
                                             struct hangpose_detail *detail);

// Analyses `mesh` in `memory` and sets `*object` to the result, which stays in `memory`. `memory_size` is at least
// hangpose_object_bytes for the size of `mesh` and for `params`. `mesh`, its arrays and `params` are needed during
// the call only. `monitor` may be null.
//
// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT with an object that may have more sites or contact candidates than were
// found; HANGPOSE_CANCELLED or an error without an object. `*object` is then null, unless its address is part of
// another argument.
hangpose_status hangpose_object_create(void *memory,
                                       size_t memory_size,
                                       const struct hangpose_mesh *mesh,
                                       const struct hangpose_params *params,
                                       struct hangpose_monitor *monitor,
                                       struct hangpose_object **object,
                                       struct hangpose_detail *detail);

// Writes the result of the analysis to `info`. Set info->struct_size before the call. Returns HANGPOSE_OK, or an
// error.
hangpose_status hangpose_object_get_info(const struct hangpose_object *object,
                                         struct hangpose_object_info *info,
                                         struct hangpose_detail *detail);

// Writes hanging site `index` to `site`. `index` is less than hangpose_object_info.sites; site 0 is encircled
// best. Set site->struct_size before the call. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_object_get_site(const struct hangpose_object *object,
                                         uint32_t index,
                                         struct hangpose_object_site *site,
                                         struct hangpose_detail *detail);

// Writes contact candidate `index` to `contact`. `index` is less than hangpose_object_info.contacts; candidate 0
// has the greatest capture. Set contact->struct_size before the call. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_object_get_contact(const struct hangpose_object *object,
                                            uint32_t index,
                                            struct hangpose_object_contact *contact,
                                            struct hangpose_detail *detail);

// Writes detected symmetry `index` to `symmetry`. `index` is less than hangpose_object_info.symmetries. Set
// symmetry->struct_size before the call. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_object_get_symmetry(const struct hangpose_object *object,
                                             uint32_t index,
                                             struct hangpose_symmetry *symmetry,
                                             struct hangpose_detail *detail);

// Analyses `cloud` in `memory` and sets `*supporter` to the result, which stays in `memory`. `memory_size` is at
// least hangpose_supporter_bytes for the size of `cloud`; memory for more points leaves room for later updates.
// `cloud`, its arrays and `params` are needed during the call only. `monitor` may be null.
//
// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT with a supporter that may have more sites or contact candidates than
// were found; HANGPOSE_CANCELLED or an error without a supporter. `*supporter` is then null, unless its address is
// part of another argument.
hangpose_status hangpose_supporter_create(void *memory,
                                          size_t memory_size,
                                          const struct hangpose_cloud *cloud,
                                          const struct hangpose_params *params,
                                          struct hangpose_monitor *monitor,
                                          struct hangpose_supporter **supporter,
                                          struct hangpose_detail *detail);

// Replaces the cloud of `supporter` by a new one and analyses it in the same memory. `monitor` may be null. No
// other thread may use the supporter during the call; if one does, the call returns HANGPOSE_ERROR_BUSY.
//
// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT as hangpose_supporter_create does; HANGPOSE_CANCELLED, and the
// supporter is empty until an update succeeds; or an error, and the supporter is unchanged.
hangpose_status hangpose_supporter_update(struct hangpose_supporter *supporter,
                                          const struct hangpose_cloud *cloud,
                                          const struct hangpose_params *params,
                                          struct hangpose_monitor *monitor,
                                          struct hangpose_detail *detail);

// Writes the result of the analysis to `info`. Set info->struct_size before the call. Returns HANGPOSE_OK, or an
// error.
hangpose_status hangpose_supporter_get_info(const struct hangpose_supporter *supporter,
                                            struct hangpose_supporter_info *info,
                                            struct hangpose_detail *detail);

// Writes support site `index` to `site`. `index` is less than hangpose_supporter_info.sites; site 0 is the
// thinnest. Set site->struct_size before the call. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_supporter_get_site(const struct hangpose_supporter *supporter,
                                            uint32_t index,
                                            struct hangpose_supporter_site *site,
                                            struct hangpose_detail *detail);

// Writes contact candidate `index` to `contact`. `index` is less than hangpose_supporter_info.contacts. Set
// contact->struct_size before the call. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_supporter_get_contact(const struct hangpose_supporter *supporter,
                                               uint32_t index,
                                               struct hangpose_supporter_contact *contact,
                                               struct hangpose_detail *detail);

// Returns the name of one kind: "threaded", "hooked", "capped" or "balanced", and "no kind" for anything else; a
// static string, never null.
const char *hangpose_kind_string(hangpose_kind kind);

// Sets `request` to anything anywhere, as a null request of hangpose_predict. `struct_size` is
// sizeof(hangpose_request). Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_request_init(struct hangpose_request *request,
                                      size_t struct_size,
                                      struct hangpose_detail *detail);

// Finds poses in which `object` hangs on `supporter` as `request` asks and writes the best to `poses`, best first.
// Both models must have been analysed with these `params`. `request` may be null: anything anywhere.
//
// `memory` is working memory of at least hangpose_predict_bytes, needed during the call only. `monitor` may be
// null. `poses` is an array of `pose_capacity` structs, at least 1; a larger capacity may take more time.
// `pose_size` is sizeof(hangpose_pose). Set prediction->struct_size before the call; prediction->pose_count is the
// number of poses written. Concurrent calls may share the models, `request` and `params`, and need their own `memory`,
// `poses`, `prediction` and `detail`.
//
// Returns HANGPOSE_OK with at least one pose; HANGPOSE_REJECTED with none, and prediction->stage gives the reason;
// HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with the best poses found so far, possibly none; or an error.
hangpose_status hangpose_predict(const struct hangpose_object *object,
                                 const struct hangpose_supporter *supporter,
                                 const struct hangpose_request *request,
                                 const struct hangpose_params *params,
                                 void *memory,
                                 size_t memory_size,
                                 struct hangpose_monitor *monitor,
                                 struct hangpose_pose *poses,
                                 size_t pose_size,
                                 uint32_t pose_capacity,
                                 struct hangpose_prediction *prediction,
                                 struct hangpose_detail *detail);

// Finds poses in which all of `objects` hang on `supporter` at once, each as `request` asks and clear of the others.
//
// `objects` is an array of `object_count` objects, 1 to HANGPOSE_MAX_HUNG; copies are the same pointer several times.
// `poses` is an array of as many structs in the order of the objects: `has_pose` of one is 0 if there is no room
// for it. The first objects choose first. At most HANGPOSE_MAX_HUNG hang in the end, with those that hang already; the
// objects beyond have no pose. The models must have been analysed with these `params`, of which `settle` must be 1.
//
// `memory` is working memory of at least hangpose_predict_bytes with limits.poses = object_count. A work limit of
// `monitor` holds for each of the predictions of which the call consists: one for each object, and up to two for each
// pair of them. Set many->struct_size before the call. Everything else is as for hangpose_predict.
//
// Returns HANGPOSE_OK if at least one object has a pose, and many->placed says how many; HANGPOSE_REJECTED if none has,
// and many->stage gives the reason; HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with the poses found so far, possibly
// none; or an error.
hangpose_status hangpose_predict_many(const struct hangpose_object *const *objects,
                                      uint32_t object_count,
                                      const struct hangpose_supporter *supporter,
                                      const struct hangpose_request *request,
                                      const struct hangpose_params *params,
                                      void *memory,
                                      size_t memory_size,
                                      struct hangpose_monitor *monitor,
                                      struct hangpose_pose *poses,
                                      size_t pose_size,
                                      struct hangpose_many *many,
                                      struct hangpose_detail *detail);

// Sets `motion` to the defaults: from anywhere outside of the supporter's bounds, without a gripper and a workspace.
// `struct_size` is sizeof(hangpose_motion). Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_motion_init(struct hangpose_motion *motion,
                                     size_t struct_size,
                                     struct hangpose_detail *detail);

// Returns the meaning of a reason in English; a static string, never null.
const char *hangpose_plan_reason_string(hangpose_plan_reason reason);

// Plans a path of `object` to the pose `goal` on `supporter`, and of the gripper away from it; or, with
// hangpose_motion.take_off, the other way. Both models must have been analysed with these `params`, the object with
// hangpose_params.voxels.
//
// `goal` is a pose of hangpose_predict or one of the caller's, of which struct_size, has_pose = 1, position, quaternion and
// has_rest are read, and with has_rest = 1 rest_position and rest_quaternion. Of `request` the scene and the
// objects that hang already are obstacles; it may be null. `motion` may be null: from anywhere, without a gripper.
//
// `memory` is working memory of at least hangpose_plan_bytes, needed during the call only. `monitor` may be null.
// `waypoints` is an array of `waypoint_capacity` structs, and `waypoint_size` is sizeof(hangpose_waypoint). Set
// plan->struct_size before the call. Everything else is as for hangpose_predict.
//
// Returns HANGPOSE_OK with a path; HANGPOSE_NO_PATH without one, and plan->failure gives the reason; HANGPOSE_CANCELLED or
// HANGPOSE_WORK_LIMIT if the monitor stopped the search; HANGPOSE_ERROR_CAPACITY if the path has more waypoints than there
// is room for; or another error.
hangpose_status hangpose_plan_path(const struct hangpose_object *object,
                                   const struct hangpose_supporter *supporter,
                                   const struct hangpose_request *request,
                                   const struct hangpose_params *params,
                                   const struct hangpose_motion *motion,
                                   const struct hangpose_pose *goal,
                                   void *memory,
                                   size_t memory_size,
                                   struct hangpose_monitor *monitor,
                                   struct hangpose_waypoint *waypoints,
                                   size_t waypoint_size,
                                   uint32_t waypoint_capacity,
                                   struct hangpose_plan *plan,
                                   struct hangpose_detail *detail);

// Does what hangpose_predict does, then plans a path to one pose after another, best first, until one has a path, as
// hangpose_plan_path does. The models must have been analysed with hangpose_params.voxels.
//
// `failures` is an array of `pose_capacity` structs, or null: for each of `poses` whether it has a path, and if not, why.
// `failure_size` is sizeof(hangpose_plan_failure). `plan` and `waypoints` are those of the last pose for which a path was
// planned, whose index is plan->pose_index. `memory` is working memory of at least hangpose_reachable_bytes. Set
// prediction->struct_size and plan->struct_size before the call. A work limit of `monitor` holds for the prediction and
// for each of the plans.
//
// Returns HANGPOSE_OK with a path; HANGPOSE_NO_PATH with poses none of which has one; HANGPOSE_REJECTED without poses;
// HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with what was found so far, possibly with a path; HANGPOSE_ERROR_CAPACITY if
// the path has more waypoints than there is room for; or another error.
hangpose_status hangpose_predict_reachable(const struct hangpose_object *object,
                                           const struct hangpose_supporter *supporter,
                                           const struct hangpose_request *request,
                                           const struct hangpose_params *params,
                                           const struct hangpose_motion *motion,
                                           void *memory,
                                           size_t memory_size,
                                           struct hangpose_monitor *monitor,
                                           struct hangpose_pose *poses,
                                           size_t pose_size,
                                           uint32_t pose_capacity,
                                           struct hangpose_plan_failure *failures,
                                           size_t failure_size,
                                           struct hangpose_waypoint *waypoints,
                                           size_t waypoint_size,
                                           uint32_t waypoint_capacity,
                                           struct hangpose_prediction *prediction,
                                           struct hangpose_plan *plan,
                                           struct hangpose_detail *detail);

// Returns the bytes of working memory that hangpose_mesh_sample needs for `count` samples.
size_t hangpose_sample_bytes(uint32_t count);

// Samples `count` evenly spread points, 1 to 500000, and their normals from a mesh: the cloud of a supporter whose
// mesh is known. `points` and `normals` are arrays of `count` rows of x, y, z: metres and unit vectors, in the
// coordinates of the mesh. `memory` is working memory of at least hangpose_sample_bytes, needed during the call
// only. The same seed gives the same samples. Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_mesh_sample(const struct hangpose_mesh *mesh,
                                     uint64_t seed,
                                     void *memory,
                                     size_t memory_size,
                                     float *points,
                                     float *normals,
                                     uint32_t count,
                                     struct hangpose_detail *detail);

// Sets `settings` to the defaults for voxels of this size, metres: about the distance between the points of
// neighbouring pixels. `struct_size` is sizeof(hangpose_volume_settings). Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_volume_settings_init(struct hangpose_volume_settings *settings,
                                              size_t struct_size,
                                              float voxel,
                                              struct hangpose_detail *detail);

// Sets `crop`, two rows of x, y, z, to the lower and upper corner of a crop box around an object that is held alone:
// around what the pixels of `images` show, and around the room behind it that a completion may fill. Metres, in world
// coordinates. `images` is an array of `image_count` structs, at least 1. Of the `settings`, `dense` and `crop` are
// not used. Returns HANGPOSE_OK; or an error, such as HANGPOSE_ERROR_BLANK if no pixel of the label shows anything up to
// settings->max_depth.
hangpose_status hangpose_volume_room(const struct hangpose_depth_image *images,
                                     uint32_t image_count,
                                     const struct hangpose_volume_settings *settings,
                                     float *crop,
                                     struct hangpose_detail *detail);

// Returns the number of blocks of 8 x 8 x 8 voxels in the crop box: what a dense volume takes. Returns 0 if `settings`
// is null, has no crop box or is not valid.
uint32_t hangpose_volume_blocks(const struct hangpose_volume_settings *settings);

// Returns the bytes of memory for a volume of up to this many blocks of 8 x 8 x 8 voxels, about 2.1 KiB each.
size_t hangpose_volume_bytes(uint32_t blocks);

// Returns the bytes of working memory that hangpose_volume_complete needs for a volume of up to this many blocks, at
// most 6.7 KiB each.
size_t hangpose_complete_bytes(uint32_t blocks);

// Returns the bytes of working memory that hangpose_volume_surface needs for a volume of up to this many blocks, 244
// each.
size_t hangpose_surface_bytes(uint32_t blocks);

// Creates an empty volume in `memory` and sets `*volume` to it. It has room for `blocks` blocks of 8 x 8 x 8
// voxels, 1 to 8388607: hangpose_volume_blocks for a dense volume; for a sparse one, those within the truncation
// of the surfaces. `memory_size` is at least hangpose_volume_bytes for `blocks`. `settings` are needed during the
// call only.
//
// Returns HANGPOSE_OK, or an error without a volume. `*volume` is then null, unless its address is part of another
// argument.
hangpose_status hangpose_volume_create(void *memory,
                                       size_t memory_size,
                                       const struct hangpose_volume_settings *settings,
                                       uint32_t blocks,
                                       struct hangpose_volume **volume,
                                       struct hangpose_detail *detail);

// Fuses an image. With settings.missing_is_free, pixels without a depth show free space; else they say nothing. Sets
// `*pixels` to the number of pixels with the label and a surface within the volume; 0 says that the image shows nothing
// of it. `image` and its arrays are needed during the call only. `monitor` may be null; a pixel counts as one ray of its
// work limit.
//
// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT or an error, and the volume is as it was before; or HANGPOSE_CANCELLED, and a part
// of the image may be fused, as if labels hid the rest. After HANGPOSE_ERROR_CAPACITY, create a volume of more blocks and fuse
// all images again.
hangpose_status hangpose_volume_integrate(struct hangpose_volume *volume,
                                          const struct hangpose_depth_image *image,
                                          struct hangpose_monitor *monitor,
                                          uint32_t *pixels,
                                          struct hangpose_detail *detail);

// Guesses what no image shows of an object that is held alone, with hangpose_volume_settings.thickness and radius. The
// surface is then closed. What was seen stays as it is. The volume must be dense, and the cameras must have seen past the
// object: to a wall, or with settings.missing_is_free. `memory` is working memory of at least hangpose_complete_bytes,
// needed during the call only. `monitor` may be null.
//
// Returns HANGPOSE_OK; an error, and the volume is as it was before; or HANGPOSE_CANCELLED, and a part of the guesses may be
// written, which another call completes.
hangpose_status hangpose_volume_complete(struct hangpose_volume *volume,
                                         void *memory,
                                         size_t memory_size,
                                         struct hangpose_monitor *monitor,
                                         struct hangpose_detail *detail);

// Finds the surface of a volume and sets `mesh` to it, ready for hangpose_object_create: in world coordinates, with
// corners that are counter-clockwise seen from free space. Set mesh->struct_size before the call, and mesh->viewpoints to
// the positions of the cameras after it. Where neither an image
// nor hangpose_volume_complete says what is there, the mesh is open. If no image shows a surface, its counts are 0.
//
// `vertices` is an array of `vertex_capacity` rows and `triangles` one of `triangle_capacity` rows, to which `mesh` will
// point. If both are null, only the counts of `mesh` are set. `seen` is an array of `vertex_capacity` marks: 1 for
// vertices that images show, 0 for those that were guessed. It may be null. `memory` is working memory of at least
// hangpose_surface_bytes, needed during the call only. `monitor` may be null.
//
// Returns HANGPOSE_OK; or HANGPOSE_CANCELLED or an error, and `mesh` is unchanged.
hangpose_status hangpose_volume_surface(const struct hangpose_volume *volume,
                                        void *memory,
                                        size_t memory_size,
                                        struct hangpose_monitor *monitor,
                                        float *vertices,
                                        uint32_t vertex_capacity,
                                        uint32_t *triangles,
                                        uint32_t triangle_capacity,
                                        uint8_t *seen,
                                        struct hangpose_mesh *mesh,
                                        struct hangpose_detail *detail);

// Sets `settings` to the defaults. `struct_size` is sizeof(hangpose_points_settings). Returns HANGPOSE_OK, or an error.
hangpose_status hangpose_points_settings_init(struct hangpose_points_settings *settings,
                                              size_t struct_size,
                                              struct hangpose_detail *detail);

// Writes the points that depth images show, their normals and the viewpoints to arrays and sets `cloud` to them, ready
// for hangpose_supporter_create: in world coordinates. Left out are pixels that an outline makes up between what is in
// front and what is behind, and those seen at a flat angle. Set cloud->struct_size before the call; cloud->marks and
// cloud->region are not changed.
//
// `images` is an array of `image_count` structs, at least 1. `points` and `normals` are arrays of `point_capacity` rows
// of x, y, z; the pixels of all images are always enough. `viewpoints` is an array of `image_count` rows. If all three
// are null, only the counts of `cloud` are set.
//
// Returns HANGPOSE_OK; or an error, such as HANGPOSE_ERROR_BLANK if there are no points, and `cloud` is unchanged.
hangpose_status hangpose_depth_points(const struct hangpose_depth_image *images,
                                      uint32_t image_count,
                                      const struct hangpose_points_settings *settings,
                                      float *points,
                                      float *normals,
                                      uint32_t point_capacity,
                                      float *viewpoints,
                                      struct hangpose_cloud *cloud,
                                      struct hangpose_detail *detail);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HANGPOSE_H */
