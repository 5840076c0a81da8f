// Invalid depth images, volumes and settings for robustness.c: each call must return an error status, write
// to no memory other than its own, and leave the volume unchanged.
#ifndef DEPTH_H
#define DEPTH_H

#include <hangpose.h>
#include <pthread.h>
#include <stdatomic.h>

#include "fixture.h"

// A square plate, 8 pixels wide, half a metre before the camera.
enum { WIDTH = 16, HEIGHT = 12, PIXELS = WIDTH * HEIGHT, ROWS = 4000 };
static uint16_t depths[PIXELS];
static uint8_t labels[PIXELS];
static float crop[2][3], surface_vertices[ROWS][3], seen_points[2 * PIXELS][3], seen_normals[2 * PIXELS][3],
    viewpoints[2][3];
static uint32_t surface_triangles[ROWS][3];
static uint8_t seen[ROWS];
static hangpose_depth_image image = {.struct_size = sizeof image,
                                     .depth_count = PIXELS,
                                     .label_count = PIXELS,
                                     .scale = 0.001f,
                                     .camera = {WIDTH, HEIGHT, {50, 50}, {7.5f, 5.5f}, {0}},
                                     .quaternion = {0, 0, 0, 1},
                                     .depths = depths,
                                     .labels = labels,
                                     .label = 1};
static hangpose_volume_settings settings;
static hangpose_points_settings points_settings;
static uint32_t blocks, surface_count;
static unsigned char *volume_memory, *volume_work;
static size_t volume_size, complete_size, surface_size;
static hangpose_volume *volume;

static hangpose_status make_volume(void *memory, size_t size, const hangpose_volume_settings *s, uint32_t b) {
  hangpose_volume *made = (void *)&detail;
  const hangpose_status status = hangpose_volume_create(memory, size, s, b, &made, &detail);
  CHECK(status == HANGPOSE_ERROR_OVERLAP || (made != NULL) == (status == HANGPOSE_OK));
  return status;
}
static hangpose_status integrate(hangpose_volume *into, const hangpose_depth_image *i,
                                 hangpose_monitor *watch) {
  uint32_t pixels = 77;
  const hangpose_status status = hangpose_volume_integrate(into, i, watch, &pixels, &detail);
  CHECK(pixels == (status == HANGPOSE_OK ? 64u : 77u));
  return status;
}
static hangpose_status complete(hangpose_volume *of, void *memory, size_t size, hangpose_monitor *watch) {
  return hangpose_volume_complete(of, memory, size, watch, &detail);
}
static hangpose_status find(const hangpose_volume *of, void *memory, size_t size, hangpose_mesh *m) {
  return hangpose_volume_surface(of, memory, size, NULL, *surface_vertices, ROWS, *surface_triangles, ROWS,
                                 seen, m, &detail);
}
static hangpose_status see(const hangpose_depth_image *i, uint32_t count, const hangpose_points_settings *s,
                           hangpose_cloud *c) {
  return hangpose_depth_points(i, count, s, *seen_points, *seen_normals, 2 * PIXELS, *viewpoints, c, &detail);
}
static hangpose_status room(const hangpose_depth_image *i, uint32_t count,
                            const hangpose_volume_settings *s) {
  return hangpose_volume_room(i, count, s, *crop, &detail);
}
// Whether the volume still has the surface that it had at first.
static int is_volume_unharmed(void) {
  hangpose_mesh m = {.struct_size = sizeof m};
  return find(volume, volume_work, surface_size, &m) == HANGPOSE_OK && m.triangle_count == surface_count;
}

