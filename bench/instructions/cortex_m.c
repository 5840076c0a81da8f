// Start of a program on qemu's mps2-an500, a Cortex-M7: the vectors, the FPU and the memory, then main with files and
// console by semihosting.
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

extern char stack_top[], data_start[], data_end[], data_image[], bss_start[], bss_end[];
int main(int argc, char **argv);
void initialise_monitor_handles(void);

void reset(void) {
  *(volatile uint32_t *)0xE000ED88 |= 0xFu << 20;  // CPACR: full access to the FPU
  __asm volatile("dsb\n\tisb");
  memcpy(data_start, data_image, (size_t)(data_end - data_start));
  memset(bss_start, 0, (size_t)(bss_end - bss_start));
  initialise_monitor_handles();
  exit(main(0, NULL));
}

static void fault(void) { abort(); }

__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    stack_top, reset, fault, fault, fault, fault, fault, 0, 0, 0, 0, fault, fault, 0, fault, fault};

// newlib calls these for C++ and for files of the system; there is nothing to do.
void _init(void) {}
void _fini(void) {}
