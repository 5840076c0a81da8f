// Predicts pairs of objects and supporters from a file, and prints hashes of what each stage found: those that the
// Rust interface finds, bit for bit, whatever the processor. ffi/examples/pairs writes the file and prints the Rust
// hashes.
//
//   pairs [FILE] [threads]
//
// A pair is seen by depth images, or given as a mesh and a cloud; it is analysed, predicted, and a path is planned.
// With `threads`, a second thread does the last two with the same models at the same time, and must find the same
// bits.
//
// Runs under Linux and, without an operating system, on a Cortex-M7. All memory is static. Each stage ends with a
// mark, so that its instructions can be counted: under Linux by bench/instructions/count.c, on the Cortex-M7 by a
// timer of the board, which qemu advances by the instruction.
#include <hangpose.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mark.h"

enum { POSES = 10, WAYPOINTS = 1000, IMAGES = 4, NAME_BYTES = 64 };

// Bytes for a pair, its models and the work of one thread on them. 15 MiB are what the largest RAM of the board leaves.
#ifndef MEMORY
#define MEMORY (15 << 20)
#endif
// Bytes for the work of a second thread, which the board does not have.
#ifdef __arm__
#define SECOND 0
#else
#define SECOND (2 << 20)
#endif
#ifdef LARGE
__attribute__((section(LARGE)))
#endif
static _Alignas(16) unsigned char memory[MEMORY + SECOND];

static hangpose_detail detail = {.struct_size = sizeof detail};
static const char *name = "", *stage = "";

static void fail(const char *what) {
  fprintf(stderr, "pairs: %s: %s: %s\n", name, stage, what);
  exit(1);
}
static void check(hangpose_status status) {
  if (status < 0) fail(detail.message);
}

// ---- memory: taken from the front, and given back all at once

static size_t used, most, limit = MEMORY;
static void *take(size_t size) {
  void *taken = memory + used;
  used += (size + 15) / 16 * 16;
  if (used > limit) {
    fprintf(stderr, "pairs: %s: %s: %lu bytes are needed of %lu\n", name, stage, (unsigned long)used,
            (unsigned long)limit);
    exit(1);
  }
  if (used > most) most = used;
  return taken;
}

// ---- marks

#ifdef __arm__
// Timer 0 of the board at 25 MHz: control, value, reload. With -icount shift=0 an instruction takes 1 ns.
#define TIMER ((volatile uint32_t *)0x40000000)
static void mark(unsigned which) {
  static uint64_t sum;
  TIMER[0] = 0;
  sum += which ? 40ull * (UINT32_MAX - TIMER[1]) : 0;
  printf("mark %u %llu\n", which, sum);
  TIMER[2] = TIMER[1] = UINT32_MAX;
  TIMER[0] = 1;
}
#else
#include <sys/prctl.h>
static void mark(unsigned which) { prctl(MARK, which, 0, 0, 0); }
#endif

// ---- hashes: FNV-1a over little-endian words

typedef uint32_t hash;
static const hash EMPTY = 0x811c9dc5;
static void add(hash *sum, const void *words, size_t size) {
  for (size_t i = 0; i < size; ++i) *sum = (*sum ^ ((const unsigned char *)words)[i]) * 0x01000193;
}
static void add_word(hash *sum, uint32_t word) { add(sum, &word, sizeof word); }
// The fields of a struct from one to another, both included.
#define ADD(sum, of, first, last)                                                           \
  add(sum, (const char *)(of) + offsetof(__typeof__(*(of)), first),                       \
      offsetof(__typeof__(*(of)), last) + sizeof((of)->last) - offsetof(__typeof__(*(of)), first))
#define ADD_WORK(sum, of) (add_word(sum, (uint32_t)(of)->rays), add_word(sum, (uint32_t)(of)->distance_queries))

// ---- the file: see ffi/examples/pairs/given.rs

struct shape {
  uint32_t points, normals, viewpoints, triangles, images;
};
struct given {
  char name[NAME_BYTES];
  uint32_t profile, seed, samples, voxels, plan;
  struct shape shapes[2];
};
static const uint32_t *next;

static const void *rows(uint32_t count) {
  const void *found = count ? next : NULL;
  next += 3 * count;
  return found;
}