static void set_up_depth(void) {
  for (int v = 2; v < 10; ++v)
    for (int u = 4; u < 12; ++u) depths[WIDTH * v + u] = 500, labels[WIDTH * v + u] = 1;
  CHECK(hangpose_volume_settings_init(&settings, sizeof settings, 0.01f, &detail) == HANGPOSE_OK);
  CHECK(hangpose_points_settings_init(&points_settings, sizeof points_settings, &detail) == HANGPOSE_OK);
  settings.missing_is_free = 1;
  settings.dense = 2;  // not used
  CHECK(room(&image, 1, &settings) == HANGPOSE_OK && crop[0][2] < 0.45f && crop[1][2] > 0.55f);
  settings.dense = 1;
  settings.crop = *crop;
  blocks = hangpose_volume_blocks(&settings);
  volume_size = hangpose_volume_bytes(blocks);
  complete_size = hangpose_complete_bytes(blocks);
  surface_size = hangpose_surface_bytes(blocks);
  CHECK(blocks > 0 && HANGPOSE_VOLUME_BYTES(blocks) >= volume_size);
  CHECK(HANGPOSE_COMPLETE_BYTES(blocks) >= complete_size && HANGPOSE_SURFACE_BYTES(blocks) >= surface_size);
  volume_memory = guarded(volume_size, 3);
  volume_work = guarded(complete_size, 5);
  CHECK(hangpose_volume_create(volume_memory, volume_size, &settings, blocks, &volume, &detail) ==
        HANGPOSE_OK);
  CHECK(integrate(volume, &image, NULL) == HANGPOSE_OK);
  CHECK(complete(volume, volume_work, complete_size, NULL) == HANGPOSE_OK);
  hangpose_mesh m = {.struct_size = sizeof m};
  CHECK(find(volume, volume_work, surface_size, &m) == HANGPOSE_OK);
  surface_count = m.triangle_count;
  CHECK(surface_count > 100 && m.vertices == *surface_vertices && m.triangles == *surface_triangles);
  // Only counted.
  CHECK(hangpose_volume_surface(volume, volume_work, surface_size, NULL, NULL, 0, NULL, 0, NULL, &m,
                                &detail) == HANGPOSE_OK);
  CHECK(m.triangle_count == surface_count && m.vertices == NULL && m.triangles == NULL);
  // The volume is a closed mesh, as the analysis of an object takes it.
  hangpose_object *plate;
  CHECK(find(volume, volume_work, surface_size, &m) == HANGPOSE_OK);
  hangpose_limits l = {.struct_size = sizeof l};
  CHECK(hangpose_limits_of(&params, &m, NULL, &l, &detail) == HANGPOSE_OK);
  unsigned char *memory = guarded(hangpose_object_bytes(&l), 0);
  CHECK(hangpose_object_create(memory, hangpose_object_bytes(&l), &m, &params, NULL, &plate, &detail) ==
        HANGPOSE_OK);
  hangpose_object_info info = {.struct_size = sizeof info};
  CHECK(hangpose_object_get_info(plate, &info, &detail) == HANGPOSE_OK && info.is_closed == 1);
  release(memory, hangpose_object_bytes(&l), 0);
  hangpose_cloud c = {.struct_size = sizeof c};
  const hangpose_depth_image both[2] = {image, image};
  CHECK(see(both, 2, &points_settings, &c) == HANGPOSE_OK && c.point_count > 0 && c.viewpoint_count == 2);
  CHECK(c.points == *seen_points && c.normals == *seen_normals && c.viewpoints == *viewpoints);
}

