// hangpose: where and how to hang an object that a robot has never seen on a supporter that it has never seen.
//
// Made from ffi/src by `make header`; change it there.
//
// Memory. All of it is the caller's: static, on the heap or on the stack, and beginning anywhere. Beside each call that
// takes memory stands a query for how much, and for static arrays a macro. Models live in the memory that they were
// made in, and there is nothing to free: when the last call with a model has returned, the memory may be used for
// something else. Models must not be copied or moved.
//
// Pointers. One that is not null must lead to what its type says, to as many rows as the count beside it says, and no
// one else may write there during the call. Null, misaligned, too small, overlapping, NaN and what else can be seen is
// answered with a status, and nothing is done. Where null has a meaning, it is said.
//
// Threads. What a call takes as a pointer to const, any number of threads may use at once. The library has no state of
// its own, calls with different arguments never meet, and every call may be made from any thread.
//
// Structs. Each that is not a part of another begins with struct_size, which the caller sets to sizeof the struct, so that
// a program that was compiled with another header is refused and not misread. Functions ending in _init set it
// themselves.
//
// Numbers. Metres, radians, seconds; right-handed frames; gravity along -z unless the params say otherwise. A pose maps
// object coordinates to supporter coordinates. Quaternions are x, y, z, w. "eq." and "section" are of the paper:
// doi:10.1109/LRA.2024.3368297. The same input gives the same bits on every machine.

#ifndef HANGPOSE_H
#define HANGPOSE_H

#include <stddef.h>
#include <stdint.h>

// Bytes for static arrays: constant, and never less than the queries hangpose_object_bytes, hangpose_supporter_bytes
// and hangpose_predict_bytes. They are more, up to half of it, since they add up what is never needed at once; the queries
// are exact.
#define HANGPOSE_OBJECT_BYTES(vertices, triangles, samples, voxels)                                  \
  (HANGPOSE_OBJECT_BYTES_AT_LEAST + HANGPOSE_OBJECT_BYTES_EACH_VERTEX * (size_t)(vertices) +        \
   HANGPOSE_OBJECT_BYTES_EACH_TRIANGLE * (size_t)(triangles) +                                      \
   HANGPOSE_OBJECT_BYTES_EACH_SAMPLE * (size_t)(samples) +                                          \
   HANGPOSE_OBJECT_BYTES_EACH_VOXEL * (size_t)(voxels))
#define HANGPOSE_SUPPORTER_BYTES(points)                                                             \
  (HANGPOSE_SUPPORTER_BYTES_AT_LEAST + HANGPOSE_SUPPORTER_BYTES_EACH_POINT * (size_t)(points))
#define HANGPOSE_PREDICT_BYTES(points, poses)                                                        \
  (HANGPOSE_PREDICT_BYTES_AT_LEAST + HANGPOSE_PREDICT_BYTES_EACH_POINT * (size_t)(points) +         \
   HANGPOSE_PREDICT_BYTES_EACH_POSE * (size_t)(poses))
// What they are made of: the queries grow by no more than this for each.
#define HANGPOSE_OBJECT_BYTES_AT_LEAST 30720
#define HANGPOSE_OBJECT_BYTES_EACH_VERTEX 8
#define HANGPOSE_OBJECT_BYTES_EACH_TRIANGLE 180
#define HANGPOSE_OBJECT_BYTES_EACH_SAMPLE 312
#define HANGPOSE_OBJECT_BYTES_EACH_VOXEL 19
#define HANGPOSE_SUPPORTER_BYTES_AT_LEAST 17408
#define HANGPOSE_SUPPORTER_BYTES_EACH_POINT 243
#define HANGPOSE_PREDICT_BYTES_AT_LEAST 43008
#define HANGPOSE_PREDICT_BYTES_EACH_POINT 9
#define HANGPOSE_PREDICT_BYTES_EACH_POSE 384

// Version of the structs and functions in this header; another one than the library's is refused at run time, by
// hangpose_params_init and hangpose_check_abi.
#define HANGPOSE_ABI_VERSION 1

// Where there is no index.
#define HANGPOSE_NO_INDEX 4294967295

// Room for the longest field, with its NUL.
#define HANGPOSE_FIELD_CHARS 64

// Room for the longest message, with its NUL.
#define HANGPOSE_MESSAGE_CHARS 256

// No limit: a call takes as long as it takes.
#define HANGPOSE_NO_WORK_LIMIT 18446744073709551615ull

// Directions in which gravity is tilted.
#define HANGPOSE_DIRECTIONS 8

// Contacts that a pose tells of, at most.
#define HANGPOSE_MAX_CONTACTS 8

