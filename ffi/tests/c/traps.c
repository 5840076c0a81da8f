// A program that runs with floating-point traps and masks them around each call: nothing traps, the results have the same bits, and
// the traps are back afterwards. With an argument it does not mask them, and is stopped by a trap.
#define _GNU_SOURCE
#include <fenv.h>
#include <hangpose.h>
#include <stdio.h>
#include <string.h>

#include "shapes.h"  // make_ring, make_peg

enum { SAMPLES = 2000, VOXELS = 50000, POSES = 4, TRAPS = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW };

static float vertices[RING_VERTICES][3], points[PEG_POINTS][3], normals[PEG_POINTS][3];
static uint32_t triangles[RING_TRIANGLES][3];
static unsigned char object_memory[HANGPOSE_OBJECT_BYTES(RING_VERTICES, RING_TRIANGLES, SAMPLES, VOXELS)];
static unsigned char supporter_memory[HANGPOSE_SUPPORTER_BYTES(PEG_POINTS)];
static unsigned char work_memory[HANGPOSE_PREDICT_BYTES(PEG_POINTS, POSES)];

// The poses of the ring on the peg; 0 if it hangs.
static int predict(hangpose_pose *poses) {
  hangpose_params params;
  if (hangpose_params_init(&params, sizeof params, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION, NULL)) return 1;
  params.samples = SAMPLES;
  params.voxels = VOXELS;
  const hangpose_mesh mesh = {.struct_size = sizeof mesh,
                              .vertices = *vertices,
                              .vertex_count = RING_VERTICES,
                              .triangles = *triangles,
                              .triangle_count = RING_TRIANGLES};
  hangpose_object *ring = NULL;
  if (hangpose_object_create(object_memory, sizeof object_memory, &mesh, &params, NULL, &ring, NULL)) return 2;
  const hangpose_cloud cloud = {
      .struct_size = sizeof cloud, .points = *points, .normals = *normals, .point_count = PEG_POINTS};
  hangpose_supporter *peg = NULL;
  if (hangpose_supporter_create(supporter_memory, sizeof supporter_memory, &cloud, &params, NULL, &peg, NULL)) return 3;
  hangpose_prediction found = {.struct_size = sizeof found};
  return hangpose_predict(ring, peg, NULL, &params, work_memory, sizeof work_memory, NULL, poses, sizeof *poses, POSES,
                          &found, NULL);
}

int main(int count, char **arguments) {
  (void)arguments;
  static hangpose_pose without[POSES], with[POSES];
  make_ring(0.03f, vertices, triangles);
  make_peg(0.004f, points, normals);
  if (predict(without)) return 1;
  feclearexcept(FE_ALL_EXCEPT);
  if (feenableexcept(TRAPS) == -1) return 2;
  fenv_t caller;
  if (count == 1) feholdexcept(&caller);
  if (predict(with)) return 3;
  if (count == 1) fesetenv(&caller);
  if (fegetexcept() != TRAPS || fetestexcept(TRAPS)) return 4;
  if (memcmp(without, with, sizeof with)) return 5;
  puts("the same poses with traps, masked around the calls");
  return 0;
}