static void null_and_misaligned_depth(void) {
  static unsigned char odd[sizeof image + 8];
  void *const bad[2] = {NULL, odd + 1};
  hangpose_mesh m = {.struct_size = sizeof m};
  hangpose_cloud c = {.struct_size = sizeof c};
  for (int i = 0; i < 2; ++i) {
    REFUSED(hangpose_volume_settings_init(bad[i], sizeof settings, 0.01f, &detail));
    REFUSED(hangpose_points_settings_init(bad[i], sizeof points_settings, &detail));
    REFUSED(room(bad[i], 1, &settings));
    REFUSED(room(&image, 1, bad[i]));
    REFUSED(hangpose_volume_room(&image, 1, &settings, bad[i], &detail));
    CHECK(hangpose_volume_blocks(bad[i]) == 0);
    unsigned char *memory = guarded(volume_size, 0);
    REFUSED(make_volume(NULL, volume_size, &settings, blocks));
    REFUSED(make_volume(memory, volume_size, bad[i], blocks));
    REFUSED(hangpose_volume_create(memory, volume_size, &settings, blocks, bad[i], &detail));
    release(memory, volume_size, 0);
    REFUSED(integrate(bad[i], &image, NULL));
    REFUSED(integrate(volume, bad[i], NULL));
    REFUSED(hangpose_volume_integrate(volume, &image, NULL, bad[i], &detail));
    REFUSED(complete(bad[i], volume_work, complete_size, NULL));
    REFUSED(complete(volume, NULL, complete_size, NULL));
    REFUSED(find(bad[i], volume_work, surface_size, &m));
    REFUSED(find(volume, NULL, surface_size, &m));
    REFUSED(find(volume, volume_work, surface_size, bad[i]));
    REFUSED(hangpose_volume_surface(volume, volume_work, surface_size, NULL, bad[i], ROWS, *surface_triangles,
                                    ROWS, seen, &m, &detail));
    REFUSED(hangpose_volume_surface(volume, volume_work, surface_size, NULL, *surface_vertices, ROWS, bad[i],
                                    ROWS, seen, &m, &detail));
    REFUSED(see(bad[i], 1, &points_settings, &c));
    REFUSED(see(&image, 1, bad[i], &c));
    REFUSED(see(&image, 1, &points_settings, bad[i]));
    REFUSED(hangpose_depth_points(&image, 1, &points_settings, bad[i], *seen_normals, PIXELS, *viewpoints, &c,
                                  &detail));
    REFUSED(hangpose_depth_points(&image, 1, &points_settings, *seen_points, bad[i], PIXELS, *viewpoints, &c,
                                  &detail));
    REFUSED(hangpose_depth_points(&image, 1, &points_settings, *seen_points, *seen_normals, PIXELS, bad[i],
                                  &c, &detail));
    hangpose_depth_image broken = image;
    broken.depths = bad[i];
    REFUSED(integrate(volume, &broken, NULL));
    REFUSED(see(&broken, 1, &points_settings, &c));
    REFUSED(room(&broken, 1, &settings));
  }
  // No labels are no mask; labels without a count, or a count without labels, are an error.
  hangpose_depth_image broken = image;
  broken.labels = NULL;
  CHECK(integrate(volume, &broken, NULL) == HANGPOSE_ERROR_NULL);
  broken.label_count = 0;
  CHECK(see(&broken, 1, &points_settings, &c) == HANGPOSE_OK);
  broken.labels = labels;
  CHECK(integrate(volume, &broken, NULL) == HANGPOSE_ERROR_COUNT);
  hangpose_volume_settings odd_crop = settings;
  odd_crop.crop = (const float *)(const void *)(odd + 1);
  CHECK(make_volume(volume_work, complete_size, &odd_crop, blocks) == HANGPOSE_ERROR_MISALIGNED);
  hangpose_points_settings odd_points = points_settings;
  odd_points.crop = odd_crop.crop;
  CHECK(see(&image, 1, &odd_points, &c) == HANGPOSE_ERROR_MISALIGNED);
  CHECK(is_volume_unharmed());
}

