// Plugin for qemu's user mode: prints how many instructions ran before each mark, which is a call of prctl with MARK as its
// first argument. The kernel refuses that call, so that it has no effect. Declares the part of qemu's interface for plugins,
// version 1, that it uses, since Debian has no package with the header.
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "mark.h"

struct qemu_plugin_tb;
typedef struct {
  const char *target_name;
} qemu_info_t;
typedef void (*on_translate)(uint64_t id, struct qemu_plugin_tb *block);
typedef void (*on_run)(unsigned cpu, void *data);
typedef void (*on_call)(uint64_t id, unsigned cpu, int64_t number, uint64_t, uint64_t, uint64_t, uint64_t, uint64_t,
                        uint64_t, uint64_t, uint64_t);
void qemu_plugin_register_vcpu_tb_trans_cb(uint64_t id, on_translate call);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *block, on_run call, int flags, void *data);
void qemu_plugin_register_vcpu_syscall_cb(uint64_t id, on_call call);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

static uint64_t count;
static int64_t prctl_number;

static void run(unsigned cpu, void *instructions) {
  (void)cpu;
  count += (uintptr_t)instructions;
}

static void translate(uint64_t id, struct qemu_plugin_tb *block) {
  (void)id;
  qemu_plugin_register_vcpu_tb_exec_cb(block, run, 0, (void *)(uintptr_t)qemu_plugin_tb_n_insns(block));
}

static void call(uint64_t id, unsigned cpu, int64_t number, uint64_t first, uint64_t second, uint64_t a3, uint64_t a4,
                 uint64_t a5, uint64_t a6, uint64_t a7, uint64_t a8) {
  (void)id, (void)cpu, (void)a3, (void)a4, (void)a5, (void)a6, (void)a7, (void)a8;
  if (number == prctl_number && first == MARK) fprintf(stderr, "mark %" PRIu64 " %" PRIu64 "\n", second, count);
}

__attribute__((visibility("default"))) int qemu_plugin_install(uint64_t id, const qemu_info_t *info, int argc, char **argv) {
  (void)argc, (void)argv;
  prctl_number = strcmp(info->target_name, "x86_64") == 0 ? 157 : 167;
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_vcpu_syscall_cb(id, call);
  return 0;
}
