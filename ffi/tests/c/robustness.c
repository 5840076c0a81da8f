// Calls every function with invalid arguments of every kind. Each call must return an error status, write to
// no memory other than its own, and leave the models unchanged. Runs as it is, with the caller under the
// sanitizers, and under valgrind.
#include <hangpose.h>
#include <pthread.h>
#include <stddef.h>
#include <time.h>

#include "depth.h"
#include "fixture.h"

static void sizes_and_alignment(void) {
  for (size_t offset = 0; offset < 17; ++offset) {
    unsigned char *memory = guarded(object_size, offset);
    REFUSED(make_object(memory, object_size - 1, &mesh, &params, NULL));
    if (offset % 4 == 1) CHECK(make_object(memory, object_size, &mesh, &params, NULL) == HANGPOSE_OK);
    release(memory, object_size, offset);
    memory = guarded(supporter_size, offset);
    REFUSED(make_supporter(memory, supporter_size - 1, &cloud, &params));
    if (offset % 4 == 1) CHECK(make_supporter(memory, supporter_size, &cloud, &params) == HANGPOSE_OK);
    release(memory, supporter_size, offset);
    unsigned char *before = work;
    work = guarded(predict_size, offset);
    CHECK(is_unharmed());
    release(work, predict_size, offset);
    work = before;
  }
  const size_t sizes[] = {0, 1, 40, SIZE_MAX, SIZE_MAX / 2 + 1};
  for (int i = 0; i < 5; ++i) {
    hangpose_pose pose;
    hangpose_prediction found = {.struct_size = sizeof found};
    unsigned char *memory = guarded(64, 0);
    REFUSED(make_object(memory, sizes[i], &mesh, &params, NULL));
    REFUSED(make_supporter(memory, sizes[i], &cloud, &params));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, memory, sizes[i], NULL, &pose, sizeof pose, 1,
                             &found, &detail));
    REFUSED(hangpose_mesh_sample(&mesh, 0, memory, sizes[i], *points, *normals, 10, &detail));
    release(memory, 64, 0);
  }
  CHECK(HANGPOSE_OBJECT_BYTES(RING_VERTICES, RING_TRIANGLES, SAMPLES, VOXELS) >= object_size);
  CHECK(HANGPOSE_SUPPORTER_BYTES(POINTS) >= supporter_size);
  CHECK(HANGPOSE_PREDICT_BYTES(POINTS, POSES) >= predict_size);
}

static void run_one_after_the_other(void *context, hangpose_task first, void *first_argument,
                                    hangpose_task second, void *second_argument) {
  (void)context;
  second(second_argument);
  first(first_argument);
}