static void sizes_of_depth(void) {
  const uint32_t sizes[] = {0, 1, 4, 1000, UINT32_MAX};
  for (int i = 0; i < 5; ++i) {
    hangpose_depth_image two[2] = {image, image};
    hangpose_volume_settings s = settings;
    hangpose_points_settings p = points_settings;
    hangpose_mesh m = {.struct_size = sizes[i]};
    hangpose_cloud c = {.struct_size = sizes[i]};
    two[1].struct_size = s.struct_size = p.struct_size = sizes[i];
    REFUSED(hangpose_volume_settings_init(&s, sizes[i], 0.01f, &detail));
    REFUSED(hangpose_points_settings_init(&p, sizes[i], &detail));
    REFUSED(integrate(volume, &two[1], NULL));
    REFUSED(room(two, 2, &settings));
    REFUSED(room(&image, 1, &s));
    CHECK(hangpose_volume_blocks(&s) == 0);
    REFUSED(make_volume(volume_work, complete_size, &s, blocks));
    REFUSED(find(volume, volume_work, surface_size, &m));
    REFUSED(see(two, 2, &points_settings, &c));
    REFUSED(see(&image, 1, &p, &c));
    REFUSED(see(&image, 1, &points_settings, &c));
  }
  for (size_t offset = 0; offset < 17; offset += 5) {
    unsigned char *memory = guarded(volume_size, offset);
    CHECK(make_volume(memory, volume_size - 1, &settings, blocks) == HANGPOSE_ERROR_MEMORY);
    CHECK(make_volume(memory, volume_size, &settings, blocks) == HANGPOSE_OK);
    release(memory, volume_size, offset);
    memory = guarded(complete_size, offset);
    CHECK(complete(volume, memory, complete_size - 1, NULL) == HANGPOSE_ERROR_MEMORY);
    CHECK(complete(volume, memory, complete_size, NULL) == HANGPOSE_OK);
    release(memory, complete_size, offset);
    memory = guarded(surface_size, offset);
    hangpose_mesh m = {.struct_size = sizeof m};
    CHECK(find(volume, memory, surface_size - 1, &m) == HANGPOSE_ERROR_MEMORY && m.vertices == NULL);
    CHECK(find(volume, memory, surface_size, &m) == HANGPOSE_OK);
    release(memory, surface_size, offset);
  }
  hangpose_mesh m = {.struct_size = sizeof m};
  hangpose_cloud c = {.struct_size = sizeof c};
  CHECK(room(&image, 0, &settings) == HANGPOSE_ERROR_COUNT &&
        see(&image, 0, &points_settings, &c) == HANGPOSE_ERROR_COUNT);
  CHECK(make_volume(volume_work, SIZE_MAX / 4, &settings, UINT32_MAX) < 0);
  CHECK(make_volume(volume_work, complete_size, &settings, 0) == HANGPOSE_ERROR_COUNT);
  CHECK(make_volume(volume_work, complete_size, &settings, blocks - 1) == HANGPOSE_ERROR_CAPACITY);
  CHECK(detail.minimum == blocks && strcmp(detail.field, "blocks") == 0);
  CHECK(hangpose_volume_surface(volume, volume_work, surface_size, NULL, *surface_vertices, 10,
                                *surface_triangles, ROWS, NULL, &m, &detail) == HANGPOSE_ERROR_CAPACITY);
  CHECK(strcmp(detail.field, "vertex_capacity") == 0 && detail.minimum > 10 && m.vertices == NULL);
  CHECK(hangpose_volume_surface(volume, volume_work, surface_size, NULL, *surface_vertices, ROWS,
                                *surface_triangles, surface_count - 1, NULL, &m,
                                &detail) == HANGPOSE_ERROR_CAPACITY);
  CHECK(strcmp(detail.field, "triangle_capacity") == 0 && detail.minimum == surface_count);
  CHECK(hangpose_depth_points(&image, 1, &points_settings, *seen_points, *seen_normals, 3, *viewpoints, &c,
                              &detail) == HANGPOSE_ERROR_CAPACITY);
  CHECK(strcmp(detail.field, "point_capacity") == 0 && detail.minimum > 3 && c.points == NULL);
  CHECK(hangpose_depth_points(&image, 1, &points_settings, NULL, NULL, 0, NULL, &c, &detail) == HANGPOSE_OK);
  CHECK(c.point_count > 3 && c.points == NULL);
  CHECK(is_volume_unharmed());
}

