# Links programs that use every function of include/hangpose.h, for x86-64 and for a Cortex-M7; sourced by no_panic.sh
# and stack.sh. Needs $root. Sets $every_x86_64 and $every_m7.

source "$root/embedded/library.sh"
every=$root/build/embedded/every
mkdir -p "$every"
functions=$(gcc -E -P "$root/include/hangpose.h" | grep -oE '\bhangpose_[a-z_0-9]+\(' | tr -d '(' | sort -u)
{
    echo '#include <hangpose.h>'
    echo 'void *const volatile every_function[] = {'
    printf '    (void *)&%s,\n' $functions
    echo '};'
    echo 'int main(void) { return every_function[0] == 0; }'
} >"$every/every.c"
every_x86_64=$every/x86-64 every_m7=$every/cortex-m7
gcc -O2 -I"$root/include" "$every/every.c" -static -Wl,--gc-sections -Wl,--emit-relocs "$(library x86_64-unknown-linux-gnu)" \
    -o "$every_x86_64"
for_cortex_m7 "$every/every.c" -Wl,--emit-relocs "$(library thumbv7em-none-eabihf)" -o "$every_m7"
