# What the scripts of this folder share: the place to work in, and how they skip.
# shellcheck shell=bash
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit
unset MAKEFLAGS
work=build/verify/$(basename "$0")
mkdir -p "$work"

# need TOOL=PACKAGE...: all of them, or the check is skipped by name.
need() {
    local pair missing=''
    for pair; do
        command -v "${pair%%=*}" >/dev/null || missing="$missing ${pair%%=*} (package ${pair##*=})"
    done
    if [[ $missing ]]; then
        echo "SKIPPED $(basename "$0"): no$missing"
        exit 77
    fi
}

fail() {
    echo "failed: $*"
    exit 1
}
