#!/usr/bin/env bash
# Tests that nothing in the C library recurses without a known end, and that no call takes more than 32 KiB of the
# stack of a Cortex-M7 and 48 KiB of that of x86-64: from the frames that the compiler reports and the calls in the linked program.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/embedded/every.sh"
link_every "$root/build/embedded/every"
"$root/embedded/stack.py" $((32 * 1024)) "$root/build/embedded/every/cortex-m7" arm-none-eabi-objdump 0
"$root/embedded/stack.py" $((48 * 1024)) "$root/build/embedded/every/x86-64" objdump 8