// An object, analysed once, at the front of the memory that it was made in. There is nothing to free; the memory must
// stay where it is, and no one else may write to it, for as long as the object is used. Any number of threads may use
// it at once.
typedef struct hangpose_object hangpose_object;

// A supporter, analysed, at the front of the memory that it was made in. There is nothing to free; the memory must stay
// where it is, and no one else may write to it, for as long as the supporter is used. Any number of threads may use it
// at once.
typedef struct hangpose_supporter hangpose_supporter;

// What became of a call. 0: done. Above 0: a good answer that is not, or not only, poses. Below 0: the caller's
// mistake; nothing was done, and hangpose_detail says what to mend.
typedef int32_t hangpose_status;

// The step of the method that left nothing to hang, one of HANGPOSE_STAGE_*.
typedef uint32_t hangpose_stage;

// What the object's centre of mass is taken to be, one of HANGPOSE_CENTRE_OF_MASS_*.
typedef uint32_t hangpose_centre_of_mass;

// Where the poses come from that are looked at, one of HANGPOSE_CANDIDATES_*.
typedef uint32_t hangpose_candidates;

// The constants of the method, with the paper's symbols. Set them with hangpose_params_init, and then change single
// ones. Every call that takes them checks each against its range.
typedef struct hangpose_params {
  // sizeof(hangpose_params), set by hangpose_params_init.
  uint32_t struct_size;
  // The centre of mass that the method works with, one of HANGPOSE_CENTRE_OF_MASS_*.
  hangpose_centre_of_mass centre_of_mass;
  // Seed of the surface samples.
  uint64_t seed;
  // x, y, z of the direction in which things fall, in supporter coordinates; any length but zero.
  float gravity[3];
  // x, y, z of the centre of mass, metres, in object coordinates; used with HANGPOSE_CENTRE_OF_MASS_GIVEN.
  float given_centre_of_mass[3];
  // N: points sampled from the object's surface; 100 to 500000.
  uint32_t samples;
  // alpha_h: least cosine between an object point's normal and its direction to the centre of mass, eq. (3); 0 to 1.
  float object_contact_cosine;
  // Radius of the mean shift's flat kernel, as a fraction of the bounding box's diagonal; 0.001 to 1.
  float cluster_bandwidth;
  // l_c: object clusters of this many points or fewer are dropped, eq. (4); 0 to 500000.
  uint32_t min_cluster_points;
  // N_h: positions tried between a contact point and the surface opposite, for the free space; 2 to 1000.
  uint32_t free_space_steps;
  // r_alpha: least free-space radius, metres; 0 to 1.
  float min_free_space_radius;
  // N_p: hanging directions tried at an object site; 1 to 720.
  uint32_t object_directions;
  // N_r: rays cast around each of those directions; 3 to 720.
  uint32_t rays_per_direction;
  // alpha_1: least share of the rays above the hanging position that must hit the object, eq. (6); 0 to 1.
  float min_encircled_above;
  // alpha_2: the same for the rays below it.
  float min_encircled_below;
  // r_beta: object sites whose free-space radii differ by less than this fraction may be merged, eq. (7); 0 to 1.
  float similar_radius;
  // beta: ... if the cosine between their hanging directions is above this, eq. (7); 0 to 1.
  float similar_direction;
  // alpha_s: least cosine between a supporter point's normal and up, section II-C; 0 to 1.
  float supporter_contact_cosine;
  // M_s: directions in which the supporter is sliced at each site; 1 to 720.
  uint32_t supporter_directions;
  // d_l: half the thickness of a slice, metres; 0.00001 to 1.
  float slice_half_thickness;
  // Points of a slice closer than this, metres, belong together; 0.00001 to 1.
  float slice_link_distance;
  // alpha_m: pairs whose free-space radius is below this times the support radius are dropped; 0 to 1.
  float radius_ratio;
  // Poses that put more than this fraction of the supporter's points inside the object are dropped; 0 to 1.
  float max_collision;
  // gamma_1: weight of the collision cost S_c, eq. (11); 0 to 1.
  float collision_weight;
  // gamma_2: weight of the boundary cost S_b, eq. (11); 0 to 1.
  float boundary_weight;
  // gamma_3: weight of the contact-area cost S_a, eq. (11); 0 to 1.
  float contact_area_weight;
  // Where poses come from, one of HANGPOSE_CANDIDATES_*. All above from cluster_bandwidth on is for
  // HANGPOSE_CANDIDATES_SITES.
  hangpose_candidates candidates;
  // 1 where gravity acts before the answer is given, so that only what comes to rest, and stays, is a pose; else 0.
  uint32_t settle;
  // Coulomb's coefficient of friction between object and supporter; 0 to 2.
  float friction;
  // How far off the supporter the object is let go, metres, where there is room for that; 0 to 0.01.
  float clearance;
  // Nodes of the object's signed distance field at most; 0 to 10000000, at least 1 for `settle` and for
  // HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t voxels;
  // Poses that are let go at most while none stays; once one does, no more than a quarter of that in all; 0 to 10000.
  uint32_t settle_attempts;
  // No more poses are let go when so many stayed firmly, with a probability of 97.5 % or more, be it twice in the same place; more
  // give more different poses to choose from; 0 to 10000.
  uint32_t firm_enough;
  // Poses that are less likely to hang than this are none; 0 to 1.
  float min_probability;
} hangpose_params;