static void read_images(uint32_t count, hangpose_depth_image *images, float (*viewpoints)[3]) {
  if (count > IMAGES) fail("too many images");
  for (uint32_t i = 0; i < count; ++i) {
    hangpose_depth_image *image = &images[i];
    memset(image, 0, sizeof *image);
    image->struct_size = sizeof *image;
    image->depth_count = next[0] * next[1];
    memcpy(&image->camera, next, sizeof image->camera);
    next += sizeof image->camera / 4;
    memcpy(&image->scale, next++, 4);
    memcpy(image->position, next, 12);
    memcpy(viewpoints[i], next, 12);
    next += 3;
    memcpy(image->quaternion, next, 16);
    next += 4;
    image->depths = (const uint16_t *)next;
    next += image->depth_count / 2;
  }
}

// ---- stages

static void scan_object(const hangpose_depth_image *images, uint32_t count, float voxel, hangpose_mesh *mesh, hash *sum) {
  hangpose_volume_settings settings;
  float crop[2][3];
  check(hangpose_volume_settings_init(&settings, sizeof settings, voxel, &detail));
  settings.missing_is_free = 1;
  check(hangpose_volume_room(images, count, &settings, *crop, &detail));
  settings.dense = 1;
  settings.crop = *crop;
  const uint32_t blocks = hangpose_volume_blocks(&settings);
  const size_t size = hangpose_volume_bytes(blocks), complete = hangpose_complete_bytes(blocks),
               surface = hangpose_surface_bytes(blocks), larger = complete > surface ? complete : surface;
  // The mesh stays, so that it stands before the rest. It has at most this many rows.
  enum { ROWS = 24000 };
  float *vertices = take(12 * ROWS);
  uint32_t *triangles = take(24 * ROWS);
  const size_t before = used;
  void *of_volume = take(size), *work = take(larger);
  hangpose_volume *volume;
  check(hangpose_volume_create(of_volume, size, &settings, blocks, &volume, &detail));
  for (uint32_t i = 0; i < count; ++i) {
    uint32_t pixels;
    check(hangpose_volume_integrate(volume, &images[i], NULL, &pixels, &detail));
    add_word(sum, pixels);
  }
  check(hangpose_volume_complete(volume, work, larger, NULL, &detail));
  check(hangpose_volume_surface(volume, work, larger, NULL, vertices, ROWS, triangles, 2 * ROWS, NULL, mesh, &detail));
  used = before;
  add(sum, vertices, 12 * mesh->vertex_count);
  add(sum, triangles, 12 * mesh->triangle_count);
}

static void scan_supporter(const hangpose_depth_image *images, uint32_t count, hangpose_cloud *cloud, hash *sum) {
  hangpose_points_settings settings;
  static float viewpoints[IMAGES][3];
  check(hangpose_points_settings_init(&settings, sizeof settings, &detail));
  check(hangpose_depth_points(images, count, &settings, NULL, NULL, 0, NULL, cloud, &detail));
  const uint32_t room = cloud->point_count;
  float *points = take(12 * room), *normals = take(12 * room);
  check(hangpose_depth_points(images, count, &settings, points, normals, room, *viewpoints, cloud, &detail));
  add(sum, points, 12 * cloud->point_count);
  add(sum, normals, 12 * cloud->point_count);
}

static hash of_object(const hangpose_object *object) {
  hash sum = EMPTY;
  hangpose_object_info info = {.struct_size = sizeof info};
  check(hangpose_object_get_info(object, &info, &detail));
  ADD(&sum, &info, area, area);
  ADD(&sum, &info, centre_of_mass, centre_of_mass);
  for (uint32_t i = 0; i < info.contacts; ++i) {
    hangpose_object_contact contact = {.struct_size = sizeof contact};
    check(hangpose_object_get_contact(object, i, &contact, &detail));
    ADD(&sum, &contact, position, passage);
  }
  for (uint32_t i = 0; i < info.sites; ++i) {
    hangpose_object_site site = {.struct_size = sizeof site};
    check(hangpose_object_get_site(object, i, &site, &detail));
    ADD(&sum, &site, contact_points, encircled_below);
  }
  for (uint32_t i = 0; i < info.symmetries; ++i) {
    hangpose_symmetry symmetry = {.struct_size = sizeof symmetry};
    check(hangpose_object_get_symmetry(object, i, &symmetry, &detail));
    ADD(&sum, &symmetry, fold, axis);
  }
  ADD_WORK(&sum, &info);
  return sum;
}