// Refused by every function that takes images: the field that `detail` names.
static void check_image(const hangpose_depth_image *broken, hangpose_status status, const char *field) {
  const hangpose_depth_image two[2] = {image, *broken};
  hangpose_cloud c = {.struct_size = sizeof c};
  CHECK(integrate(volume, broken, NULL) == status && strcmp(detail.field, field) == 0);
  CHECK(detail.index == HANGPOSE_NO_INDEX);
  CHECK(room(two, 2, &settings) == status && detail.index == 1 && strcmp(detail.field, field) == 0);
  CHECK(see(two, 2, &points_settings, &c) == status && detail.index == 1 && strcmp(detail.field, field) == 0);
}
static void check_settings(const hangpose_volume_settings *broken, hangpose_status status,
                           const char *field) {
  CHECK(hangpose_volume_blocks(broken) == 0);
  CHECK(make_volume(volume_work, complete_size, broken, blocks) == status &&
        strcmp(detail.field, field) == 0);
}

static void values_of_depth(void) {
  hangpose_depth_image i = image;
  i.camera.width = 0, check_image(&i, HANGPOSE_ERROR_COUNT, "image.camera.width"), i = image;
  i.camera.height = UINT32_MAX, check_image(&i, HANGPOSE_ERROR_COUNT, "image.camera.height"), i = image;
  i.camera.focal[1] = 0, check_image(&i, HANGPOSE_ERROR_VALUE, "image.camera.focal"), i = image;
  i.camera.centre[0] = 17, check_image(&i, HANGPOSE_ERROR_VALUE, "image.camera.centre"), i = image;
  i.camera.distortion[4] = NAN, check_image(&i, HANGPOSE_ERROR_VALUE, "image.camera.distortion"), i = image;
  i.depth_count = PIXELS - 1, check_image(&i, HANGPOSE_ERROR_COUNT, "image.depth_count"), i = image;
  i.label_count = PIXELS - 1, check_image(&i, HANGPOSE_ERROR_COUNT, "image.label_count"), i = image;
  i.scale = -1, check_image(&i, HANGPOSE_ERROR_VALUE, "image.scale"), i = image;
  i.position[2] = INFINITY, check_image(&i, HANGPOSE_ERROR_VALUE, "image.position"), i = image;
  i.quaternion[3] = 0, check_image(&i, HANGPOSE_ERROR_VALUE, "image.quaternion"), i = image;
  i.quaternion[0] = NAN, check_image(&i, HANGPOSE_ERROR_VALUE, "image.quaternion"), i = image;
  static const uint16_t nothing[PIXELS];
  i.depths = nothing, check_image(&i, HANGPOSE_ERROR_BLANK, "image.depths"), i = image;
  // Values that no camera has, but that are no error, do no harm.
  const float wild[] = {1e-30f, 1e30f, -1e30f};
  unsigned char *memory = guarded(volume_size, 0);
  hangpose_volume *other;
  CHECK(hangpose_volume_create(memory, volume_size, &settings, blocks, &other, &detail) == HANGPOSE_OK);
  for (int k = 0; k < 3; ++k) {
    hangpose_cloud c = {.struct_size = sizeof c};
    uint32_t pixels;
    for (int field = 0; field < 4; ++field, i = image) {
      float *const fields[] = {&i.scale, &i.camera.focal[0], &i.camera.distortion[0],
                               &i.camera.distortion[3]};
      *fields[field] = wild[k];
      hangpose_volume_integrate(other, &i, NULL, &pixels, &detail);
      hangpose_depth_points(&i, 1, &points_settings, NULL, NULL, 0, NULL, &c, &detail);
      float unused[2][3];
      hangpose_volume_room(&i, 1, &settings, *unused, &detail);
    }
  }
  release(memory, volume_size, 0);

  hangpose_volume_settings s = settings;
  s.dense = 2, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.dense"), s = settings;
  s.missing_is_free = 2, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.missing_is_free"), s = settings;
  s.voxel = NAN, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.voxel"), s = settings;
  s.truncation = 0.01f, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.truncation"), s = settings;
  s.max_depth = 0, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.max_depth"), s = settings;
  s.thickness = -1, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.thickness"), s = settings;
  s.radius = NAN, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.radius"), s = settings;
  s.crop = NULL, check_settings(&s, HANGPOSE_ERROR_NULL, "settings.crop"), s = settings;
  const float far[6] = {0, 0, 0, 1e6f, 1, 1}, swapped[6] = {1, 1, 1, 0, 0, 0},
              vast[6] = {-300, -300, -300, 300, 300, 300};
  s.crop = far, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.crop"), s = settings;
  s.crop = swapped, check_settings(&s, HANGPOSE_ERROR_VALUE, "settings.crop"), s = settings;
  s.crop = vast;
  CHECK(hangpose_volume_blocks(&s) == UINT32_MAX);
  s = settings;
  s.max_depth = 0.1f;
  float unused[2][3];
  CHECK(hangpose_volume_room(&image, 1, &s, *unused, &detail) == HANGPOSE_ERROR_BLANK);

  hangpose_points_settings p = points_settings;
  hangpose_cloud c = {.struct_size = sizeof c};
  p.stride = 0;
  CHECK(see(&image, 1, &p, &c) == HANGPOSE_ERROR_VALUE && strcmp(detail.field, "settings.stride") == 0);
  p = points_settings;
  p.least_cosine = NAN;
  CHECK(see(&image, 1, &p, &c) == HANGPOSE_ERROR_VALUE && strcmp(detail.field, "settings.least_cosine") == 0);
  p = points_settings;
  p.max_depth = 0.1f;
  CHECK(see(&image, 1, &p, &c) == HANGPOSE_ERROR_BLANK && strcmp(detail.field, "images") == 0);
  CHECK(c.points == NULL && c.point_count == 0);
  CHECK(is_volume_unharmed());
}