// A set of defaults, one of HANGPOSE_PROFILE_*.
typedef uint32_t hangpose_profile;

// What a call has to say beside its status: which argument or field is wrong, and what it may be. Every call takes one,
// or null; it is written also where all is well. A detail belongs to one call at a time.
typedef struct hangpose_detail {
  // sizeof(hangpose_detail), set by the caller.
  uint32_t struct_size;
  // What the call returned.
  hangpose_status status;
  // The vertex, triangle or point that is wrong, or HANGPOSE_NO_INDEX.
  uint32_t index;
  // The value that is wrong; NaN where no number is.
  double value;
  // The least that it may be; NaN where there is no range.
  double minimum;
  // The most that it may be; NaN where there is no range.
  double maximum;
  // The argument or field that is wrong, such as "params.radius_ratio" or "memory", or "".
  char field[HANGPOSE_FIELD_CHARS];
  // A sentence for people: what is wrong and how to mend it.
  char message[HANGPOSE_MESSAGE_CHARS];
} hangpose_detail;

// A triangle mesh in the caller's arrays, in metres, corners counter-clockwise seen from outside. Open, overlapping and
// multi-body meshes are fine, and so are degenerate triangles, which are passed over. Nothing is kept after the call.
typedef struct hangpose_mesh {
  // sizeof(hangpose_mesh), set by the caller.
  uint32_t struct_size;
  // How many vertices there are.
  uint32_t vertex_count;
  // How many triangles there are.
  uint32_t triangle_count;
  // vertex_count rows of x, y, z; metres, in object coordinates, each within 1,000,000.
  const float *vertices;
  // triangle_count rows of three indices of vertices.
  const uint32_t *triangles;
} hangpose_mesh;

// A point cloud in the caller's arrays, in metres. Nothing is kept after the call.
typedef struct hangpose_cloud {
  // sizeof(hangpose_cloud), set by the caller.
  uint32_t struct_size;
  // How many points there are.
  uint32_t point_count;
  // point_count rows of x, y, z; metres, in supporter coordinates, each within 1,000,000.
  const float *points;
  // point_count rows of x, y, z, out of the solid, of any length; zeros where a normal is not known; or null, and
  // they are estimated.
  const float *normals;
  // x, y, z from where the points were seen, metres, which estimated normals face; or null.
  const float *viewpoint;
} hangpose_cloud;

// How large the inputs may be that memory is set aside for. What stays below needs no more.
typedef struct hangpose_limits {
  // sizeof(hangpose_limits), set by the caller.
  uint32_t struct_size;
  // Vertices of the object's mesh.
  uint32_t vertices;
  // Triangles of the object's mesh.
  uint32_t triangles;
  // hangpose_params.samples.
  uint32_t samples;
  // hangpose_params.voxels.
  uint32_t voxels;
  // Points of the supporter's cloud.
  uint32_t points;
  // Poses asked of hangpose_predict.
  uint32_t poses;
} hangpose_limits;

// Lets another thread see how far a call is and stop it, and bounds the work that each call may do. Must not be moved
// or overwritten while a call runs with it. Its words are atomic: any thread, and a signal handler, may read the
// progress and cancel at any time.
typedef struct hangpose_monitor {
  // sizeof(hangpose_monitor), set by hangpose_monitor_init.
  uint32_t struct_size;
  // The library's.
  uint32_t magic;
  // The library's.
  uint64_t words[4];
} hangpose_monitor;

