# Begins a script that hosts by `waferhand serve`, whose folder is `work`: hosts.sh, a layout, and functions.
# shellcheck shell=bash

: "${work:?}"
rm -rf "$work"
mkdir -p "$work"
# shellcheck source=tests/end_to_end/tools/hosts.sh
source tests/end_to_end/tools/hosts.sh
layout=lua/layouts/paper.lua
# Most refusals need these.
# shellcheck disable=SC2034 # scripts use them
port=(--tcp 127.0.0.1:0) dialect=(--dialect lua/dialects/prompt.lua)
served=
simulator=
trap '[[ -z $served$simulator ]] || kill $served $simulator 2>/dev/null || true; stop_host' EXIT
start_host

# serve NAME ARGUMENT...: starts one, and waits until it has printed the address of each port; PORTS has these addresses
serve() {
    local name=$1 argument wanted=0 written=(--transcript "$work/$1.txt")
    shift
    for argument; do
        [[ $argument != --transcript ]] || written=()
        [[ $argument != --dialect ]] || wanted=$((wanted + 1))
    done
    : >"$work/$name"
    build/waferhand serve "$layout" "${written[@]}" "$@" 2>>"$work/$name" &
    served=$!
    listening "$work/$name" "$wanted"
}

# finish NAME [STATUS]: ends it as an operator does
finish() {
    local got=0
    kill -TERM "$served"
    wait "$served" || got=$?
    served=
    [[ $got == "${2:-0}" ]] || { echo "status $got"; tail -n 5 "$work/$1"; false; }
}

# ended NAME: the result of the run, in `slices` and `hash`
ended() {
    slices='' hash=''
    while read -r line; do
        [[ ! $line =~ ^serve:\ ([0-9]*)\ slices?,\ hash\ (.*)$ ]] || slices=${BASH_REMATCH[1]} hash=${BASH_REMATCH[2]}
    done <"$work/$1"
}

# again NAME: its transcript, played, gives the same with the same hash
again() {
    local same
    build/waferhand converse "$work/$1.txt" >"$work/again" 2>"$work/again.err" || { cat "$work/again"; false; }
    ended "$1"
    IFS= read -r -d '' same <"$work/again" || true
    [[ $same == "same; slices: $slices, hash $hash"$'\n' ]] || { echo "wanted: $slices, $hash"; cat "$work/again"; false; }
}

hash_of() {
    sed -n 's/^serve: .* hash //p' "$work/$1"
}

# alone MODE ARGUMENT...: a host beside the others
alone() {
    python3 tests/end_to_end/tools/host.py "$@"
}

# refused WORDS ARGUMENT...: it prints these words and does not begin
refused() {
    local words=$1 got=0
    shift
    build/waferhand "$@" >"$work/refused" 2>&1 || got=$?
    if [[ $got != 2 ]] || ! grep -F -e "$words" "$work/refused" >/dev/null; then
        echo "status $got, wanted: $words"
        cat "$work/refused"
        false
    fi
}

# only MECHANISM WORDS: lines of the prompt with only these words, for a controller of that mechanism
only() {
    sed "s/^return {/return { mechanism = \"$1\",/; /^local WORDS = /,/RESUME]]/d; 1a local WORDS = \"$2\"" lua/dialects/prompt.lua >"$work/$1.lua"
}

# pair BUSY: the dialects of two controllers of one cell, with this timing
pair() {
    only robot 'GET PUT CONTINUE STATUS WAIT WHERE STOP HOLD RESUME'
    only aligner 'ROTATE STATUS WAIT STOP HOLD RESUME'
    sed -i "s/^return {/return { timing = { busy = $1 },/" "$work/robot.lua" "$work/aligner.lua"
}

# simulate [URL]: starts one
simulate() {
    build/waferhand sim "$layout" --lcm-url "${1:-$WH_URL}" 2>>"$work/sim" &
    simulator=$!
}

stop_simulator() {
    kill "-$1" "$simulator"
    wait "$simulator" 2>/dev/null || true
    simulator=
}
