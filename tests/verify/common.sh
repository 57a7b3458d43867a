# Functions that the scripts of this folder share: the place to work in, and how a script skips.
# shellcheck shell=bash
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit
unset MAKEFLAGS
# A pattern that matches no file is an error, so that a file that moved is not left out in silence.
shopt -s failglob

# The sources that are proved: the grasp table and all that it builds on.
# shellcheck disable=SC2034 # for the scripts that ask
{
    proved_sources=(lib/math/{pose,status,status_name}.c lib/grasp/*.c)
    proved_headers=(lib/math/{hash,pose,status,vector}.h lib/grasp/*.h)
    library_rooms=$(sed -n 's/^LIBRARY_ROOMS := //p' lib/build/rooms.mk)
}
work=build/verify/$(basename "$0")
mkdir -p "$work"

# need TOOL=PACKAGE...: the check is skipped by name unless all tools are there
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

# same_table TABLE KEY FILE: the lines of TABLE that begin with KEY must be those of FILE. Another version of the compiler gives
# other figures: they are shown, but not judged. ACCEPT=1 puts FILE's lines into TABLE.
same_table() {
    local table=$1 key=$2 file=$3
    if [[ ${ACCEPT:-} ]]; then
        { grep -v "^$key " "$table" || true; } | sort - "$file" >"$work/table"
        mv "$work/table" "$table"
        echo "$table now has these figures"
    elif ! grep -q "^$key " "$table"; then
        echo "$table has no figures of $key: these are not judged"
    elif ! diff <(grep "^$key " "$table") "$file"; then
        fail "the figures (>) are not the ones of $table (<): explain the change, and accept it with ACCEPT=1 $0"
    fi
}

# at_most LIMIT NAME FILE: checks the figure at the end of the line that ends in "NAME figure"
at_most() {
    local figure
    figure=$(sed -n "s/^.* $2 \([0-9]*\)$/\1/p" "$3")
    [[ $figure && $figure -le $1 ]] || fail "$2 is ${figure:-missing}, more than $1"
}

# python_with_mutants: sets $python to a Python that has the generator of mutants.
python_with_mutants() {
    local venv=build/verify/mutation/venv
    need python3=python3
    if ! "$venv/bin/python" -c 'import universalmutator' 2>/dev/null; then
        # It is installed without its dependencies, which the generator does not need.
        if ! { python3 -m venv "$venv" && "$venv/bin/pip" install --quiet --disable-pip-version-check --no-deps \
            --require-hashes -r tests/verify/mutants/requirements.txt; }; then
            echo "SKIPPED $(basename "$0"): no universalmutator (from PyPI; tests/verify/mutants/requirements.txt says which)," \
                "or no venv for python3 (package python3-venv)"
            exit 77
        fi
    fi
    # shellcheck disable=SC2034 # for the script that asks
    python=$venv/bin/python
}
