#!/usr/bin/env bash
# Compares the binary interface of include/hangpose.h and of the shared library LIBRARY with the one stored in ffi/abi/.
# Fails if a program that was built against the stored one would break although HANGPOSE_ABI_VERSION is the same.
# With --write it stores the interface instead: `make abi`. docs/VERSIONS.md says what the interface promises.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
fail() { printf 'abi: %s\n' "$@" >&2; exit 1; }

write=
if [ "${1:-}" = --write ]; then write=yes; shift; fi
library=${1:-$root/build/link/libhangpose.so}
header=${HANGPOSE_HEADER:-$root/include/hangpose.h}
[ -e "$library" ] || fail "$library is missing: run make lib"

# ---- the interface of the header: a library of its functions without content has the types and the debug information
# that the real library, which is built in Rust and stripped, has not
gcc -E -P -x c "$header" >"$here/plain.c"
# Each declaration is a record; structs have more ; inside of braces.
awk -v RS=';' '
    { depth += gsub(/{/, "{"); depth -= gsub(/}/, "}") }
    depth == 0 && !/typedef/ && !/}/ && match($0, /hangpose_[a-z0-9_]+\(/) { print $0 " { __builtin_trap(); }" }
' "$here/plain.c" >"$here/functions.c"
{ echo '#include "hangpose.h"'; cat "$here/functions.c"; } >"$here/interface.c"
cp "$header" "$here/hangpose.h"
(cd "$here" && gcc -g -O0 -shared -fPIC -w -Wl,-soname,libhangpose.so -o libinterface.so interface.c)

# ---- the library exports what the header declares
symbols() { readelf --dyn-syms --wide "$1" | awk '$5 == "GLOBAL" && $7 != "UND" && $8 ~ /^hangpose_/ { print $8 }' | sort; }
symbols "$library" >"$here/exported"
symbols "$here/libinterface.so" >"$here/declared"
diff "$here/declared" "$here/exported" >"$here/difference" ||
    fail "the header declares (<) and the library exports (>) different functions:" "$(cat "$here/difference")"

# ---- the constants of the header, of which a program has a copy
sed -n 's/^#define \(HANGPOSE_[A-Z0-9_]*\) [^ ].*/\1/p' "$header" | sort >"$here/names"
{
    printf '#include "hangpose.h"\n#include <stdio.h>\nint main(void) {\n'
    while read -r name; do printf '  printf("%s %%lld\\n", (long long)%s);\n' "$name" "$name"; done <"$here/names"
    echo '  return 0; }'
} >"$here/constants.c"
gcc -w -I"$here" "$here/constants.c" -o "$here/print"
"$here/print" | grep -v HANGPOSE_ABI_VERSION >"$here/constants"
version=$(sed -n 's/^#define HANGPOSE_ABI_VERSION //p' "$header")
stored=$root/ffi/abi/hangpose-$version

store() {
    # Without paths and lines, so that the file is the same on every machine and stays the same when comments change.
    abidw --no-show-locs --no-corpus-path --no-comp-dir-path --out-file "$stored.abi" "$here/libinterface.so"
    cp "$here/constants" "$stored.constants"
    echo "abi: stored $(wc -l <"$here/exported") functions and $(wc -l <"$here/constants") constants in ffi/abi/hangpose-$version.*"
}

# ---- comparison
# New functions and constants break no program. All else does: a struct of another size is refused, a constant of
# another value misunderstood. Bytes for static arrays may become fewer.
broken() {
    local status=0
    abidiff --no-added-syms "$stored.abi" "$here/libinterface.so" || status=1
    awk 'NR == FNR { now[$1] = $2; next }
         !($1 in now) { print $1 " is gone"; bad = 1; next }
         $1 ~ /_BYTES_/ && now[$1] <= $2 { next }
         now[$1] != $2 { print $1 " was " $2 " and is " now[$1]; bad = 1 }
         END { exit bad }' "$here/constants" "$stored.constants" || status=1
    [ $status != 0 ]
}

if [ ! -e "$stored.abi" ]; then
    [ -n "$write" ] || fail "HANGPOSE_ABI_VERSION is $version, and ffi/abi/ has no interface of this version:" \
        "run make abi, and commit what it writes."
    mkdir -p "$root/ffi/abi"
    store
    exit
fi
if broken >"$here/report" 2>&1; then
    if [ -n "$write" ]; then
        commit=$(git -C "$root" log -1 --format=%H -- "ffi/abi/hangpose-$version.abi" 2>/dev/null || true)
        release=$([ -z "$commit" ] || git -C "$root" tag --contains "$commit" | head -1)
        [ -z "$release" ] || fail "the interface $version was released with $release and must not change:" \
            "raise HANGPOSE_ABI_VERSION in ffi/src/version.rs, run make header, then make abi."
        store
        exit
    fi
    cat "$here/report" >&2
    fail "programs built against interface $version break, see above, but HANGPOSE_ABI_VERSION is still $version." \
        "If interface $version was released: raise HANGPOSE_ABI_VERSION in ffi/src/version.rs, run make header, then" \
        "make abi. If it was not: run make abi. Or undo the change. docs/VERSIONS.md says what the version promises."
fi
if [ -n "$write" ]; then store; exit; fi
added=$(abidiff "$stored.abi" "$here/libinterface.so" | sed -n 's/.*, \([0-9]*\) Added functions*$/\1/p' | head -1)
echo "abi: programs built against interface $version run: ${added:-0} functions added, none removed, all structs and constants as they were"