static hash of_supporter(const hangpose_supporter *supporter) {
  hash sum = EMPTY;
  hangpose_supporter_info info = {.struct_size = sizeof info};
  check(hangpose_supporter_get_info(supporter, &info, &detail));
  ADD(&sum, &info, points, normals_reversed);
  for (uint32_t i = 0; i < info.contacts; ++i) {
    hangpose_supporter_contact contact = {.struct_size = sizeof contact};
    check(hangpose_supporter_get_contact(supporter, i, &contact, &detail));
    ADD(&sum, &contact, position, bar_direction);
  }
  for (uint32_t i = 0; i < info.sites; ++i) {
    hangpose_supporter_site site = {.struct_size = sizeof site};
    check(hangpose_supporter_get_site(supporter, i, &site, &detail));
    ADD(&sum, &site, position, boundary_distances);
  }
  ADD_WORK(&sum, &info);
  return sum;
}

// A search for poses, and for a path to the best of them, with memory of its own.
struct search {
  const hangpose_object *object;
  const hangpose_supporter *supporter;
  const hangpose_params *params;
  int has_plan, is_marked;
  void *work, *plan_work;
  size_t work_size, plan_size;
  hangpose_pose *poses;
  hangpose_waypoint *waypoints;
  hangpose_prediction found;
  hangpose_plan plan;
  hangpose_status status;
  hangpose_detail detail;
  hash of_poses, of_path;
};

static void *search(void *of) {
  struct search *s = of;
  s->found.struct_size = sizeof s->found;
  s->plan.struct_size = sizeof s->plan;
  s->detail.struct_size = sizeof s->detail;
  s->of_poses = s->of_path = EMPTY;
  s->status = hangpose_predict(s->object, s->supporter, NULL, s->params, s->work, s->work_size, NULL, s->poses,
                               sizeof *s->poses, POSES, &s->found, &s->detail);
  if (s->is_marked) mark(4);
  if (s->status < 0) return NULL;
  add_word(&s->of_poses, (uint32_t)s->status);
  ADD(&s->of_poses, &s->found, pose_count, settling_sparse);
  ADD_WORK(&s->of_poses, &s->found);
  for (uint32_t i = 0; i < s->found.pose_count; ++i) ADD(&s->of_poses, &s->poses[i], has_pose, total);
  if (!s->has_plan || s->found.pose_count == 0) return NULL;
  if (s->is_marked) stage = "path";
  s->status = hangpose_plan_path(s->object, s->supporter, NULL, s->params, NULL, &s->poses[0], s->plan_work, s->plan_size,
                                 NULL, s->waypoints, sizeof *s->waypoints, WAYPOINTS, &s->plan, &s->detail);
  if (s->is_marked) mark(5);
  if (s->status < 0) return NULL;
  add_word(&s->of_path, (uint32_t)s->status);
  ADD(&s->of_path, &s->plan, has_path, asked);
  ADD_WORK(&s->of_path, &s->plan);
  for (uint32_t i = 0; i < s->plan.waypoint_count; ++i) ADD(&s->of_path, &s->waypoints[i], seconds, quaternion);
  return NULL;
}

#ifdef __arm__
static void search_twice(struct search *one, struct search *two) {
  (void)one, (void)two;
  fail("there are no threads here");
}
#else
#include <pthread.h>
#include <unistd.h>
static void search_twice(struct search *one, struct search *two) {
  // A thread with little stack: what the library promises and some for the C library, or the least that there is.
  const size_t least = (size_t)sysconf(_SC_THREAD_STACK_MIN), stack = least > 64 << 10 ? least : 64 << 10;
  pthread_t thread;
  pthread_attr_t little;
  pthread_attr_init(&little);
  if (pthread_attr_setstacksize(&little, stack) || pthread_create(&thread, &little, search, two)) fail("no thread");
  search(one);
  pthread_join(thread, NULL);
  if (one->status != two->status || one->of_poses != two->of_poses || one->of_path != two->of_path)
    fail("the second thread found other bits");
}
#endif

static void print(int is_there, hash sum) {
  if (is_there)
    printf("%08" PRIx32 " ", sum);
  else
    printf("%-8s ", "-");
}