// What the analysis of an object found.
typedef struct hangpose_object_info {
  // sizeof(hangpose_object_info), set by the caller.
  uint32_t struct_size;
  // HANGPOSE_WORK_LIMIT where the search for sites or contacts ended early, HANGPOSE_OK where it did not.
  hangpose_status stopped;
  // 1 where the mesh is closed, so that it has a volume, else 0.
  uint32_t is_closed;
  // 1 where the mesh is closed but its triangles face inwards, which is allowed for, else 0.
  uint32_t is_inside_out;
  // Surface area, square metres.
  float area;
  // Volume, cubic metres; NaN where the mesh is not closed.
  float volume;
  // x, y, z of the centre of mass that poses are made for, metres, in object coordinates.
  float centre_of_mass[3];
  // Samples whose normal leans towards the centre of mass, eq. (3).
  uint32_t contact_points;
  // Clusters of them, eq. (4).
  uint32_t clusters;
  // Clusters with a free space outside the object.
  uint32_t with_free_space;
  // Free spaces that the object encircles, eq. (6).
  uint32_t encircled;
  // Different ones among them, eq. (7): the object's hanging sites; 0 with HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t sites;
  // Places where the object can lie on something; 0 with HANGPOSE_CANDIDATES_SITES.
  uint32_t contacts;
  // Rays cast.
  uint64_t rays;
  // Distance and inside-outside queries made.
  uint64_t distance_queries;
} hangpose_object_info;

// A place on an object into which a supporter can reach.
typedef struct hangpose_object_site {
  // sizeof(hangpose_object_site), set by the caller.
  uint32_t struct_size;
  // |P_h|: samples in the cluster of contact points.
  uint32_t contact_points;
  // c_h: x, y, z of the centre of the free space, metres, in object coordinates.
  float position[3];
  // v_h: unit vector along which the supporter passes through, in object coordinates; its sign means nothing.
  float hanging_direction[3];
  // p_h: x, y, z of the contact point that the free space was found from, metres, in object coordinates.
  float contact_point[3];
  // r_h: radius of the free space, metres.
  float free_space_radius;
  // m: share of the rays around the hanging direction that hit the object, eq. (5).
  float encircled;
  // m_1: the same among the rays above the hanging position.
  float encircled_above;
  // m_2: the same among the rays below it.
  float encircled_below;
} hangpose_object_site;

// A place where an object can lie on something.
typedef struct hangpose_object_contact {
  // sizeof(hangpose_object_contact), set by the caller.
  uint32_t struct_size;
  // x, y, z of a point on the surface, metres, in object coordinates.
  float position[3];
  // Unit vector out of the solid, in object coordinates.
  float normal[3];
  // Unit vector along the thin bar that the object catches best under the point, in object coordinates; its sign means
  // nothing.
  float bar_direction[3];
  // How far such a bar must come down before it gets out sideways, metres; 0 if it is not caught.
  float capture;
  // How far it is to the surface opposite, metres; infinite where there is none.
  float room;
  // How far such a bar gets along its direction, on the side where it gets farther, metres; infinite where nothing stops it,
  // as in a hole.
  float passage;
} hangpose_object_contact;

// What the analysis of a supporter found.
typedef struct hangpose_supporter_info {
  // sizeof(hangpose_supporter_info), set by the caller.
  uint32_t struct_size;
  // HANGPOSE_WORK_LIMIT where the search for sites or contacts ended early, HANGPOSE_OK where it did not.
  hangpose_status stopped;
  // Points of the cloud.
  uint32_t points;
  // Normals that were missing or zero, and were estimated from the neighbouring points.
  uint32_t normals_estimated;
  // Normals that were not of unit length, and were scaled to it.
  uint32_t normals_renormalised;
  // Points that face up, eq. (2).
  uint32_t contact_points;
  // Clusters of them.
  uint32_t clusters;
  // Clusters at which a slice through the supporter holds together: the support sites; 0 with
  // HANGPOSE_CANDIDATES_CONTACTS.
  uint32_t sites;
  // Places where something can lie on the supporter; 0 with HANGPOSE_CANDIDATES_SITES.
  uint32_t contacts;
  // Rays cast.
  uint64_t rays;
  // Distance and inside-outside queries made.
  uint64_t distance_queries;
} hangpose_supporter_info;

// A place on a supporter that something can hang on.
typedef struct hangpose_supporter_site {
  // sizeof(hangpose_supporter_site), set by the caller.
  uint32_t struct_size;
  // c_s: x, y, z of the centre of the cross-section, metres, in supporter coordinates.
  float position[3];
  // v_s: unit vector along which the cross-section is smallest, horizontal, in supporter coordinates; its sign means
  // nothing.
  float hanging_direction[3];
  // p_s: x, y, z of the contact point that the supporter was sliced at, metres, in supporter coordinates.
  float contact_point[3];
  // r_s: radius of the sphere around the cross-section, metres.
  float support_radius;
  // d_1, d_2: distances from the position to the convex hull of the supporter along the hanging direction and against
  // it, metres.
  float boundary_distances[2];
} hangpose_supporter_site;

// A place where something can lie on a supporter.
typedef struct hangpose_supporter_contact {
  // sizeof(hangpose_supporter_contact), set by the caller.
  uint32_t struct_size;
  // x, y, z of a point of the supporter, metres, in supporter coordinates.
  float position[3];
  // Unit vector out of the solid, in supporter coordinates.
  float normal[3];
  // Unit vector along which the supporter stretches around the point, in supporter coordinates; its sign means
  // nothing.
  float bar_direction[3];
} hangpose_supporter_contact;

