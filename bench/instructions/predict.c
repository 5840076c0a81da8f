// Predicts once with each profile from the file that it is given, or input.bin, and marks each stage, so that its
// instructions can be counted: under Linux by count.c, on a Cortex-M by a timer of the board, which qemu advances by the
// instruction. All memory is static.
#include <hangpose.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "mark.h"

// 15 MiB: what the largest RAM of the board leaves.
#define MEMORY (15u << 20)
#ifdef __arm__
__attribute__((section(".large")))
#endif
static _Alignas(16) unsigned char memory[MEMORY];
static size_t used;

#ifdef __arm__
// Timer 0 of the board at 25 MHz: control, value, reload. With -icount shift=0 an instruction takes 1 ns.
#define TIMER ((volatile uint32_t *)0x40000000)
static void mark(unsigned stage) {
  static int is_running;
  if (!is_running) {
    TIMER[2] = TIMER[1] = UINT32_MAX;
    TIMER[0] = 1;
    is_running = 1;
  }
  printf("mark %u %llu\n", stage, 40ull * (UINT32_MAX - TIMER[1]));
}
#else
#include <sys/prctl.h>
static void mark(unsigned stage) { prctl(MARK, stage, 0, 0, 0); }
#endif

static void fail(const char *what) {
  fprintf(stderr, "predict: %s\n", what);
  exit(1);
}

static void *take(size_t size) {
  void *taken = memory + used;
  used += (size + 15) / 16 * 16;
  if (used > MEMORY) {
    fprintf(stderr, "predict: %lu bytes are needed of %u\n", (unsigned long)used, MEMORY);
    exit(1);
  }
  return taken;
}

static void *read_array(FILE *file, size_t size) {
  void *array = take(size);
  if (fread(array, 1, size, file) != size) fail("the input is too short");
  return array;
}

int main(int argc, char **argv) {
  FILE *file = fopen(argc > 1 ? argv[1] : "input.bin", "rb");
  if (!file) fail("there is no input");
  // Vertices, triangles, points.
  const uint32_t *counts = read_array(file, 12);
  const float *vertices = read_array(file, 12ul * counts[0]);
  const uint32_t *triangles = read_array(file, 12ul * counts[1]);
  const float *points = read_array(file, 12ul * counts[2]), *normals = read_array(file, 12ul * counts[2]);
  const hangpose_mesh mesh = {.struct_size = sizeof mesh,
                              .vertex_count = counts[0],
                              .triangle_count = counts[1],
                              .vertices = vertices,
                              .triangles = triangles};
  const hangpose_cloud cloud = {
      .struct_size = sizeof cloud, .point_count = counts[2], .points = points, .normals = normals};
  fclose(file);
  const size_t before = used;
  for (unsigned profile = 0; profile < 2; ++profile) {
    hangpose_params params;
    hangpose_limits limits = {.struct_size = sizeof limits};
    hangpose_detail detail = {.struct_size = sizeof detail};
    hangpose_object *object;
    hangpose_supporter *supporter;
    hangpose_pose poses[10];
    hangpose_prediction found = {.struct_size = sizeof found};
    if (hangpose_params_init(&params, sizeof params, profile ? HANGPOSE_PROFILE_DEFAULT : HANGPOSE_PROFILE_PAPER,
                             HANGPOSE_ABI_VERSION, &detail) ||
        hangpose_limits_of(&params, &mesh, &cloud, &limits, &detail))
      fail(detail.message);
    limits.poses = 10;
    used = before;
    const size_t sizes[3] = {hangpose_object_bytes(&limits), hangpose_supporter_bytes(&limits),
                             hangpose_predict_bytes(&limits)};
    void *of_object = take(sizes[0]), *of_supporter = take(sizes[1]), *work = take(sizes[2]);
    mark(0);
    if (hangpose_object_create(of_object, sizes[0], &mesh, &params, NULL, &object, &detail)) fail(detail.message);
    mark(1);
    if (hangpose_supporter_create(of_supporter, sizes[1], &cloud, &params, NULL, &supporter, &detail))
      fail(detail.message);
    mark(2);
    const hangpose_status status = hangpose_predict(object, supporter, NULL, &params, work, sizes[2], NULL, poses,
                                                    sizeof *poses, 10, &found, &detail);
    mark(3);
    if (status < 0) fail(detail.message);
    printf("profile %u: %u poses, best at %.9g %.9g %.9g, %lu bytes\n", profile, (unsigned)found.pose_count,
           poses[0].position[0], poses[0].position[1], poses[0].position[2],
           (unsigned long)(used - before));
  }
  return 0;
}