static void null_and_misaligned(void) {
  union {
    hangpose_mesh mesh;
    hangpose_cloud cloud;
    hangpose_params params;
    hangpose_limits limits;
    hangpose_prediction found;
    hangpose_object_info info;
    unsigned char bytes[512];
  } odd = {.bytes = {0}};
  // At odd addresses, and null.
  void *const bad[2] = {NULL, odd.bytes + 1};
  hangpose_pose pose;
  hangpose_prediction found = {.struct_size = sizeof found};
  hangpose_object_info object_info = {.struct_size = sizeof object_info};
  hangpose_supporter_info supporter_info = {.struct_size = sizeof supporter_info};
  hangpose_object_site object_site = {.struct_size = sizeof object_site};
  hangpose_supporter_site supporter_site = {.struct_size = sizeof supporter_site};
  hangpose_object_contact object_contact = {.struct_size = sizeof object_contact};
  hangpose_supporter_contact supporter_contact = {.struct_size = sizeof supporter_contact};
  hangpose_symmetry symmetry = {.struct_size = sizeof symmetry};
  hangpose_object *o;
  hangpose_supporter *s;
  hangpose_monitor monitor;
  hangpose_threads two_threads = {.struct_size = sizeof two_threads, .join = run_one_after_the_other};
  for (int i = 0; i < 2; ++i) {
    REFUSED(
        hangpose_params_init(bad[i], sizeof params, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION, &detail));
    REFUSED(hangpose_monitor_init(bad[i], sizeof monitor, 0, &detail));
    hangpose_monitor_init(&monitor, sizeof monitor, HANGPOSE_NO_WORK_LIMIT, NULL);
    REFUSED(hangpose_monitor_use_threads(bad[i], &two_threads, &detail));
    REFUSED(hangpose_monitor_use_threads(&monitor, bad[i], &detail));
    REFUSED(hangpose_limits_of(bad[i], &mesh, &cloud, &limits, &detail));
    REFUSED(hangpose_limits_of(&params, &mesh, &cloud, bad[i], &detail));
    CHECK(hangpose_object_bytes(bad[i]) == 0 && hangpose_supporter_bytes(bad[i]) == 0);
    CHECK(hangpose_predict_bytes(bad[i]) == 0);
    unsigned char *memory = guarded(object_size, 0);
    REFUSED(make_object(NULL, object_size, &mesh, &params, NULL));
    REFUSED(make_object(memory, object_size, bad[i], &params, NULL));
    REFUSED(make_object(memory, object_size, &mesh, bad[i], NULL));
    REFUSED(hangpose_object_create(memory, object_size, &mesh, &params, NULL, bad[i], &detail));
    REFUSED(make_supporter(NULL, supporter_size, &cloud, &params));
    REFUSED(make_supporter(memory, object_size, bad[i], &params));
    REFUSED(make_supporter(memory, object_size, &cloud, bad[i]));
    REFUSED(hangpose_supporter_create(memory, object_size, &cloud, &params, NULL, bad[i], &detail));
    release(memory, object_size, 0);
    REFUSED(hangpose_supporter_update(bad[i], &cloud, &params, NULL, &detail));
    REFUSED(hangpose_supporter_update(supporter, bad[i], &params, NULL, &detail));
    REFUSED(hangpose_supporter_update(supporter, &cloud, bad[i], NULL, &detail));
    REFUSED(hangpose_object_get_info(bad[i], &object_info, &detail));
    REFUSED(hangpose_object_get_info(object, bad[i], &detail));
    REFUSED(hangpose_object_get_site(bad[i], 0, &object_site, &detail));
    REFUSED(hangpose_object_get_site(object, 0, bad[i], &detail));
    REFUSED(hangpose_object_get_site(object, UINT32_MAX, &object_site, &detail));
    REFUSED(hangpose_object_get_contact(bad[i], 0, &object_contact, &detail));
    REFUSED(hangpose_object_get_contact(object, 0, bad[i], &detail));
    REFUSED(hangpose_object_get_contact(object, UINT32_MAX, &object_contact, &detail));
    REFUSED(hangpose_object_get_symmetry(bad[i], 0, &symmetry, &detail));
    REFUSED(hangpose_object_get_symmetry(object, 0, bad[i], &detail));
    REFUSED(hangpose_object_get_symmetry(object, UINT32_MAX, &symmetry, &detail));
    REFUSED(hangpose_supporter_get_info(bad[i], &supporter_info, &detail));
    REFUSED(hangpose_supporter_get_info(supporter, bad[i], &detail));
    REFUSED(hangpose_supporter_get_site(bad[i], 0, &supporter_site, &detail));
    REFUSED(hangpose_supporter_get_site(supporter, 0, bad[i], &detail));
    REFUSED(hangpose_supporter_get_site(supporter, UINT32_MAX, &supporter_site, &detail));
    REFUSED(hangpose_supporter_get_contact(bad[i], 0, &supporter_contact, &detail));
    REFUSED(hangpose_supporter_get_contact(supporter, 0, bad[i], &detail));
    REFUSED(hangpose_supporter_get_contact(supporter, UINT32_MAX, &supporter_contact, &detail));
    REFUSED(predict(bad[i], supporter, &params));
    REFUSED(predict(object, bad[i], &params));
    REFUSED(predict(object, supporter, bad[i]));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, NULL, predict_size, NULL, &pose, sizeof pose,
                             1, &found, &detail));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, bad[i], sizeof pose,
                             1, &found, &detail));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, &pose, sizeof pose,
                             1, bad[i], &detail));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, &pose, sizeof pose,
                             0, &found, &detail));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, &pose, 1, 1, &found,
                             &detail));
    // An error is returned without a detail too, and an invalid detail is itself refused.
    REFUSED(hangpose_object_create(work, 0, bad[i], bad[i], NULL, bad[i], NULL));
    hangpose_detail small = {.struct_size = 4};
    REFUSED(hangpose_object_get_info(object, &object_info, &small));
    o = object;
    REFUSED(hangpose_object_create(object_memory, object_size, &mesh, &params, NULL, &o, &small));
    CHECK(o == NULL);
    memory = guarded(hangpose_sample_bytes(10), 0);
    REFUSED(
        hangpose_mesh_sample(bad[i], 0, memory, hangpose_sample_bytes(10), *points, *normals, 10, &detail));
    REFUSED(hangpose_mesh_sample(&mesh, 0, memory, hangpose_sample_bytes(10), bad[i], *normals, 10, &detail));
    REFUSED(hangpose_mesh_sample(&mesh, 0, memory, hangpose_sample_bytes(10), *points, bad[i], 10, &detail));
    release(memory, hangpose_sample_bytes(10), 0);
  }
  // A monitor or a detail at an odd address is refused; null means none.
  hangpose_monitor *odd_monitor = bad[1];
  hangpose_detail *odd_detail = bad[1];
  REFUSED(hangpose_object_create(object_memory, 0, &mesh, &params, odd_monitor, &o, &detail));
  REFUSED(hangpose_supporter_create(supporter_memory, 0, &cloud, &params, odd_monitor, &s, &detail));
  REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, odd_monitor, &pose,
                           sizeof pose, 1, &found, &detail));
  REFUSED(hangpose_object_get_info(object, &object_info, odd_detail));
  CHECK(hangpose_object_get_info(object, &object_info, NULL) == HANGPOSE_OK);
  hangpose_monitor_cancel(NULL);
  hangpose_monitor_cancel(odd_monitor);
  CHECK(hangpose_monitor_progress(NULL) == 0.0f && hangpose_monitor_is_cancelled(odd_monitor) == 0);
  CHECK(is_unharmed());
}

static void struct_sizes(void) {
  const uint32_t sizes[] = {0, 1, 4, 1000, UINT32_MAX};
  for (int i = 0; i < 5; ++i) {
    hangpose_mesh m = mesh;
    hangpose_cloud c = cloud;
    hangpose_params p = params;
    hangpose_limits l = limits;
    hangpose_monitor monitor;
    hangpose_prediction found = {.struct_size = sizes[i]};
    hangpose_object_info object_info = {.struct_size = sizes[i]};
    hangpose_supporter_info supporter_info = {.struct_size = sizes[i]};
    hangpose_object_site object_site = {.struct_size = sizes[i]};
    hangpose_supporter_site supporter_site = {.struct_size = sizes[i]};
    hangpose_object_contact object_contact = {.struct_size = sizes[i]};
    hangpose_supporter_contact supporter_contact = {.struct_size = sizes[i]};
    hangpose_symmetry symmetry = {.struct_size = sizes[i]};
    hangpose_pose pose;
    m.struct_size = c.struct_size = p.struct_size = l.struct_size = sizes[i];
    REFUSED(hangpose_params_init(&p, sizes[i], HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION, &detail));
    REFUSED(hangpose_monitor_init(&monitor, sizes[i], 0, &detail));
    REFUSED(make_object(work, 0, &m, &params, NULL));
    REFUSED(make_object(work, 0, &mesh, &p, NULL));
    REFUSED(make_supporter(work, 0, &c, &params));
    REFUSED(hangpose_supporter_update(supporter, &c, &params, NULL, &detail));
    REFUSED(hangpose_limits_of(&params, &m, NULL, &limits, &detail));
    REFUSED(hangpose_limits_of(&params, NULL, &c, &limits, &detail));
    REFUSED(hangpose_limits_of(&params, NULL, NULL, &l, &detail));
    CHECK(hangpose_object_bytes(&l) == 0);
    REFUSED(hangpose_object_get_info(object, &object_info, &detail));
    REFUSED(hangpose_supporter_get_info(supporter, &supporter_info, &detail));
    REFUSED(hangpose_object_get_site(object, 0, &object_site, &detail));
    REFUSED(hangpose_supporter_get_site(supporter, 0, &supporter_site, &detail));
    REFUSED(hangpose_object_get_contact(object, 0, &object_contact, &detail));
    REFUSED(hangpose_supporter_get_contact(supporter, 0, &supporter_contact, &detail));
    REFUSED(hangpose_object_get_symmetry(object, 0, &symmetry, &detail));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, &pose, sizeof pose,
                             1, &found, &detail));
    REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, &pose, sizes[i], 1,
                             &found, &detail));
  }
  CHECK(is_unharmed());
}

