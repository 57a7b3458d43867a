# Sourced by the mutation runs: $python is a Python that has the generator of mutants.
# shellcheck shell=bash
venv=build/verify/mutation/venv
missing() {
    echo "SKIPPED $(basename "$0"): no $1"
    exit 77
}
command -v python3 >/dev/null || missing 'python3 (package python3)'
python3 -c 'import ensurepip' 2>/dev/null || missing 'venv for python3 (package python3-venv)'
if ! "$venv/bin/python" -c 'import universalmutator' 2>/dev/null; then
    mkdir -p "$(dirname "$venv")"
    python3 -m venv "$venv"
    # Without its dependencies: the generator alone needs none.
    "$venv/bin/pip" install --quiet --disable-pip-version-check --no-deps --require-hashes \
        -r tests/verify/mutants/requirements.txt ||
        missing 'universalmutator (from PyPI; tests/verify/mutants/requirements.txt says which)'
fi
# shellcheck disable=SC2034 # for the script that sources this
python=$venv/bin/python