static void pair(const struct given *given, int threads) {
  static hangpose_depth_image images[2][IMAGES];
  static float viewpoints[2][IMAGES][3];
  next = (const uint32_t *)(given + 1);
  hangpose_mesh mesh = {.struct_size = sizeof mesh};
  hangpose_cloud cloud = {.struct_size = sizeof cloud};
  const struct shape *of = &given->shapes[0], *on = &given->shapes[1];
  mesh.vertices = rows(mesh.vertex_count = of->points);
  rows(of->normals);
  mesh.viewpoints = rows(mesh.viewpoint_count = of->viewpoints);
  mesh.triangles = rows(mesh.triangle_count = of->triangles);
  read_images(of->images, images[0], viewpoints[0]);
  cloud.points = rows(cloud.point_count = on->points);
  cloud.normals = rows(on->normals);
  cloud.viewpoints = rows(cloud.viewpoint_count = on->viewpoints);
  read_images(on->images, images[1], viewpoints[1]);

  hash of_scan = EMPTY;
  mark(0);
  stage = "scan";
  if (of->images) {
    scan_object(images[0], of->images, 0.004f, &mesh, &of_scan);
    mesh.viewpoints = *viewpoints[0];
    mesh.viewpoint_count = of->images;
  }
  if (on->images) scan_supporter(images[1], on->images, &cloud, &of_scan);
  mark(1);

  hangpose_params params;
  hangpose_limits limits = {.struct_size = sizeof limits};
  check(hangpose_params_init(&params, sizeof params, given->profile, HANGPOSE_ABI_VERSION, &detail));
  params.seed = given->seed;
  params.samples = given->samples;
  params.voxels = given->voxels;
  check(hangpose_limits_of(&params, &mesh, &cloud, &limits, &detail));
  limits.poses = POSES;
  limits.waypoints = WAYPOINTS;
  stage = "object";
  hangpose_object *object;
  hangpose_supporter *supporter;
  const size_t sizes[2] = {hangpose_object_bytes(&limits), hangpose_supporter_bytes(&limits)};
  check(hangpose_object_create(take(sizes[0]), sizes[0], &mesh, &params, NULL, &object, &detail));
  mark(2);
  stage = "supporter";
  check(hangpose_supporter_create(take(sizes[1]), sizes[1], &cloud, &params, NULL, &supporter, &detail));
  mark(3);
  stage = "poses";
  static struct search searches[2];
  for (int i = 0; i < 1 + threads; ++i) {
    limit = MEMORY + (size_t)i * SECOND;
    struct search *s = &searches[i];
    *s = (struct search){.object = object, .supporter = supporter, .params = &params};
    s->has_plan = (int)given->plan;
    s->is_marked = i == 0;
    s->work = take(s->work_size = hangpose_predict_bytes(&limits));
    s->poses = take(POSES * sizeof *s->poses);
    if (!s->has_plan) continue;
    s->plan_work = take(s->plan_size = hangpose_plan_bytes(&limits));
    s->waypoints = take(WAYPOINTS * sizeof *s->waypoints);
  }
  struct search *s = &searches[0];
  if (threads)
    search_twice(s, &searches[1]);
  else
    search(s);
  if (s->status < 0) fail(s->detail.message);

  print(of->images || on->images, of_scan);
  print(1, of_object(object));
  print(1, of_supporter(supporter));
  print(1, s->of_poses);
  print(s->has_plan && s->found.pose_count, s->of_path);
  printf("%2" PRIu32 " poses  %s\n", s->found.pose_count, name);
  const hangpose_pose *best = s->poses;
  printf("    %s", hangpose_stage_string(s->found.stage));
  if (s->found.pose_count)
    printf("; best at %.9g %.9g %.9g", best->position[0], best->position[1], best->position[2]);
  if (s->found.pose_count && best->has_rest) printf(", probability %.3f", best->probability);
  if (s->plan.has_path) printf(", path of %" PRIu32 " waypoints", s->plan.waypoint_count);
  printf("\n");
}

#ifdef __arm__
size_t stack_used(void);
#endif

int main(int argc, char **argv) {
  const char *path = argc > 1 ? argv[1] : "pairs.bin";
  // So that the lines stand among the marks.
  setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
  FILE *file = fopen(path, "rb");
  if (!file) return perror(path), 1;
  uint32_t words;
  while (fread(&words, 4, 1, file) == 1) {
    used = 0;
    limit = MEMORY;
    stage = "input";
    struct given *given = take(4ul * words);
    if (fread(given, 4, words, file) != words) fail("the file is too short");
    name = given->name;
    pair(given, argc > 2);
  }
  fclose(file);
  printf("most memory %lu bytes\n", (unsigned long)most);
#ifdef __arm__
  printf("most stack %lu bytes\n", (unsigned long)stack_used());
#endif
  return 0;
}