static void handles_of_depth(void) {
  hangpose_mesh m = {.struct_size = sizeof m};
  hangpose_monitor monitor;
  hangpose_volume *sparse;
  unsigned char *memory = guarded(volume_size, 0);
  CHECK(integrate((void *)memory, &image, NULL) == HANGPOSE_ERROR_HANDLE);
  CHECK(integrate((void *)object, &image, NULL) == HANGPOSE_ERROR_HANDLE);
  memcpy(memory, volume, 200);
  CHECK(find((void *)memory, volume_work, surface_size, &m) == HANGPOSE_ERROR_HANDLE);
  // A sparse volume has no surface at first, cannot be completed, and takes no image with more blocks than it
  // has.
  hangpose_volume_settings s = settings;
  s.dense = 0;
  CHECK(hangpose_volume_create(memory, volume_size, &s, 1, &sparse, &detail) == HANGPOSE_OK);
  CHECK(find(sparse, volume_work, surface_size, &m) == HANGPOSE_OK && m.triangle_count == 0);
  CHECK(complete(sparse, volume_work, complete_size, NULL) == HANGPOSE_ERROR_SPARSE);
  CHECK(integrate(sparse, &image, NULL) == HANGPOSE_ERROR_CAPACITY && detail.minimum == 2);
  CHECK(strcmp(detail.field, "volume") == 0);
  // Stopped calls.
  memset(&monitor, 0, sizeof monitor);
  CHECK(integrate(volume, &image, &monitor) == HANGPOSE_ERROR_HANDLE);
  hangpose_monitor_init(&monitor, sizeof monitor, 3, NULL);
  CHECK(integrate(volume, &image, &monitor) == HANGPOSE_WORK_LIMIT);
  CHECK(complete(volume, volume_work, complete_size, &monitor) == HANGPOSE_OK);
  hangpose_monitor_cancel(&monitor);
  CHECK(integrate(volume, &image, &monitor) == HANGPOSE_CANCELLED);
  CHECK(complete(volume, volume_work, complete_size, &monitor) == HANGPOSE_CANCELLED);
  CHECK(hangpose_volume_surface(volume, volume_work, surface_size, &monitor, NULL, 0, NULL, 0, NULL, &m,
                                &detail) == HANGPOSE_CANCELLED);
  release(memory, volume_size, 0);
  CHECK(is_volume_unharmed());
}

