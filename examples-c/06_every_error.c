// Provokes every status: prints what the caller did, and the diagnosis of the library.
#include <hangpose.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "shapes.h"

enum { SAMPLES = 4000, VOXELS = 100000, POSES = 3, NODES = 64, WAYPOINTS = 100 };
static float vertices[RING_VERTICES][3], points[PEG_POINTS][3], normals[PEG_POINTS][3];
static uint32_t triangles[RING_TRIANGLES][3];
static unsigned char object_memory[HANGPOSE_OBJECT_BYTES(RING_VERTICES, RING_TRIANGLES, SAMPLES, VOXELS)];
static unsigned char supporter_memory[HANGPOSE_SUPPORTER_BYTES(PEG_POINTS)];
static unsigned char other_memory[sizeof supporter_memory];
static unsigned char work[HANGPOSE_PREDICT_BYTES(PEG_POINTS, POSES)], other_work[sizeof work];
static hangpose_params params, changed;
static hangpose_mesh mesh = {.struct_size = sizeof mesh,
                             .vertices = *vertices,
                             .vertex_count = RING_VERTICES,
                             .triangles = *triangles,
                             .triangle_count = RING_TRIANGLES};
static hangpose_cloud cloud = {
    .struct_size = sizeof cloud, .points = *points, .normals = *normals, .point_count = PEG_POINTS};
static hangpose_object *ring;
static hangpose_supporter *peg, *other;
static hangpose_detail detail = {.struct_size = sizeof detail};
static int surprises;

static void expect(hangpose_status wanted, hangpose_status status, const char *what) {
  printf("%s\n    %d, %s", what, (int)status, hangpose_status_string(status));
  if (status < 0) {
    printf(" | %s", detail.field);
    if (detail.index != HANGPOSE_NO_INDEX) printf("[%u]", (unsigned)detail.index);
    printf(" | %s", detail.message);
  }
  printf("%s\n", status == wanted ? "" : "    <- UNEXPECTED");
  surprises += status != wanted;
}

static hangpose_status init(hangpose_params *p, uint32_t profile, uint32_t version) {
  return hangpose_params_init(p, sizeof *p, profile, version, &detail);
}
static hangpose_status make_object(size_t size, const hangpose_mesh *m, const hangpose_params *p,
                                   hangpose_monitor *watch) {
  hangpose_object *made;
  return hangpose_object_create(object_memory, size, m, p, watch, &made, &detail);
}
static hangpose_status make_other(const hangpose_cloud *c) {
  return hangpose_supporter_create(other_memory, sizeof other_memory, c, &params, NULL, &other, &detail);
}
static hangpose_status predict(const hangpose_supporter *on, unsigned char *memory, uint32_t capacity,
                               hangpose_monitor *watch) {
  static hangpose_pose poses[2][POSES];  // one row for each thread
  hangpose_pose *mine = poses[memory == other_work];
  hangpose_prediction found = {.struct_size = sizeof found};
  hangpose_detail *said = memory == other_work ? NULL : &detail;
  return hangpose_predict(ring, on, NULL, &params, memory, sizeof work, watch, mine, sizeof *mine, capacity,
                          &found, said);
}

// Predicts in a loop, so that the supporter is in use.
static volatile hangpose_status last;
static void *keep_busy(void *is_over) {
  while (!hangpose_monitor_is_cancelled(is_over)) last = predict(peg, other_work, POSES, NULL);
  return NULL;
}

