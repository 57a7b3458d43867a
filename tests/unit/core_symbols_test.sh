#!/bin/sh
# The core needs nothing but sqrt, fabs and memory copies: looks at the undefined symbols of its objects, linked
# into one. BUILD is the folder with libwaferhand.a (default: build), to be run from the project's root.
set -eu
build=${BUILD:-build}
library=$build/libwaferhand.a
allowed='sqrt|sqrtf|fabs|fabsf|memcpy|memset|_GLOBAL_OFFSET_TABLE_'

[ -f "$library" ] || { echo "core_symbols_test: no $library" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

members=$(for source in lib/core/*.c; do basename "$source" .c; done | sed 's/$/.o/')
# shellcheck disable=SC2086  # one word for each member
(cd "$work" && ar x "$OLDPWD/$library" $members)
# shellcheck disable=SC2086
(cd "$work" && ld -r -o core.o $members)
undefined=$(nm -u "$work/core.o" | sed 's/^ *[Uuvw] *//')

if echo "$undefined" | grep -Eq '^_*(asan|ubsan|tsan|msan|gcov|llvm_prf|llvm_profile|sanitizer)'; then
    echo "0 passed, 1 skipped: instrumented build"
    exit 0
fi
if extra=$(echo "$undefined" | grep -Evx "$allowed" | grep .); then
    echo "the core needs more than it may:" "$extra" >&2
    echo "0 passed, 1 failed"
    exit 1
fi
# shellcheck disable=SC2086
echo "1 passed: the core needs" ${undefined:-nothing}