static void counts_and_numbers(void) {
  const uint32_t counts[] = {0, UINT32_MAX, UINT32_MAX / 3, 1u << 28, (1u << 28) + 1};
  for (int i = 0; i < 5; ++i) {
    hangpose_mesh m = mesh;
    hangpose_cloud c = cloud;
    m.vertex_count = counts[i];
    REFUSED(make_object(object_memory, 1000, &m, &params, NULL));
    m.vertex_count = RING_VERTICES;
    m.triangle_count = counts[i];
    REFUSED(make_object(object_memory, 1000, &m, &params, NULL));
    c.point_count = counts[i];
    REFUSED(make_supporter(supporter_memory, 1000, &c, &params));
    REFUSED(hangpose_supporter_update(supporter, &c, &params, NULL, &detail));
    REFUSED(hangpose_mesh_sample(&mesh, 0, work, predict_size, *points, *normals, counts[i], &detail));
    hangpose_pose pose;
    hangpose_prediction found = {.struct_size = sizeof found};
    REFUSED(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, &pose, sizeof pose,
                             counts[i], &found, &detail));
    CHECK(hangpose_sample_bytes(counts[i]) > 0);
  }
  const float numbers[] = {NAN, INFINITY, -INFINITY, 1e30f};
  unsigned char *memory = guarded(object_size, 0), *other = guarded(supporter_size, 0);
  for (int i = 0; i < 4; ++i) {
    const float x = vertices[3][1], y = points[5][2], n = normals[7][0];
    const float viewpoint[3] = {0, 0, numbers[i]};
    hangpose_cloud seen = cloud;
    seen.viewpoints = viewpoint;
    seen.viewpoint_count = 1;
    vertices[3][1] = points[5][2] = normals[7][0] = numbers[i];
    REFUSED(make_object(memory, object_size, &mesh, &params, NULL));
    CHECK(detail.index == 3 && strcmp(detail.field, "mesh.vertices") == 0);
    REFUSED(make_supporter(other, supporter_size, &cloud, &params));
    CHECK(detail.index == 5);
    points[5][2] = y;
    REFUSED(hangpose_supporter_update(supporter, &cloud, &params, NULL, &detail));
    CHECK(detail.index == 7);
    vertices[3][1] = x;
    normals[7][0] = n;
    REFUSED(make_supporter(other, supporter_size, &seen, &params));
    CHECK(detail.index == 0 && strcmp(detail.field, "cloud.viewpoints") == 0);
    const float region[6] = {0, 0, numbers[i], 1, 1, 1};
    hangpose_cloud within = cloud;
    within.region = region;
    REFUSED(make_supporter(other, supporter_size, &within, &params));
    CHECK(strcmp(detail.field, "cloud.region") == 0);
  }
  triangles[9][2] = UINT32_MAX;
  REFUSED(make_object(memory, object_size, &mesh, &params, NULL));
  CHECK(detail.index == 9 && detail.maximum == RING_VERTICES - 1);
  release(memory, object_size, 0);
  release(other, supporter_size, 0);
  make_ring(0.03f, vertices, triangles);
  // Every word of the params in turn: a value in its range is accepted, any other is named in the detail.
  const uint32_t words[] = {0xFFFFFFFF, 0x7F800000, 0xFF800000, 0x80000001, 0x4B000000};
  for (size_t at = 1; at < sizeof params / 4; ++at) {
    for (int i = 0; i < 5; ++i) {
      hangpose_params p = params;
      memcpy((char *)&p + 4 * at, &words[i], 4);
      const hangpose_status status = predict(object, supporter, &p);
      CHECK(status >= 0 || (status == HANGPOSE_ERROR_VALUE && strncmp(detail.field, "params.", 7) == 0));
    }
  }
  CHECK(is_unharmed());
}

