# Links programs that use every function of include/hangpose.h, for x86-64 and for a Cortex-M7; sourced by no_panic.sh
# and stack.sh. Needs $root.

source "$root/embedded/library.sh"

# Writes x86-64 and cortex-m7 to a folder. FLAGS are further options of rustc.
#   link_every FOLDER [FLAGS]
link_every() {
    local folder=$1 flags=${2:-} functions
    mkdir -p "$folder"
    functions=$(gcc -E -P "$root/include/hangpose.h" | grep -oE '\bhangpose_[a-z_0-9]+\(' | tr -d '(' | sort -u)
    {
        echo '#include <hangpose.h>'
        echo 'void *const volatile every_function[] = {'
        printf '    (void *)&%s,\n' $functions
        echo '};'
        echo 'int main(void) { return every_function[0] == 0; }'
    } >"$folder/every.c"
    gcc -O2 -I"$root/include" "$folder/every.c" -static -Wl,--gc-sections -Wl,--emit-relocs \
        "$(library x86_64-unknown-linux-gnu "$flags")" -o "$folder/x86-64"
    for_cortex_m7 "$folder/every.c" -Wl,--emit-relocs "$(library thumbv7em-none-eabihf "$flags")" -o "$folder/cortex-m7"
}