int main(void) {
  hangpose_monitor monitor;
  hangpose_object_contact contact = {.struct_size = sizeof contact};
  make_ring(0.03f, vertices, triangles);
  make_peg(0.004f, points, normals);

  expect(HANGPOSE_ERROR_ABI_VERSION, init(&params, HANGPOSE_PROFILE_DEFAULT, 999),
         "a header of another version");
  expect(HANGPOSE_ERROR_NULL, init(NULL, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION), "params are null");
  expect(HANGPOSE_ERROR_VALUE, init(&params, 77, HANGPOSE_ABI_VERSION), "a profile that does not exist");
  expect(HANGPOSE_OK, init(&params, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION), "valid params");
  params.samples = SAMPLES;
  params.voxels = VOXELS;

  changed = params;
  changed.radius_ratio = NAN;
  expect(HANGPOSE_ERROR_VALUE, make_object(sizeof object_memory, &mesh, &changed, NULL), "a constant is NaN");
  changed.struct_size = 0;
  expect(HANGPOSE_ERROR_STRUCT_SIZE, make_object(sizeof object_memory, &mesh, &changed, NULL),
         "params were never initialised");
  expect(HANGPOSE_ERROR_MEMORY, make_object(1000, &mesh, &params, NULL), "too little memory");
  hangpose_mesh broken = mesh;
  broken.vertices = (const float *)((const char *)*vertices + 1);
  expect(HANGPOSE_ERROR_MISALIGNED, make_object(sizeof object_memory, &broken, &params, NULL),
         "a float array at an odd address");
  broken.vertices = (const float *)(void *)object_memory;
  expect(HANGPOSE_ERROR_OVERLAP, make_object(sizeof object_memory, &broken, &params, NULL),
         "a mesh that overlaps the memory");
  broken = mesh;
  broken.triangle_count = 0;
  expect(HANGPOSE_ERROR_COUNT, make_object(sizeof object_memory, &broken, &params, NULL),
         "a mesh without triangles");
  triangles[7][1] = RING_VERTICES;
  expect(HANGPOSE_ERROR_INDEX, make_object(sizeof object_memory, &mesh, &params, NULL),
         "a triangle with a vertex index out of range");
  triangles[7][1] = 0;
  vertices[5][2] = NAN;
  expect(HANGPOSE_ERROR_VALUE, make_object(sizeof object_memory, &mesh, &params, NULL),
         "a coordinate is NaN");
  static const uint32_t line[3] = {0, 1, 1};
  broken.triangle_count = 1;
  broken.triangles = line;
  make_ring(0.03f, vertices, triangles);
  expect(HANGPOSE_ERROR_DEGENERATE, make_object(sizeof object_memory, &broken, &params, NULL),
         "all triangles have zero area");
  memset(&monitor, 0, sizeof monitor);
  expect(HANGPOSE_ERROR_HANDLE, make_object(sizeof object_memory, &mesh, &params, &monitor),
         "a monitor that was never initialised");
  hangpose_monitor_init(&monitor, sizeof monitor, HANGPOSE_NO_WORK_LIMIT, &detail);
  hangpose_monitor_cancel(&monitor);
  expect(HANGPOSE_CANCELLED, make_object(sizeof object_memory, &mesh, &params, &monitor),
         "an analysis cancelled before it began");
  expect(HANGPOSE_OK,
         hangpose_object_create(object_memory, sizeof object_memory, &mesh, &params, NULL, &ring, &detail),
         "a valid object");
  expect(HANGPOSE_ERROR_INDEX, hangpose_object_get_contact(ring, 1000, &contact, &detail),
         "a contact index out of range");

  expect(HANGPOSE_OK,
         hangpose_supporter_create(supporter_memory, sizeof supporter_memory, &cloud, &params, NULL, &peg,
                                   &detail),
         "a valid supporter");
  expect(HANGPOSE_ERROR_HANDLE, predict((hangpose_supporter *)(void *)points, work, POSES, NULL),
         "a pointer that is not a supporter");
  expect(HANGPOSE_ERROR_COUNT, predict(peg, work, 0, NULL), "a pose array of length 0");
  hangpose_monitor_init(&monitor, sizeof monitor, 10, &detail);
  expect(HANGPOSE_WORK_LIMIT, predict(peg, work, POSES, &monitor), "a work limit of ten queries");
  for (int i = 0; i < PEG_POINTS; ++i) {
    points[i][0] = normals[i][1] = normals[i][2] = 0.0f;
    normals[i][0] = 1.0f;
  }
  make_other(&cloud);
  expect(HANGPOSE_REJECTED, predict(other, work, POSES, NULL), "a supporter that is a smooth wall");
  hangpose_monitor_cancel(&monitor);
  expect(HANGPOSE_CANCELLED, hangpose_supporter_update(other, &cloud, &params, &monitor, &detail),
         "a cancelled update");
  expect(HANGPOSE_ERROR_EMPTY, predict(other, work, POSES, NULL), "the supporter after the cancelled update");

  make_peg(0.004f, points, normals);
  pthread_t thread;
  hangpose_status status = HANGPOSE_OK;
  hangpose_monitor_init(&monitor, sizeof monitor, HANGPOSE_NO_WORK_LIMIT, &detail);
  pthread_create(&thread, NULL, keep_busy, &monitor);
  for (int tries = 0; tries < 10000 && status == HANGPOSE_OK; ++tries)
    status = hangpose_supporter_update(peg, &cloud, &params, NULL, &detail);
  expect(HANGPOSE_ERROR_BUSY, status, "an update while another thread predicts");
  hangpose_monitor_cancel(&monitor);
  pthread_join(thread, NULL);
  expect(HANGPOSE_OK, predict(peg, work, POSES, NULL), "a valid prediction");

  static unsigned char plan_memory[HANGPOSE_PLAN_BYTES(PEG_POINTS, 0, NODES, WAYPOINTS)];
  static hangpose_waypoint waypoints[WAYPOINTS];
  hangpose_pose goal = {.struct_size = sizeof goal,
                        .has_pose = 1,
                        .position = {0, 0.04f, -0.03f},
                        .quaternion = {0, 0.7071f, 0, 0.7071f}};
  hangpose_plan plan = {.struct_size = sizeof plan};
  hangpose_motion motion;
  hangpose_motion_init(&motion, sizeof motion, &detail);
  motion.nodes = NODES;
  expect(HANGPOSE_NO_PATH,
         hangpose_plan_path(ring, peg, NULL, &params, &motion, &goal, plan_memory, sizeof plan_memory, NULL,
                            waypoints, sizeof *waypoints, WAYPOINTS, &plan, &detail),
         "a path to a pose in which the ring is in the peg");
  printf("    %s\n", hangpose_plan_reason_string(plan.failure.reason));

  init(&changed, HANGPOSE_PROFILE_PAPER, HANGPOSE_ABI_VERSION);
  changed.samples = SAMPLES;
  hangpose_object_create(object_memory, sizeof object_memory, &mesh, &changed, NULL, &ring, &detail);
  expect(HANGPOSE_ERROR_NO_DISTANCE_FIELD, predict(peg, work, POSES, NULL),
         "an object that was analysed without voxels");

  static unsigned char volume_memory[HANGPOSE_VOLUME_BYTES(1)];
  static const uint16_t dark[4], wall[4] = {500, 500, 500, 500};
  hangpose_depth_image image = {.struct_size = sizeof image,
                                .depth_count = 4,
                                .scale = 0.001f,
                                .camera = {2, 2, {2, 2}, {0.5f, 0.5f}, {0}},
                                .quaternion = {0, 0, 0, 1},
                                .depths = dark};
  hangpose_volume_settings settings;
  hangpose_volume *volume;
  uint32_t pixels;
  hangpose_volume_settings_init(&settings, sizeof settings, 0.01f, &detail);
  hangpose_volume_create(volume_memory, sizeof volume_memory, &settings, 1, &volume, &detail);
  expect(HANGPOSE_ERROR_BLANK, hangpose_volume_integrate(volume, &image, NULL, &pixels, &detail),
         "a depth image of a covered camera");
  image.depths = wall;
  expect(HANGPOSE_ERROR_CAPACITY, hangpose_volume_integrate(volume, &image, NULL, &pixels, &detail),
         "a depth image that needs more blocks than the volume has");
  expect(HANGPOSE_ERROR_SPARSE, hangpose_volume_complete(volume, work, sizeof work, NULL, &detail),
         "the completion of a sparse volume");
  printf("%d unexpected results\n", surprises);
  return surprises;
}