static void overlaps_of_depth(void) {
  hangpose_mesh m = {.struct_size = sizeof m};
  hangpose_cloud c = {.struct_size = sizeof c};
  unsigned char *inside = volume_memory + 4096 + (16 - (uintptr_t)volume_memory % 16);
  float *rows = (float *)(void *)inside;
  hangpose_depth_image i = image;
  i.depths = (const uint16_t *)(void *)inside;
  CHECK(integrate(volume, &i, NULL) == HANGPOSE_ERROR_OVERLAP);
  i = image, i.labels = inside;
  CHECK(integrate(volume, &i, NULL) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_volume_integrate(volume, &image, NULL, (void *)inside, &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_volume_integrate(volume, &image, NULL, &image.depth_count, &detail) ==
        HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_volume_integrate(volume, &image, NULL, (void *)&detail.index, &detail) ==
        HANGPOSE_ERROR_OVERLAP);
  CHECK(complete(volume, volume_memory, volume_size, NULL) == HANGPOSE_ERROR_OVERLAP);
  CHECK(find(volume, volume_memory, volume_size, &m) == HANGPOSE_ERROR_OVERLAP);
  CHECK(find(volume, surface_vertices, sizeof surface_vertices, &m) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_volume_surface(volume, volume_work, surface_size, NULL, rows, 10, *surface_triangles, 10,
                                NULL, &m, &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_volume_surface(volume, volume_work, surface_size, NULL, *surface_vertices, ROWS,
                                *surface_triangles, ROWS, (void *)surface_triangles, &m,
                                &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(make_volume(&settings, sizeof settings, &settings, blocks) == HANGPOSE_ERROR_OVERLAP);
  hangpose_volume_settings s = settings;
  s.crop = (const float *)(const void *)(volume_work + 11);  // aligned, inside of the memory
  CHECK(make_volume(volume_work, complete_size, &s, blocks) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_volume_room(&image, 1, &settings, (void *)&image.camera, &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_volume_room(&image, 1, &settings, (void *)depths, &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_depth_points(&image, 1, &points_settings, *seen_points, *seen_points, PIXELS, *viewpoints,
                              &c, &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_depth_points(&image, 1, &points_settings, (void *)depths, *seen_normals, PIXELS, *viewpoints,
                              &c, &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(is_volume_unharmed());
}

// A thread finds the surface while another fuses images: one of them is refused.
static atomic_int is_over;
static void *find_again_and_again(void *tally) {
  unsigned char *mine = guarded(surface_size, 0);
  while (!is_over) {
    hangpose_mesh m = {.struct_size = sizeof m};
    const hangpose_status status =
        hangpose_volume_surface(volume, mine, surface_size, NULL, NULL, 0, NULL, 0, NULL, &m, NULL);
    *(int *)tally += status != HANGPOSE_OK && status != HANGPOSE_ERROR_BUSY;
    sched_yield();
  }
  free(mine - GUARD);
  return NULL;
}
static void threads_of_depth(void) {
  pthread_t thread;
  int wrong = 0;
  pthread_create(&thread, NULL, find_again_and_again, &wrong);
  for (int i = 0; i < 50; ++i) {
    const hangpose_status status = integrate(volume, &image, NULL);
    CHECK(status == HANGPOSE_OK || status == HANGPOSE_ERROR_BUSY);
    sched_yield();
  }
  is_over = 1;
  pthread_join(thread, NULL);
  CHECK(wrong == 0);
}

static void depth_images(void) {
  set_up_depth();
  null_and_misaligned_depth();
  sizes_of_depth();
  values_of_depth();
  handles_of_depth();
  overlaps_of_depth();
  threads_of_depth();
  release(volume_work, complete_size, 5);
  release(volume_memory, volume_size, 3);
}

#endif