// By how much an object stays up. A part of hangpose_pose.
typedef struct hangpose_margin {
  // How far gravity may tilt, radians, with 70 % of the friction, towards each of eight horizontal directions: the first is the
  // supporter's x axis (or its y axis, where gravity is along x, made perpendicular to gravity), the others follow
  // counter-clockwise seen from above.
  float tilts[HANGPOSE_DIRECTIONS];
  // The least of the tilts, radians.
  float least_tilt;
  // How long it stays, seconds, when gravity tilts by 21.8 degrees at once, towards where it survives the least tilt, and
  // nothing but friction stops its swing; 1 if it is still there then, 0 if that was not tried, because some tilt is hopeless.
  float jolt_time;
  // How far the centre of mass sank at most, metres, while gravity tilted by up to 0.9 radians: what comes to lie deeper when it is
  // shaken does not lie firmly where it is.
  float tilted_sinking;
  // The least rise of the centre of mass, metres, over the ways of escape that were found, and the highest rise seen
  // where none was found.
  float escape_rise;
  // The same over the distance from the contacts to the centre of mass; no unit.
  float escape_ratio;
  // The speed of a knock that would carry the centre of mass over that rise, m/s.
  float knock_speed;
  // How far the centre of mass may be from where it was taken to be, metres.
  float centre_of_mass_radius;
} hangpose_margin;

// A place where the supporter bears the object, in supporter coordinates. A part of hangpose_pose.
typedef struct hangpose_contact {
  // x, y, z, metres.
  float position[3];
  // Unit vector in which the supporter pushes.
  float normal[3];
  // How hard it pushes along it, in multiples of the object's weight.
  float force;
} hangpose_contact;

// A pose in which the object hangs: where to let it go, what gravity then makes of it, and which sites it joins.
typedef struct hangpose_pose {
  // sizeof(hangpose_pose), set by the library.
  uint32_t struct_size;
  // Where to let the object go: x, y, z of its origin, metres, in supporter coordinates.
  float position[3];
  // x, y, z, w of the unit quaternion that turns object coordinates into supporter coordinates.
  float quaternion[4];
  // 1 with hangpose_params.settle; else 0, and all from here to `contacts` is NaN or 0.
  uint32_t has_rest;
  // The probability that it hangs and stays.
  float probability;
  // Where the object comes to rest: x, y, z of its origin, metres, in supporter coordinates.
  float rest_position[3];
  // x, y, z, w of the unit quaternion that turns object coordinates into supporter coordinates there.
  float rest_quaternion[4];
  // How far the centre of mass sinks from the release to there, metres.
  float sinking;
  // How far the object is off the supporter where it is let go, metres: hangpose_params.clearance, or less where there
  // is no room.
  float clearance;
  // By how much it stays.
  struct hangpose_margin margin;
  // How many of the contacts there are; the others are 0.
  uint32_t contact_count;
  // Where the supporter bears the object at rest.
  struct hangpose_contact contacts[HANGPOSE_MAX_CONTACTS];
  // 1 with HANGPOSE_CANDIDATES_SITES; else 0, and all from here on is HANGPOSE_NO_INDEX, NaN or 0.
  uint32_t is_matched;
  // Index of the hanging site, for hangpose_object_get_site.
  uint32_t object_site;
  // Index of the support site, for hangpose_supporter_get_site.
  uint32_t support_site;
  // 1 where the object's hanging direction is laid against the supporter's, 0 where it is laid along it.
  uint32_t is_reversed;
  // S_c: points of the supporter inside the object, eq. (8).
  uint32_t collision;
  // S_b: how far the hanging position is from the middle of the supporter, from 0.5 to 1, eq. (9).
  float boundary;
  // S_a: how small the contact area is against the object's largest, from 0 to 1, eq. (10).
  float contact_area;
  // S_total: the weighted sum of the three, eq. (11); less is better.
  float total;
} hangpose_pose;

