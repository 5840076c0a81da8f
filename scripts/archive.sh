# Checks of the symbols of an archive; sourced by embedded/test.sh and link.sh.

forbidden=(
    # Rust's allocator: the functions that code calls, their implementations, and the crate under either mangling.
    '__rust_(alloc|dealloc|realloc|alloc_zeroed|no_alloc_shim.*|alloc_error_handler.*)' '__rg_.*' '__rdl_.*'
    '_ZN5alloc.*' '_R.*_5alloc.*'
    # The allocators of C and C++.
    '(m|c|re|vm|aligned_|posix_mem)?alloc' 'valloc' 'memalign' 'posix_memalign' 'free' '_?sbrk' '_Zn[wa].*' '_Zd[la].*'
    # Unwinding.
    '_Unwind_.*' 'rust_eh_personality' '__gxx_personality.*' '__aeabi_unwind_cpp_pr.*' '__cxa_.*'
)

# Prints the section index and the name of every symbol. Uses readelf, because nm with a plugin for LLVM bitcode skips
# objects that contain bitcode.
symbol_table() {
    readelf --syms --wide "$1" | awk '$5 ~ /GLOBAL|WEAK|LOCAL/ && $8 != "" { print $7, $8 }'
}

# Prints the undefined symbols of a symbol table.
undefined_symbols() {
    comm -23 <(awk '$1 == "UND" { print $2 }' <<<"$1" | sort -u) <(awk '$1 != "UND" { print $2 }' <<<"$1" | sort -u)
}

# Fails and prints the symbols found if any is forbidden.
check_forbidden() {
    local label=$1 symbols=$2 bad=0 pattern found
    for pattern in "${forbidden[@]}"; do
        if found=$(grep -Ex "$pattern" <<<"$symbols"); then
            echo "$label: forbidden symbol:" $found >&2
            bad=1
        fi
    done
    return $bad
}
