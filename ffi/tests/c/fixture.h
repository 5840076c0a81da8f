// The test fixture: a ring on a peg in memory between guards, and counters of checks and failures.
#ifndef FIXTURE_H
#define FIXTURE_H

#include <hangpose.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"

// Small, because the tests run under valgrind; POINTS covers 17 mm of the peg.
enum { SAMPLES = 300, VOXELS = 5000, POINTS = 500, POSES = 4, GUARD = 64, MARK = 0xA5 };

static float vertices[RING_VERTICES][3], points[PEG_POINTS][3], normals[PEG_POINTS][3];
static uint32_t triangles[RING_TRIANGLES][3];
static hangpose_params params;
static hangpose_mesh mesh;
static hangpose_cloud cloud;
static hangpose_limits limits;
static hangpose_detail detail = {.struct_size = sizeof detail};
static size_t object_size, supporter_size, predict_size;
static unsigned char *object_memory, *supporter_memory, *work;
static hangpose_object *object;
static hangpose_supporter *supporter;
static hangpose_pose right[POSES];
static uint32_t right_count;
static int checks, failures;

static void check(int is_right, const char *what, int line) {
  ++checks;
  if (is_right) return;
  ++failures;
  printf("line %d: %s (%d: %s)\n", line, what, (int)detail.status, detail.message);
}
#define CHECK(is_right) check((is_right), #is_right, __LINE__)
#define REFUSED(status) check((status) < 0, #status, __LINE__)

// `size` bytes between guards, `offset` bytes away from an aligned address.
static unsigned char *guarded(size_t size, size_t offset) {
  unsigned char *all = malloc(size + offset + 2 * GUARD);
  if (all == NULL) abort();
  memset(all, MARK, size + offset + 2 * GUARD);
  return all + GUARD + offset;
}
static void release(unsigned char *memory, size_t size, size_t offset) {
  for (size_t i = 0; i < GUARD + offset; ++i) CHECK(memory[-1 - (ptrdiff_t)i] == MARK);
  for (size_t i = 0; i < GUARD; ++i) CHECK(memory[size + i] == MARK);
  free(memory - GUARD - offset);
}

static hangpose_status make_object(void *memory, size_t size, const hangpose_mesh *m,
                                   const hangpose_params *p, hangpose_monitor *watch) {
  hangpose_object *made = (void *)&detail;  // the call sets it to null if it makes nothing
  hangpose_status status = hangpose_object_create(memory, size, m, p, watch, &made, &detail);
  CHECK(status == HANGPOSE_ERROR_OVERLAP ||
        (made != NULL) == (status == HANGPOSE_OK || status == HANGPOSE_WORK_LIMIT));
  return status;
}
static hangpose_status make_supporter(void *memory, size_t size, const hangpose_cloud *c,
                                      const hangpose_params *p) {
  hangpose_supporter *made = (void *)&detail;
  hangpose_status status = hangpose_supporter_create(memory, size, c, p, NULL, &made, &detail);
  CHECK(status == HANGPOSE_ERROR_OVERLAP ||
        (made != NULL) == (status == HANGPOSE_OK || status == HANGPOSE_WORK_LIMIT));
  return status;
}
static hangpose_status predict(const hangpose_object *o, const hangpose_supporter *s,
                               const hangpose_params *p) {
  hangpose_pose poses[POSES];
  hangpose_prediction found = {.struct_size = sizeof found};
  return hangpose_predict(o, s, NULL, p, work, predict_size, NULL, poses, sizeof *poses, POSES, &found,
                          &detail);
}
// Whether the models still give the same poses as in set_up.
static int is_unharmed(void) {
  hangpose_pose poses[POSES];
  hangpose_prediction found = {.struct_size = sizeof found};
  hangpose_status status = hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, poses,
                                            sizeof *poses, POSES, &found, &detail);
  return status == HANGPOSE_OK && found.pose_count == right_count &&
         memcmp(poses, right, right_count * sizeof *poses) == 0;
}

static void set_up(void) {
  CHECK(hangpose_params_init(&params, sizeof params, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION,
                             &detail) == HANGPOSE_OK);
  params.samples = SAMPLES;
  params.voxels = VOXELS;
  params.settle_attempts = 8;
  make_ring(0.03f, vertices, triangles);
  make_peg(0.004f, points, normals);
  mesh = (hangpose_mesh){.struct_size = sizeof mesh,
                         .vertices = *vertices,
                         .vertex_count = RING_VERTICES,
                         .triangles = *triangles,
                         .triangle_count = RING_TRIANGLES};
  cloud = (hangpose_cloud){
      .struct_size = sizeof cloud, .points = *points, .normals = *normals, .point_count = POINTS};
  limits.struct_size = sizeof limits;
  CHECK(hangpose_limits_of(&params, &mesh, &cloud, &limits, &detail) == HANGPOSE_OK);
  limits.poses = POSES;
  object_size = hangpose_object_bytes(&limits);
  supporter_size = hangpose_supporter_bytes(&limits);
  predict_size = hangpose_predict_bytes(&limits);
  object_memory = guarded(object_size, 0);
  supporter_memory = guarded(supporter_size, 0);
  work = guarded(predict_size, 0);
  CHECK(hangpose_object_create(object_memory, object_size, &mesh, &params, NULL, &object, &detail) ==
        HANGPOSE_OK);
  CHECK(hangpose_supporter_create(supporter_memory, supporter_size, &cloud, &params, NULL, &supporter,
                                  &detail) == HANGPOSE_OK);
  hangpose_prediction found = {.struct_size = sizeof found};
  CHECK(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, right, sizeof *right,
                         POSES, &found, &detail) == HANGPOSE_OK);
  right_count = found.pose_count;
  CHECK(is_unharmed());
}

static void tear_down(void) {
  release(work, predict_size, 0);
  release(supporter_memory, supporter_size, 0);
  release(object_memory, object_size, 0);
}

#endif