// What hangpose_predict found beside the poses: what was left after each step of the method, and what it took.
typedef struct hangpose_prediction {
  // sizeof(hangpose_prediction), set by the caller.
  uint32_t struct_size;
  // How many poses were written.
  uint32_t pose_count;
  // Why there are none, one of HANGPOSE_STAGE_*; for people: hangpose_stage_string.
  hangpose_stage stage;
  // HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT where this call or the analysis of its models ended early, or
  // HANGPOSE_OK.
  hangpose_status stopped;
  // With HANGPOSE_CANDIDATES_SITES, pairs of an object site and a support site.
  uint32_t matching_pairs;
  // Pairs where the support fits into the free space.
  uint32_t matching_fitting;
  // Poses, two a fitting pair, found with no more collisions than allowed; those that others were sure to outrank are
  // not counted.
  uint32_t matching_clear;
  // With HANGPOSE_CANDIDATES_CONTACTS, poses that lay a contact of the object on one of the supporter.
  uint32_t settling_candidates;
  // Those that are clear of the supporter.
  uint32_t settling_clear;
  // Poses that were let go.
  uint32_t settling_released;
  // Of these, those that rotated off,
  uint32_t settling_rotated_off;
  // slid off or fell through,
  uint32_t settling_slid_off;
  // or still moved after three seconds.
  uint32_t settling_moving;
  // Those that came to rest.
  uint32_t settling_at_rest;
  // Of these, those that would not come off again.
  uint32_t settling_wedged;
  // Different rests that are probable enough to be given.
  uint32_t settling_probable;
  // Releases that came to one of them that needs no better ones beside it.
  uint32_t settling_firm;
  // Rays cast.
  uint64_t rays;
  // Distance and inside-outside queries made.
  uint64_t distance_queries;
} hangpose_prediction;

// Done.
#define HANGPOSE_OK 0

// Nothing hangs; hangpose_prediction.stage says which step left nothing.
#define HANGPOSE_REJECTED 1

// hangpose_monitor_cancel was called. hangpose_predict still gives the best poses until then; an analysis that was
// cancelled gives no model.
#define HANGPOSE_CANCELLED 2

// The monitor's work limit was reached, in this call or when one of its models was made. What was found until then is
// there.
#define HANGPOSE_WORK_LIMIT 3

// A pointer that must lead somewhere is null.
#define HANGPOSE_ERROR_NULL (-1)

// A pointer is not aligned for what it leads to. Memory for models and work may begin anywhere.
#define HANGPOSE_ERROR_MISALIGNED (-2)

// A struct_size is not the size of that struct: it was not set, or the program was compiled with another header.
#define HANGPOSE_ERROR_STRUCT_SIZE (-3)

// The program was compiled with the header of another library.
#define HANGPOSE_ERROR_ABI_VERSION (-4)

// The memory is smaller than its size query says.
#define HANGPOSE_ERROR_MEMORY (-5)

// Memory that the call writes overlaps something else that it was given.
#define HANGPOSE_ERROR_OVERLAP (-6)

// A handle or a monitor was never made, was moved, or was overwritten.
#define HANGPOSE_ERROR_HANDLE (-7)

// A supporter is in use in another thread and cannot be updated, or is being updated and cannot be used.
#define HANGPOSE_ERROR_BUSY (-8)

// A supporter is empty, because its last update was cancelled.
#define HANGPOSE_ERROR_EMPTY (-9)

// There are none, or more than the most that are possible.
#define HANGPOSE_ERROR_COUNT (-10)

// A number is out of its range, infinite or not a number.
#define HANGPOSE_ERROR_VALUE (-11)

// An index names something that does not exist.
#define HANGPOSE_ERROR_INDEX (-12)

// No triangle of the mesh has an area.
#define HANGPOSE_ERROR_DEGENERATE (-13)

// The params ask to let the object go, but it was analysed without voxels.
#define HANGPOSE_ERROR_NO_DISTANCE_FIELD (-14)

// None: there are poses, or the search was stopped.
#define HANGPOSE_STAGE_NONE 0

// Nowhere does the object's surface face its centre of mass, or only in specks.
#define HANGPOSE_STAGE_NO_CONTACT_POINTS 1

// There is no room beside the object's contact points for a supporter.
#define HANGPOSE_STAGE_NO_FREE_SPACE 2

// The free spaces are open to the side, so that a supporter would slip out.
#define HANGPOSE_STAGE_NOT_ENCIRCLED 3

// Nothing on the supporter faces up and holds together.
#define HANGPOSE_STAGE_NO_SUPPORT 4

// The supporter is too thick for every free space of the object.
#define HANGPOSE_STAGE_TOO_THICK 5

// Every pose runs the supporter through the object.
#define HANGPOSE_STAGE_ALL_COLLIDE 6

// Let go, the object turns and falls off, or most often does.
#define HANGPOSE_STAGE_ROTATES_OFF 7

// Let go, the object slides off or falls through, or most often does.
#define HANGPOSE_STAGE_SLIDES_OFF 8

// Let go, the object does not come to rest.
#define HANGPOSE_STAGE_NEVER_RESTS 9

// The object comes to rest, but a nudge would bring it down, it would not come off again, or there is no room to put it
// there.
#define HANGPOSE_STAGE_TOO_LOOSE 10

// The library's own method.
#define HANGPOSE_PROFILE_DEFAULT 0

