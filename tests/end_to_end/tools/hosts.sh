# Functions for scripts that wait for other processes, and talk to them as hosts do: by conditions, not by times, and without a
# process for each step.
# shellcheck shell=bash

# pause SECONDS: starts no process
exec {never}<> <(:)
pause() {
    read -r -t "$1" -u "$never" || true
}

# until_true COMMAND...: within a minute, on a busy machine
until_true() {
    local limit=$((SECONDS + 60))
    until "$@"; do
        ((SECONDS < limit)) || { echo "in vain: $*"; return 1; }
        pause 0.02
    done
}

# says FILE PATTERN [TIMES]: this many of its lines have the pattern (one)
says() {
    local lines
    lines=$(grep -c -e "$2" "$1" 2>/dev/null) || return 1
    ((lines >= ${3:-1}))
}

# until_said FILE PATTERN [TIMES]
until_said() {
    until_true says "$@" || { tail -n 5 "$1"; return 1; }
}

# places FILE: PORTS gets the address of each port, as `serve` has printed it there
places() {
    local line
    PORTS=()
    while read -r line; do
        [[ ! $line =~ ^serve:\ .*,\ at\ (.*)$ ]] || PORTS+=("${BASH_REMATCH[1]}")
    done <"$1"
}

has_places() {
    places "$1"
    ((${#PORTS[@]} >= $2))
}

# listening FILE COUNT: waits until this number of ports is there
listening() {
    until_true has_places "$@" || { cat "$1"; return 1; }
}

# host MODE ARGUMENT...: the work of tests/end_to_end/tools/host.py with these, in the one process that start_host has begun
host() {
    local said status
    printf '%s\0' "$#" "$@" >&"$to_host"
    IFS= read -r -d '' -u "$from_host" said
    IFS= read -r -d '' -u "$from_host" status
    printf '%s' "$said"
    return "$status"
}

# It serves a whole script, which ends it by stop_host.
start_host() {
    coproc HOST { exec python3 tests/end_to_end/tools/host.py session; }
    # Unlike a coprocess's descriptors, these are available in pipes, too.
    # shellcheck disable=SC2153 # coproc sets it
    exec {to_host}>&"${HOST[1]}" {from_host}<&"${HOST[0]}"
}

stop_host() {
    [[ -z ${HOST_PID:-} ]] || kill "$HOST_PID" 2>/dev/null || true
}

say() {
    host lines "$@"
}

# client ARGUMENT...: the Python program of standard input is a client
client() {
    local text
    IFS= read -r -d '' text || true
    host python "$text" "$@"
}