static void overlaps(void) {
  const size_t size = object_size + 4 * sizeof vertices + sizeof triangles;
  unsigned char *memory = guarded(size, 0), *inside = memory + object_size / 16 * 16;
  hangpose_object *o;
  hangpose_supporter *s;
  hangpose_prediction found = {.struct_size = sizeof found};
  hangpose_pose pose;
  hangpose_mesh m = mesh, *m_inside = (void *)inside;
  hangpose_cloud c = cloud, *c_inside = (void *)inside;
  hangpose_params *p_inside = (void *)inside;
  hangpose_detail *d_inside = (void *)inside;
  hangpose_monitor *w_inside = (void *)inside;
  m.vertices = memcpy(inside, vertices, sizeof vertices);
  CHECK(make_object(memory, size, &m, &params, NULL) == HANGPOSE_ERROR_OVERLAP);
  m.vertices = *vertices;
  m.triangles = memcpy(inside, triangles, sizeof triangles);
  CHECK(make_object(memory, size, &m, &params, NULL) == HANGPOSE_ERROR_OVERLAP);
  c.points = memcpy(inside, points, sizeof points);
  CHECK(make_supporter(memory, size, &c, &params) == HANGPOSE_ERROR_OVERLAP);
  c.points = *points;
  c.normals = (float *)(void *)inside;
  CHECK(make_supporter(memory, size, &c, &params) == HANGPOSE_ERROR_OVERLAP);
  c.normals = *normals;
  c.viewpoints = (float *)(void *)inside;
  c.viewpoint_count = 1;
  CHECK(make_supporter(memory, size, &c, &params) == HANGPOSE_ERROR_OVERLAP);
  c.viewpoint_count = 0;
  c.marks = inside;
  CHECK(make_supporter(memory, size, &c, &params) == HANGPOSE_ERROR_OVERLAP);
  c.marks = NULL;
  c.region = (float *)(void *)inside;
  CHECK(make_supporter(memory, size, &c, &params) == HANGPOSE_ERROR_OVERLAP);
  *m_inside = mesh;
  CHECK(make_object(memory, size, m_inside, &params, NULL) == HANGPOSE_ERROR_OVERLAP);
  *c_inside = cloud;
  CHECK(make_supporter(memory, size, c_inside, &params) == HANGPOSE_ERROR_OVERLAP);
  *p_inside = params;
  CHECK(make_object(memory, size, &mesh, p_inside, NULL) == HANGPOSE_ERROR_OVERLAP);
  CHECK(make_supporter(memory, size, &cloud, p_inside) == HANGPOSE_ERROR_OVERLAP);
  *d_inside = detail;
  CHECK(hangpose_object_create(memory, size, &mesh, &params, NULL, &o, d_inside) == HANGPOSE_ERROR_OVERLAP);
  hangpose_monitor_init(w_inside, sizeof *w_inside, HANGPOSE_NO_WORK_LIMIT, NULL);
  CHECK(make_object(memory, size, &mesh, &params, w_inside) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_object_create(memory, size, &mesh, &params, NULL, (void *)inside, &detail) ==
        HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_supporter_create(memory, size, &cloud, &params, NULL, (void *)inside, NULL) ==
        HANGPOSE_ERROR_OVERLAP);
  (void)s;
  // Memory of the models as output.
  *d_inside = detail;
  CHECK(hangpose_predict(object, supporter, NULL, &params, object_memory, object_size, NULL, &pose,
                         sizeof pose, 1, &found, NULL) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL,
                         (void *)(supporter_memory + 4096), sizeof pose, 1, &found,
                         NULL) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, &pose, sizeof pose,
                         UINT32_MAX / 2, &found, NULL) < 0);
  CHECK(hangpose_predict(object, supporter, NULL, &params, work, predict_size, NULL, (void *)&found,
                         sizeof pose, 1, &found, NULL) == HANGPOSE_ERROR_OVERLAP);
  c = cloud;
  c.points = (float *)(void *)(supporter_memory + 4096);
  CHECK(hangpose_supporter_update(supporter, &c, &params, NULL, &detail) == HANGPOSE_ERROR_OVERLAP);
  REFUSED(hangpose_params_init((void *)&detail, sizeof params, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_ABI_VERSION,
                               &detail));
  CHECK(hangpose_mesh_sample(&mesh, 0, memory, size, *vertices, *normals, 10, &detail) ==
        HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_mesh_sample(&mesh, 0, memory, size, *points, *points, 10, &detail) ==
        HANGPOSE_ERROR_OVERLAP);
  release(memory, size, 0);
  CHECK(is_unharmed());
}

static hangpose_status ask(const hangpose_request *request) {
  hangpose_pose poses[POSES];
  hangpose_prediction found = {.struct_size = sizeof found};
  return hangpose_predict(object, supporter, request, &params, work, predict_size, NULL, poses, sizeof *poses,
                          POSES, &found, &detail);
}

static hangpose_status ask_many(const hangpose_object *const *objects, uint32_t count, hangpose_pose *poses,
                                hangpose_many *many) {
  return hangpose_predict_many(objects, count, supporter, NULL, &params, work, predict_size, NULL, poses,
                               sizeof *poses, many, &detail);
}

static void many_at_once(void) {
  static hangpose_pose poses[HANGPOSE_MAX_HUNG + 1];
  static unsigned char odd[64];
  const hangpose_object *const two[2] = {object, object}, *const gap[2] = {object, NULL};
  const hangpose_object *const other[2] = {object, (void *)supporter};
  hangpose_many many = {.struct_size = sizeof many};
  CHECK(ask_many(two, 2, poses, &many) == HANGPOSE_OK && many.placed >= 1 && poses[0].has_pose == 1);
  REFUSED(ask_many(two, 0, poses, &many));
  REFUSED(ask_many(two, HANGPOSE_MAX_HUNG + 1, poses, &many));
  REFUSED(ask_many(two, UINT32_MAX, poses, &many));
  CHECK(ask_many(gap, 2, poses, &many) == HANGPOSE_ERROR_NULL && detail.index == 1);
  CHECK(ask_many(other, 2, poses, &many) == HANGPOSE_ERROR_HANDLE && detail.index == 1);
  for (int i = 0; i < 2; ++i) {
    void *const bad = i == 0 ? NULL : odd + 1;
    REFUSED(ask_many(bad, 2, poses, &many));
    REFUSED(ask_many(two, 2, bad, &many));
    REFUSED(ask_many(two, 2, poses, bad));
  }
  REFUSED(ask_many(two, 2, (void *)work, &many));
  REFUSED(ask_many(two, 2, (void *)&many, &many));
  memcpy(poses, two, sizeof two);
  CHECK(ask_many((void *)poses, 2, poses, &many) == HANGPOSE_ERROR_OVERLAP);
  CHECK(ask_many(two, 2, (void *)object, &many) == HANGPOSE_ERROR_OVERLAP);
  CHECK(strcmp(detail.field, "poses") == 0);
  many.struct_size = 1;
  REFUSED(ask_many(two, 2, poses, &many));
  CHECK(is_unharmed());
}

