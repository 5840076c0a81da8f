// Predicts in C with static memory only: no heap, no files.
#include <hangpose.h>
#include <stdio.h>

#include "shapes.h"  // make_ring, make_peg

enum { SAMPLES = 4000, VOXELS = 100000, POSES = 10 };

static float vertices[RING_VERTICES][3], points[PEG_POINTS][3], normals[PEG_POINTS][3];
static uint32_t triangles[RING_TRIANGLES][3];
static unsigned char object_memory[HANGPOSE_OBJECT_BYTES(RING_VERTICES, RING_TRIANGLES, SAMPLES, VOXELS)];
static unsigned char supporter_memory[HANGPOSE_SUPPORTER_BYTES(PEG_POINTS)];
static unsigned char work_memory[HANGPOSE_PREDICT_BYTES(PEG_POINTS, POSES)];
static hangpose_pose poses[POSES];
static hangpose_detail detail = {.struct_size = sizeof detail};

static int fail(void) {
  fprintf(stderr, "%s: %s: %s\n", hangpose_status_string(detail.status), detail.field, detail.message);
  return 1;
}

int main(void) {
  hangpose_params params;
  if (hangpose_params_init(&params, sizeof params, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION, &detail))
    return fail();
  params.samples = SAMPLES;
  params.voxels = VOXELS;

  make_ring(0.03f, vertices, triangles);
  const hangpose_mesh mesh = {.struct_size = sizeof mesh,
                              .vertices = *vertices,
                              .vertex_count = RING_VERTICES,
                              .triangles = *triangles,
                              .triangle_count = RING_TRIANGLES};
  hangpose_object *ring = NULL;
  if (hangpose_object_create(object_memory, sizeof object_memory, &mesh, &params, NULL, &ring, &detail))
    return fail();

  make_peg(0.004f, points, normals);
  const hangpose_cloud cloud = {
      .struct_size = sizeof cloud, .points = *points, .normals = *normals, .point_count = PEG_POINTS};
  hangpose_supporter *peg = NULL;
  if (hangpose_supporter_create(supporter_memory, sizeof supporter_memory, &cloud, &params, NULL, &peg,
                                &detail))
    return fail();

  hangpose_prediction found = {.struct_size = sizeof found};
  const hangpose_status status = hangpose_predict(ring, peg, NULL, &params, work_memory, sizeof work_memory,
                                                  NULL, poses, sizeof *poses, POSES, &found, &detail);
  if (status < 0) return fail();
  if (status == HANGPOSE_REJECTED) {
    printf("nothing hangs: %s\n", hangpose_stage_string(found.stage));
    return 3;
  }
  const hangpose_pose *best = &poses[0];
  const float *p = best->position, *q = best->quaternion;
  printf("%u poses; release at (%.4f, %.4f, %.4f) m, quaternion (%.4f, %.4f, %.4f, %.4f) xyzw\n",
         (unsigned)found.pose_count, p[0], p[1], p[2], q[0], q[1], q[2], q[3]);
  printf("the ring sinks %.1f mm and hangs with probability %.3f, up to a tilt of %.2f rad\n",
         1000 * best->sinking, best->probability, best->margin.least_tilt);
  return 0;
}
