// Start of a program on qemu's mps2-an500, a Cortex-M7: the vectors, the FPU and the memory, then main with files and
// console by semihosting.
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

extern char stack_top[], data_start[], data_end[], data_image[], bss_start[], bss_end[], heap_start[], heap_end[];
int main(int argc, char **argv);
void initialise_monitor_handles(void);

// What the stack is painted with, so that the deepest word that was written shows.
#define PAINT 0x5ac3e17bu

void reset(void) {
  *(volatile uint32_t *)0xE000ED88 |= 0xFu << 20;  // CPACR: full access to the FPU
  __asm volatile("dsb\n\tisb");
  memcpy(data_start, data_image, (size_t)(data_end - data_start));
  memset(bss_start, 0, (size_t)(bss_end - bss_start));
  // Up to the frame of this function.
  const uint32_t *here = __builtin_frame_address(0);
  for (volatile uint32_t *word = (uint32_t *)heap_end; word < here - 32; ++word) *word = PAINT;
  initialise_monitor_handles();
  exit(main(0, NULL));
}

// Bytes of the stack that were used so far, at most.
size_t stack_used(void) {
  const uint32_t *word = (const uint32_t *)heap_end;
  while (*word == PAINT) ++word;
  return (size_t)(stack_top - (const char *)word);
}

// The heap of newlib's files; the library has none.
void *_sbrk(ptrdiff_t size) {
  static char *next = heap_start;
  if (size > heap_end - next) return errno = ENOMEM, (void *)-1;
  next += size;
  return next - size;
}

static void fault(void) { abort(); }

__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    stack_top, reset, fault, fault, fault, fault, fault, 0, 0, 0, 0, fault, fault, 0, fault, fault};

// newlib calls these for C++ and for files of the system; there is nothing to do.
void _init(void) {}
void _fini(void) {}