static void requests(void) {
  static const uint32_t indices[2] = {0, UINT32_MAX};
  static unsigned char odd[sizeof(hangpose_request) + 8];
  const uint32_t sizes[] = {0, 1, 4, 1000, UINT32_MAX};
  const uint32_t words[] = {0xFFFFFFFF, 0x7F800000, 0xFF800000, 0x80000001, 0x4B000000};
  hangpose_request good, r;
  CHECK(hangpose_request_init(&good, sizeof good, &detail) == HANGPOSE_OK);
  REFUSED(hangpose_request_init(NULL, sizeof good, &detail));
  REFUSED(hangpose_request_init((void *)(odd + 1), sizeof good, &detail));
  REFUSED(hangpose_request_init((void *)&detail, sizeof good, &detail));
  REFUSED(ask((void *)(odd + 1)));
  CHECK(ask(&good) == HANGPOSE_OK);
  for (int i = 0; i < 5; ++i) {
    REFUSED(hangpose_request_init(&r, sizes[i], &detail));
    r = good;
    r.struct_size = sizes[i];
    REFUSED(ask(&r));
  }
  // Every word before the pointers in turn: a value in its range is accepted, any other is named in the
  // detail.
  good.has_approach = 1;
  good.approach_direction[2] = -1;
  good.on.shape = HANGPOSE_REGION_BOX;
  for (size_t at = 1; at < (offsetof(hangpose_request, on) + offsetof(hangpose_region, points)) / 4; ++at) {
    for (int i = 0; i < 5; ++i) {
      r = good;
      memcpy((char *)&r + 4 * at, &words[i], 4);
      CHECK(ask(&r) >= 0 || strncmp(detail.field, "request.", 8) == 0);
    }
  }
  good.has_approach = 0;
  good.on = (hangpose_region){.shape = HANGPOSE_REGION_TRIANGLES,
                              .radius = 0.01f,
                              .points = *vertices,
                              .point_count = RING_VERTICES,
                              .triangles = *triangles,
                              .triangle_count = RING_TRIANGLES,
                              .indices = indices,
                              .index_count = 1};
  CHECK(ask(&good) >= 0);
  for (int i = 0; i < 2; ++i) {
    const void *const bad = i == 0 ? NULL : odd + 1;
    r = good, r.on.points = bad;
    REFUSED(ask(&r));
    r = good, r.on.triangles = bad;
    REFUSED(ask(&r));
    r = good, r.on.indices = bad;
    REFUSED(ask(&r));
    r = good, r.by = good.on, r.by.points = bad;
    REFUSED(ask(&r));
    r = good, r.scene_points = bad, r.scene_point_count = 1;
    REFUSED(ask(&r));
    r = good, r.hung = bad, r.hung_count = 1;
    REFUSED(ask(&r));
    r.hung_count = UINT32_MAX;
    REFUSED(ask(&r));
  }
  r = good, r.on.index_count = 2;
  CHECK(ask(&r) == HANGPOSE_ERROR_INDEX && detail.index == 1 && detail.value == UINT32_MAX);
  // What hangs already, and memory of the call as input.
  hangpose_hung hung = {.object = object, .position = {0, 0, 1}, .quaternion = {0, 0, 0, 1}};
  hangpose_request_init(&good, sizeof good, NULL);
  good.hung = &hung;
  good.hung_count = 1;
  CHECK(ask(&good) == HANGPOSE_OK);
  hung.object = (void *)supporter;
  CHECK(ask(&good) == HANGPOSE_ERROR_HANDLE && detail.index == 0);
  hung.object = NULL;
  CHECK(ask(&good) == HANGPOSE_ERROR_NULL);
  good.hung_count = 0;
  unsigned char *before = work;
  work = guarded(predict_size, 0);
  good.scene_points = (float *)(void *)work;
  good.scene_point_count = 1;
  CHECK(ask(&good) == HANGPOSE_ERROR_OVERLAP);
  good.scene_points = NULL, good.scene_point_count = 0, good.by.points = (float *)(void *)work;
  good.by.point_count = 1;
  CHECK(ask(&good) == HANGPOSE_ERROR_OVERLAP);
  good.by.points = NULL, good.hung = (void *)work, good.hung_count = 1;
  memcpy(work, &(hangpose_hung){object, {0, 0, 1}, {0, 0, 0, 1}}, sizeof hung);
  CHECK(ask(&good) == HANGPOSE_ERROR_OVERLAP);
  hangpose_request *inside = (void *)work;
  hangpose_request_init(inside, sizeof *inside, NULL);
  CHECK(ask(inside) == HANGPOSE_ERROR_OVERLAP);
  release(work, predict_size, 0);
  work = before;
  CHECK(hangpose_kind_string(UINT32_MAX) != NULL);
  CHECK(is_unharmed());
}

// Planning: the callback, and every argument that is new in these calls.
enum { WAYPOINTS = 300 };
static unsigned char *plan_work;
static size_t plan_size;
static hangpose_waypoint waypoints[WAYPOINTS];
static hangpose_plan_failure reasons[POSES];

static int32_t refuse(void *context, const float *position, const float *quaternion) {
  CHECK(position[0] == position[0] && quaternion[3] == quaternion[3]);
  ++*(int *)context;
  return 0;
}
static int32_t cancel(void *context, const float *position, const float *quaternion) {
  (void)position, (void)quaternion;
  hangpose_monitor_cancel(context);
  return 1;
}
// Changes the supporter from within the call that uses it, and asks the library for something else.
static int32_t meddle(void *context, const float *position, const float *quaternion) {
  (void)context, (void)position, (void)quaternion;
  hangpose_detail said = {.struct_size = sizeof said};
  CHECK(hangpose_supporter_update(supporter, &cloud, &params, NULL, &said) == HANGPOSE_ERROR_BUSY);
  CHECK(is_unharmed());
  return 1;
}