// The published method with the constants of its Table I.
#define HANGPOSE_PROFILE_PAPER 1

// The mean of the surface samples: h_c of the paper's eq. (3).
#define HANGPOSE_CENTRE_OF_MASS_SAMPLE_MEAN 0

// The centroid of the volume where the mesh is closed, the mean of the samples where it is not.
#define HANGPOSE_CENTRE_OF_MASS_VOLUME 1

// hangpose_params.given_centre_of_mass.
#define HANGPOSE_CENTRE_OF_MASS_GIVEN 2

// Every hanging site on every support site, as the paper matches them: section II-D.
#define HANGPOSE_CANDIDATES_SITES 0

// Every place of the object that can lie on something on every place of the supporter that can carry something.
#define HANGPOSE_CANDIDATES_CONTACTS 1

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The HANGPOSE_ABI_VERSION that the library was built with.
uint32_t hangpose_abi_version(void);

// HANGPOSE_OK if `abi_version`, for which the caller gives HANGPOSE_ABI_VERSION, is the library's, or else
// HANGPOSE_ERROR_ABI_VERSION.
hangpose_status hangpose_check_abi(uint32_t abi_version);

// The library's version, for example "0.1.0".
const char *hangpose_version(void);

// What a status means, in English; never null, lives for ever.
const char *hangpose_status_string(hangpose_status status);

// What a stage means, in English; never null, lives for ever.
const char *hangpose_stage_string(hangpose_stage stage);

// Sets all of `params`. `struct_size` is sizeof(hangpose_params), `abi_version` is HANGPOSE_ABI_VERSION, `profile` one
// of HANGPOSE_PROFILE_*.
hangpose_status hangpose_params_init(struct hangpose_params *params,
                                     size_t struct_size,
                                     hangpose_profile profile,
                                     uint32_t abi_version,
                                     struct hangpose_detail *detail);

// Sets `limits` to what `params`, `mesh` and `cloud` take, and one pose; a mesh or a cloud may be null, and counts as
// none. Only the counts are looked at.
hangpose_status hangpose_limits_of(const struct hangpose_params *params,
                                   const struct hangpose_mesh *mesh,
                                   const struct hangpose_cloud *cloud,
                                   struct hangpose_limits *limits,
                                   struct hangpose_detail *detail);

// Bytes of memory for any object within `limits`, by vertices, triangles, samples and voxels; 0 if `limits` is null
// or its struct_size is wrong. Limits beyond all memory give more than there can be.
size_t hangpose_object_bytes(const struct hangpose_limits *limits);

// Bytes of memory for any supporter within `limits`, by points; 0 if `limits` is null or its struct_size is wrong.
// Limits beyond all memory give more than there can be.
size_t hangpose_supporter_bytes(const struct hangpose_limits *limits);

// Bytes of memory for matching any object and supporter within `limits`, by points and poses; 0 if `limits` is
// null or its struct_size is wrong. Limits beyond all memory give more than there can be.
size_t hangpose_predict_bytes(const struct hangpose_limits *limits);

// Readies a monitor, or a used one for the next call: not cancelled, no progress. `struct_size` is
// sizeof(hangpose_monitor). Under it each call does at most `work_limit` rays and distance queries, and then returns
// the best that it has so far; HANGPOSE_NO_WORK_LIMIT for all that it takes. The limit counts work and not time, so a
// limited call gives the same answer on every machine.
hangpose_status hangpose_monitor_init(struct hangpose_monitor *monitor,
                                      size_t struct_size,
                                      uint64_t work_limit,
                                      struct hangpose_detail *detail);

// Asks the call that runs under this monitor to stop soon; calls that start later stop at once. Does nothing to a
// monitor that is null or was never readied.
void hangpose_monitor_cancel(struct hangpose_monitor *monitor);

// Whether hangpose_monitor_cancel was called: 1 or 0, and 0 of a monitor that is null or was never readied.
uint32_t hangpose_monitor_is_cancelled(const struct hangpose_monitor *monitor);

// How far the call is that runs under this monitor, from 0 to 1; 0 of a monitor that is null or was never readied.
float hangpose_monitor_progress(const struct hangpose_monitor *monitor);

// Analyses `mesh` in `memory`, which takes hangpose_object_bytes for its size and that of `params`, and sets `object` to
// what it made there, or to null. `monitor` may be null.
//
// HANGPOSE_OK, or HANGPOSE_WORK_LIMIT with an object that may have more sites or contacts than were found;
// HANGPOSE_CANCELLED without one.
hangpose_status hangpose_object_create(void *memory,
                                       size_t memory_size,
                                       const struct hangpose_mesh *mesh,
                                       const struct hangpose_params *params,
                                       struct hangpose_monitor *monitor,
                                       struct hangpose_object **object,
                                       struct hangpose_detail *detail);

