// Repeats in C, in the caller's memory, the predictions that ffi/examples/pairs.rs has made in Rust, and
// compares the bits: ./pairs pair_*.bin
#include <hangpose.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CAPACITY = 10 };

static hangpose_detail detail = {.struct_size = sizeof detail};

static void *room(size_t size) {
  void *memory = malloc(size);
  if (memory == NULL) abort();
  return memory;
}

// The number of poses compared, or -1 if the prediction failed or differs.
static int compare(const uint32_t *words) {
  const uint32_t *next = words + 4;
  hangpose_params params;
  if (hangpose_params_init(&params, sizeof params, words[0], HANGPOSE_ABI_VERSION, &detail) != HANGPOSE_OK)
    return -1;
  hangpose_mesh mesh = {.struct_size = sizeof mesh, .vertex_count = words[1], .triangle_count = words[2]};
  hangpose_cloud cloud = {.struct_size = sizeof cloud, .point_count = words[3]};
  mesh.vertices = (const float *)next;
  next += 3 * mesh.vertex_count;
  mesh.triangles = next;
  next += 3 * mesh.triangle_count;
  cloud.points = (const float *)next;
  next += 3 * cloud.point_count;
  cloud.normals = (const float *)next;
  next += 3 * cloud.point_count;

  hangpose_limits limits = {.struct_size = sizeof limits};
  if (hangpose_limits_of(&params, &mesh, &cloud, &limits, &detail) != HANGPOSE_OK) return -1;
  limits.poses = CAPACITY;
  const size_t sizes[3] = {hangpose_object_bytes(&limits), hangpose_supporter_bytes(&limits),
                           hangpose_predict_bytes(&limits)};
  void *memory[3] = {room(sizes[0]), room(sizes[1]), room(sizes[2])};
  hangpose_object *object;
  hangpose_supporter *supporter;
  hangpose_pose poses[CAPACITY];
  hangpose_prediction found = {.struct_size = sizeof found};
  if (hangpose_object_create(memory[0], sizes[0], &mesh, &params, NULL, &object, &detail) < 0) return -1;
  if (hangpose_supporter_create(memory[1], sizes[1], &cloud, &params, NULL, &supporter, &detail) < 0)
    return -1;
  const hangpose_status status = hangpose_predict(object, supporter, NULL, &params, memory[2], sizes[2], NULL,
                                                  poses, sizeof *poses, CAPACITY, &found, &detail);
  const size_t first = offsetof(hangpose_prediction, pose_count);
  const size_t counts = offsetof(hangpose_prediction, settling_no_approach) + sizeof(uint32_t) - first;
  const uint64_t work[2] = {found.rays, found.distance_queries};
  int is_equal = (uint32_t)status == *next++;
  is_equal = is_equal && memcmp((const char *)&found + first, next, counts) == 0;
  next += counts / 4;
  is_equal = is_equal && memcmp(work, next, sizeof work) == 0;
  next += sizeof work / 4;
  const size_t pose_words = sizeof(hangpose_pose) / 4 - 1;
  for (uint32_t i = 0; is_equal && i < found.pose_count; ++i, next += pose_words)
    is_equal = memcmp((const uint32_t *)&poses[i] + 1, next, 4 * pose_words) == 0;
  for (int i = 0; i < 3; ++i) free(memory[i]);
  snprintf(detail.message, sizeof detail.message, "C differs from Rust");
  return is_equal ? (int)found.pose_count : -1;
}

int main(int count, char **paths) {
  int poses = 0, rejected = 0;
  for (int i = 1; i < count; ++i) {
    FILE *file = fopen(paths[i], "rb");
    if (file == NULL) return perror(paths[i]), 1;
    fseek(file, 0, SEEK_END);
    const size_t size = (size_t)ftell(file);
    rewind(file);
    uint32_t *words = room(size);
    if (fread(words, 1, size, file) != size) return perror(paths[i]), 1;
    fclose(file);
    const int compared = compare(words);
    free(words);
    if (compared < 0) return fprintf(stderr, "%s: %s\n", paths[i], detail.message), 1;
    poses += compared;
    rejected += compared == 0;
  }
  printf("%d pairs are equal to Rust bit for bit: %d poses, %d rejections\n", count - 1, poses, rejected);
  return count - 1 < 20;
}