static hangpose_status plan_with(const hangpose_motion *motion, const hangpose_pose *goal,
                                 hangpose_monitor *watch, hangpose_plan *plan) {
  return hangpose_plan_path(object, supporter, NULL, &params, motion, goal, plan_work, plan_size, watch,
                            waypoints, sizeof *waypoints, WAYPOINTS, plan, &detail);
}
static hangpose_status reach(const hangpose_motion *motion, hangpose_plan_failure *failures,
                             uint32_t capacity, hangpose_plan *plan) {
  hangpose_pose poses[POSES];
  hangpose_prediction found = {.struct_size = sizeof found};
  return hangpose_predict_reachable(object, supporter, NULL, &params, motion, plan_work, plan_size, NULL,
                                    poses, sizeof *poses, POSES, failures, sizeof *failures, waypoints,
                                    sizeof *waypoints, capacity, &found, plan, &detail);
}

static void planning(void) {
  static unsigned char odd[sizeof(hangpose_motion) + 8];
  const uint32_t sizes[] = {0, 1, 4, 1000, UINT32_MAX};
  const uint32_t words[] = {0xFFFFFFFF, 0x7F800000, 0xFF800000, 0x80000001, 0x4B000000};
  hangpose_plan plan = {.struct_size = sizeof plan};
  hangpose_motion good, m;
  hangpose_pose goal = right[0];
  hangpose_monitor watch;
  CHECK(hangpose_motion_init(&good, sizeof good, &detail) == HANGPOSE_OK);
  good.nodes = 64;
  limits.nodes = good.nodes;
  limits.waypoints = WAYPOINTS;
  CHECK(HANGPOSE_PLAN_BYTES(POINTS, 0, 64, WAYPOINTS) >= hangpose_plan_bytes(&limits));
  CHECK(HANGPOSE_REACHABLE_BYTES(POINTS, POSES, 0, 64, WAYPOINTS) >= hangpose_reachable_bytes(&limits));
  // The needed memory at any address, and a byte less.
  for (size_t offset = 0; offset < 5; ++offset) {
    plan_size = hangpose_reachable_bytes(&limits);
    plan_work = guarded(plan_size, offset);
    CHECK(reach(&good, reasons, WAYPOINTS, &plan) >= 0);
    --plan_size;
    CHECK(reach(&good, reasons, WAYPOINTS, &plan) == HANGPOSE_ERROR_MEMORY);
    release(plan_work, plan_size + 1, offset);
    plan_size = hangpose_plan_bytes(&limits);
    plan_work = guarded(plan_size, offset);
    CHECK(plan_with(&good, &goal, NULL, &plan) >= 0);
    --plan_size;
    CHECK(plan_with(&good, &goal, NULL, &plan) == HANGPOSE_ERROR_MEMORY);
    release(plan_work, plan_size + 1, offset);
  }
  plan_size = hangpose_reachable_bytes(&limits);
  plan_work = guarded(plan_size, 0);
  CHECK(reach(&good, reasons, WAYPOINTS, &plan) == HANGPOSE_OK && plan.has_path == 1);
  CHECK(plan.waypoint_count >= 2 && reasons[plan.pose_index].reason == HANGPOSE_PLAN_FOUND);
  CHECK(reach(NULL, NULL, WAYPOINTS, &plan) == HANGPOSE_ERROR_MEMORY);  // the default has more nodes
  CHECK(reach(&good, NULL, 1, &plan) == HANGPOSE_ERROR_CAPACITY && detail.minimum > 1);
  // Callbacks.
  int asked = 0;
  m = good, m.accepts = refuse, m.context = &asked;
  CHECK(plan_with(&m, &goal, NULL, &plan) == HANGPOSE_NO_PATH && asked == 1 && plan.asked == 1);
  CHECK(plan.failure.reason == HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE && plan.has_path == 0);
  CHECK(reach(&m, reasons, WAYPOINTS, &plan) == HANGPOSE_NO_PATH);
  hangpose_monitor_init(&watch, sizeof watch, HANGPOSE_NO_WORK_LIMIT, NULL);
  m.accepts = cancel, m.context = &watch;
  CHECK(plan_with(&m, &goal, &watch, &plan) == HANGPOSE_CANCELLED);
  CHECK(plan.failure.reason == HANGPOSE_PLAN_STOPPED && plan.failure.stopped == HANGPOSE_CANCELLED);
  m.accepts = meddle, m.context = NULL;
  CHECK(plan_with(&m, &goal, NULL, &plan) == HANGPOSE_OK);
  // Null and misaligned.
  for (int i = 0; i < 2; ++i) {
    void *const bad = i == 0 ? NULL : odd + 1;
    REFUSED(hangpose_motion_init(bad, sizeof m, &detail));
    CHECK(hangpose_plan_bytes(bad) == 0 && hangpose_reachable_bytes(bad) == 0);
    REFUSED(plan_with(&good, bad, NULL, &plan));
    REFUSED(plan_with(&good, &goal, NULL, bad));
    REFUSED(reach(&good, NULL, WAYPOINTS, bad));
    REFUSED(hangpose_plan_path(object, supporter, NULL, &params, &good, &goal, plan_work, plan_size, NULL,
                               bad, sizeof *waypoints, WAYPOINTS, &plan, &detail));
    REFUSED(hangpose_plan_path(bad, supporter, NULL, &params, &good, &goal, plan_work, plan_size, NULL,
                               waypoints, sizeof *waypoints, WAYPOINTS, &plan, &detail));
    REFUSED(hangpose_plan_path(object, bad, NULL, &params, &good, &goal, plan_work, plan_size, NULL,
                               waypoints, sizeof *waypoints, WAYPOINTS, &plan, &detail));
    REFUSED(hangpose_plan_path(object, supporter, NULL, bad, &good, &goal, plan_work, plan_size, NULL,
                               waypoints, sizeof *waypoints, WAYPOINTS, &plan, &detail));
    m = good, m.part_count = 1, m.parts = bad;
    REFUSED(plan_with(&m, &goal, NULL, &plan));
    m.part_count = UINT32_MAX;
    REFUSED(plan_with(&m, &goal, NULL, &plan));
  }
  REFUSED(plan_with((void *)(odd + 1), &goal, NULL, &plan));
  REFUSED(reach(&good, (void *)(odd + 1), WAYPOINTS, &plan));
  REFUSED(hangpose_plan_path(object, supporter, NULL, &params, &good, &goal, NULL, plan_size, NULL, waypoints,
                             sizeof *waypoints, WAYPOINTS, &plan, &detail));
  // Sizes of structs.
  for (int i = 0; i < 5; ++i) {
    REFUSED(hangpose_motion_init(&m, sizes[i], &detail));
    m = good, m.struct_size = sizes[i];
    REFUSED(plan_with(&m, &goal, NULL, &plan));
    plan.struct_size = sizes[i];
    REFUSED(plan_with(&good, &goal, NULL, &plan));
    plan.struct_size = sizeof plan;
    goal.struct_size = sizes[i];
    REFUSED(plan_with(&good, &goal, NULL, &plan));
    goal = right[0];
    REFUSED(hangpose_plan_path(object, supporter, NULL, &params, &good, &goal, plan_work, plan_size, NULL,
                               waypoints, sizes[i], WAYPOINTS, &plan, &detail));
  }
  // Every word before the pointers in turn: a value in its range is accepted, any other is named in the
  // detail. The budget is small, so that each search is short.
  good.samples = 20;
  good.has_start = good.has_workspace = 1;
  good.start_position[1] = -0.3f;
  for (size_t i = 0; i < 3; ++i) good.workspace_low[i] = -1, good.workspace_high[i] = 1;
  for (size_t at = 1; at < offsetof(hangpose_motion, parts) / 4; ++at) {
    for (int i = 0; i < 5; ++i) {
      m = good;
      memcpy((char *)&m + 4 * at, &words[i], 4);
      // More nodes than there is memory for are named as memory.
      const hangpose_status status = plan_with(&m, &goal, NULL, &plan);
      CHECK(status >= 0 || status == HANGPOSE_ERROR_MEMORY || strncmp(detail.field, "motion.", 7) == 0 ||
            status == HANGPOSE_ERROR_CAPACITY);
    }
  }
  for (size_t at = 1; at < offsetof(hangpose_pose, contacts) / 4; ++at) {
    for (int i = 0; i < 5; ++i) {
      goal = right[0];
      memcpy((char *)&goal + 4 * at, &words[i], 4);
      CHECK(plan_with(&good, &goal, NULL, &plan) >= 0 || strncmp(detail.field, "goal.", 5) == 0);
    }
  }
  goal = right[0];
  // Overlaps: what is written, and what is read.
  CHECK(hangpose_plan_path(object, supporter, NULL, &params, &good, &goal, plan_work, plan_size, NULL,
                           (void *)plan_work, sizeof *waypoints, 10, &plan,
                           &detail) == HANGPOSE_ERROR_OVERLAP);
  CHECK(plan_with(&good, &goal, NULL, (void *)plan_work) == HANGPOSE_ERROR_OVERLAP);
  CHECK(plan_with(memcpy(plan_work, &good, sizeof good), &goal, NULL, &plan) == HANGPOSE_ERROR_OVERLAP);
  CHECK(plan_with(&good, memcpy(plan_work, &goal, sizeof goal), NULL, &plan) == HANGPOSE_ERROR_OVERLAP);
  CHECK(reach(&good, (void *)plan_work, WAYPOINTS, &plan) == HANGPOSE_ERROR_OVERLAP);
  CHECK(reach(&good, (void *)object, WAYPOINTS, &plan) == HANGPOSE_ERROR_OVERLAP);
  m = good, m.part_count = 1, m.parts = (void *)plan_work;
  CHECK(plan_with(&m, &goal, NULL, &plan) == HANGPOSE_ERROR_OVERLAP);
  CHECK(hangpose_plan_reason_string(UINT32_MAX) != NULL);
  release(plan_work, plan_size, 0);
  CHECK(is_unharmed());
}