// Writes what the analysis found to `info`.
hangpose_status hangpose_object_get_info(const struct hangpose_object *object,
                                         struct hangpose_object_info *info,
                                         struct hangpose_detail *detail);

// Writes hanging site `index`, below hangpose_object_info.sites, to `site`; the best encircled is 0.
hangpose_status hangpose_object_get_site(const struct hangpose_object *object,
                                         uint32_t index,
                                         struct hangpose_object_site *site,
                                         struct hangpose_detail *detail);

// Writes contact `index`, below hangpose_object_info.contacts, to `contact`; the one that catches best is 0.
hangpose_status hangpose_object_get_contact(const struct hangpose_object *object,
                                            uint32_t index,
                                            struct hangpose_object_contact *contact,
                                            struct hangpose_detail *detail);

// Analyses `cloud` in `memory`, which takes hangpose_supporter_bytes for its size, and sets `supporter` to what it made
// there, or to null. Memory for more points makes room for later updates. `monitor` may be null.
//
// HANGPOSE_OK, or HANGPOSE_WORK_LIMIT with a supporter that may have more sites or contacts than were found;
// HANGPOSE_CANCELLED without one.
hangpose_status hangpose_supporter_create(void *memory,
                                          size_t memory_size,
                                          const struct hangpose_cloud *cloud,
                                          const struct hangpose_params *params,
                                          struct hangpose_monitor *monitor,
                                          struct hangpose_supporter **supporter,
                                          struct hangpose_detail *detail);

// Analyses a new cloud in place of the supporter's old one. No other thread may use the supporter meanwhile; where one
// does, the answer is HANGPOSE_ERROR_BUSY. After an error the supporter is what it was; after HANGPOSE_CANCELLED it is
// empty, until an update goes through. `monitor` may be null.
hangpose_status hangpose_supporter_update(struct hangpose_supporter *supporter,
                                          const struct hangpose_cloud *cloud,
                                          const struct hangpose_params *params,
                                          struct hangpose_monitor *monitor,
                                          struct hangpose_detail *detail);

// Writes what the analysis found to `info`.
hangpose_status hangpose_supporter_get_info(const struct hangpose_supporter *supporter,
                                            struct hangpose_supporter_info *info,
                                            struct hangpose_detail *detail);

// Writes support site `index`, below hangpose_supporter_info.sites, to `site`; the thinnest is 0.
hangpose_status hangpose_supporter_get_site(const struct hangpose_supporter *supporter,
                                            uint32_t index,
                                            struct hangpose_supporter_site *site,
                                            struct hangpose_detail *detail);

// Writes contact `index`, below hangpose_supporter_info.contacts, to `contact`.
hangpose_status hangpose_supporter_get_contact(const struct hangpose_supporter *supporter,
                                               uint32_t index,
                                               struct hangpose_supporter_contact *contact,
                                               struct hangpose_detail *detail);

// Finds poses in which an object hangs on a supporter and writes the best to `poses`, best first, at most `pose_capacity`,
// which is at least 1; more room may take more time. Both must have been analysed with the same `params`. `pose_size`
// is sizeof(hangpose_pose). `memory` takes hangpose_predict_bytes and is needed during the call only. `monitor` may be
// null.
//
// HANGPOSE_OK with at least one pose; HANGPOSE_REJECTED, and `prediction->stage` says why; HANGPOSE_CANCELLED or
// HANGPOSE_WORK_LIMIT with the best poses until then, or none.
hangpose_status hangpose_predict(const struct hangpose_object *object,
                                 const struct hangpose_supporter *supporter,
                                 const struct hangpose_params *params,
                                 void *memory,
                                 size_t memory_size,
                                 struct hangpose_monitor *monitor,
                                 struct hangpose_pose *poses,
                                 size_t pose_size,
                                 uint32_t pose_capacity,
                                 struct hangpose_prediction *prediction,
                                 struct hangpose_detail *detail);

// Bytes of memory for drawing `count` samples.
size_t hangpose_sample_bytes(uint32_t count);

// Draws `count` points, evenly spread, and their normals from a mesh, for a supporter that is known as a mesh.
// `points` and `normals` hold `count` rows of x, y, z; metres, in the mesh's coordinates. `memory` takes
// hangpose_sample_bytes and is needed during the call only. The same seed gives the same samples.
hangpose_status hangpose_mesh_sample(const struct hangpose_mesh *mesh,
                                     uint64_t seed,
                                     void *memory,
                                     size_t memory_size,
                                     float *points,
                                     float *normals,
                                     uint32_t count,
                                     struct hangpose_detail *detail);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HANGPOSE_H */