static void handles(void) {
  unsigned char *memory = guarded(object_size, 0);
  hangpose_monitor monitor;
  memset(&monitor, 0x5A, sizeof monitor);
  CHECK(predict((void *)memory, supporter, &params) == HANGPOSE_ERROR_HANDLE);
  memset(memory, 0, object_size);
  CHECK(predict((void *)memory, supporter, &params) == HANGPOSE_ERROR_HANDLE);
  CHECK(predict(object, (void *)memory, &params) == HANGPOSE_ERROR_HANDLE);
  CHECK(predict((void *)supporter, supporter, &params) == HANGPOSE_ERROR_HANDLE);
  CHECK(predict(object, (void *)object, &params) == HANGPOSE_ERROR_HANDLE);
  // A copy of a handle is refused.
  memcpy(memory, object, 256);
  CHECK(predict((void *)memory, supporter, &params) == HANGPOSE_ERROR_HANDLE);
  CHECK(hangpose_supporter_update((void *)memory, &cloud, &params, NULL, &detail) == HANGPOSE_ERROR_HANDLE);
  CHECK(make_object(memory, object_size, &mesh, &params, &monitor) == HANGPOSE_ERROR_HANDLE);
  CHECK(hangpose_monitor_progress(&monitor) == 0.0f && hangpose_monitor_is_cancelled(&monitor) == 0);
  // A model whose memory was reused is refused, even if the new analysis was cancelled.
  hangpose_object *made;
  CHECK(hangpose_object_create(memory, object_size, &mesh, &params, NULL, &made, &detail) == HANGPOSE_OK);
  CHECK(predict(made, supporter, &params) == HANGPOSE_OK);
  hangpose_object *before = made;
  hangpose_monitor_init(&monitor, sizeof monitor, HANGPOSE_NO_WORK_LIMIT, NULL);
  hangpose_monitor_cancel(&monitor);
  CHECK(make_object(memory, object_size, &mesh, &params, &monitor) == HANGPOSE_CANCELLED);
  CHECK(predict(before, supporter, &params) == HANGPOSE_ERROR_HANDLE);
  // A work limit is not an error.
  for (uint64_t limit = 0; limit < 100000; limit = 10 * limit + 1) {
    hangpose_monitor_init(&monitor, sizeof monitor, limit, NULL);
    CHECK(make_object(memory, object_size, &mesh, &params, &monitor) >= 0);
  }
  release(memory, object_size, 0);
  CHECK(is_unharmed());
}

// Models that were analysed with params other than those of the prediction.
static void other_params(void) {
  hangpose_params paper = params;
  paper.candidates = HANGPOSE_CANDIDATES_SITES;
  paper.settle = 0;
  paper.voxels = 0;
  paper.object_directions = 10;
  unsigned char *memory = guarded(object_size, 0), *other = guarded(supporter_size, 0);
  hangpose_object *o;
  hangpose_supporter *s;
  CHECK(hangpose_object_create(memory, object_size, &mesh, &paper, NULL, &o, &detail) == HANGPOSE_OK);
  CHECK(hangpose_supporter_create(other, supporter_size, &cloud, &paper, NULL, &s, &detail) == HANGPOSE_OK);
  CHECK(predict(o, s, &paper) >= 0);
  CHECK(predict(o, supporter, &params) == HANGPOSE_ERROR_NO_DISTANCE_FIELD);
  CHECK(predict(o, supporter, &paper) >= 0);
  CHECK(predict(object, s, &params) >= 0);
  CHECK(predict(object, s, &paper) >= 0);
  paper.settle = 1;
  paper.voxels = VOXELS;
  CHECK(predict(object, s, &paper) >= 0);
  CHECK(predict(o, s, &paper) == HANGPOSE_ERROR_NO_DISTANCE_FIELD);
  release(memory, object_size, 0);
  release(other, supporter_size, 0);
  CHECK(is_unharmed());
}

static void updates(void) {
  hangpose_monitor monitor;
  hangpose_cloud more = cloud;
  more.point_count = POINTS + 1;
  CHECK(hangpose_supporter_update(supporter, &more, &params, NULL, &detail) == HANGPOSE_ERROR_MEMORY);
  CHECK(is_unharmed());
  hangpose_monitor_init(&monitor, sizeof monitor, HANGPOSE_NO_WORK_LIMIT, NULL);
  hangpose_monitor_cancel(&monitor);
  CHECK(hangpose_supporter_update(supporter, &cloud, &params, &monitor, &detail) == HANGPOSE_CANCELLED);
  CHECK(predict(object, supporter, &params) == HANGPOSE_ERROR_EMPTY);
  more.point_count = POINTS / 2;
  CHECK(hangpose_supporter_update(supporter, &more, &params, NULL, &detail) == HANGPOSE_OK);
  CHECK(predict(object, supporter, &params) >= 0);
  CHECK(hangpose_supporter_update(supporter, &cloud, &params, NULL, &detail) == HANGPOSE_OK);
  CHECK(is_unharmed());
}

// Two threads predict with the same models while a third updates one of them and reads the progress.
static hangpose_monitor shared;
static void *predict_again_and_again(void *tally) {
  unsigned char *mine = guarded(predict_size, 3);
  for (int i = 0; i < 20; ++i) {
    hangpose_pose poses[POSES];
    hangpose_prediction found = {.struct_size = sizeof found};
    hangpose_detail said = {.struct_size = sizeof said};
    const hangpose_status status = hangpose_predict(object, supporter, NULL, &params, mine, predict_size,
                                                    &shared, poses, sizeof *poses, POSES, &found, &said);
    nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);  // leaves time for an update
    if (status == HANGPOSE_OK) ++((int *)tally)[0];
    if (status == HANGPOSE_OK && memcmp(poses, right, right_count * sizeof *poses) != 0) ++((int *)tally)[1];
    if (status != HANGPOSE_OK && status != HANGPOSE_ERROR_BUSY) ++((int *)tally)[1];
  }
  free(mine - GUARD - 3);
  return NULL;
}
static void threads(void) {
  pthread_t both[2];
  int tallies[2][2] = {{0, 0}, {0, 0}}, updated = 0;
  hangpose_monitor_init(&shared, sizeof shared, HANGPOSE_NO_WORK_LIMIT, NULL);
  for (int i = 0; i < 2; ++i) pthread_create(&both[i], NULL, predict_again_and_again, tallies[i]);
  for (int i = 0; i < 200; ++i) {
    const float progress = hangpose_monitor_progress(&shared);
    CHECK(progress >= 0.0f && progress <= 1.0f);
    const hangpose_status status = hangpose_supporter_update(supporter, &cloud, &params, NULL, &detail);
    CHECK(status == HANGPOSE_OK || status == HANGPOSE_ERROR_BUSY);
    updated += status == HANGPOSE_OK;
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
  }
  for (int i = 0; i < 2; ++i) pthread_join(both[i], NULL);
  CHECK(tallies[0][1] == 0 && tallies[1][1] == 0);
  printf("two threads: %d predictions and %d updates succeeded\n", tallies[0][0] + tallies[1][0], updated);
  CHECK(is_unharmed());
}

int main(void) {
  set_up();
  sizes_and_alignment();
  null_and_misaligned();
  struct_sizes();
  counts_and_numbers();
  overlaps();
  requests();
  many_at_once();
  planning();
  handles();
  other_params();
  updates();
  threads();
  depth_images();
  CHECK(hangpose_status_string(INT32_MIN) != NULL && hangpose_stage_string(UINT32_MAX) != NULL);
  CHECK(hangpose_check_abi(0) == HANGPOSE_ERROR_ABI_VERSION &&
        hangpose_check_abi(hangpose_abi_version()) == HANGPOSE_OK);

  tear_down();
  printf("%d checks, %d failed\n", checks, failures);
  return failures != 0;
}
