"""The steady cycle of a flow of real robots against the closed form for moves that differ, with the moves as a script of single
commands measured them: one robot, modules in series, backward. flow_line.py PROGRAM FIRST COUNT."""
import json
import os
import subprocess
import sys

ROUTE = ["A", "P1", "P2", "P3", "B"]
LAST = len(ROUTE) - 1
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "end_to_end", "data")


def run(program, script, *options):
    told = subprocess.run([program, "run", os.path.join(DATA, script), "--counted", *options], capture_output=True, text=True)
    if told.returncode != 0:
        sys.exit(f"{script} {' '.join(options)}: {told.stdout}{told.stderr}")
    return told.stdout


def measure(program, options):
    times = {}
    for line in run(program, "flow_line_moves.lua", *options).splitlines():
        parts = line.split()
        if parts and parts[0] in ("get", "put", "move", "process"):
            times[tuple(parts[:-1])] = float(parts[-1])
    return times


def closed_form(times):
    """The largest of the robot's round and each module's, and whose it is."""
    def get(i):
        return times["get", ROUTE[i]]

    def put(i):
        return times["put", ROUTE[i]]

    def way(i, j):
        return times["move", ROUTE[i], ROUTE[j]]

    def carry(i):
        return get(i) + way(i, i + 1) + put(i + 1)

    modules = range(1, LAST)
    robot = sum(carry(i) for i in range(LAST)) + sum(way(i + 1, i - 1) for i in modules) + way(1, LAST - 1)
    rounds = [(robot, "robot")]
    for i in modules:
        rounds.append((times["process", ROUTE[i]] + carry(i) + way(i + 1, i - 1) + carry(i - 1), ROUTE[i]))
    return max(rounds)


def main():
    program, first, count = sys.argv[1:]
    limits, worst = {}, 0.0
    for seed in range(int(first), int(first) + int(count)):
        for most in (4, 30):  # short processes leave the robot the limit
            options = ["--set", f"seed={seed}", "--set", f"most={most}"]
            cycle, limit = closed_form(measure(program, options))
            flow = json.loads(run(program, "flow_line_run.lua", "--json", *options))["flow"]
            if flow["cycle_s"] is None:
                sys.exit(f"seed {seed}, most {most}: no steady cycle: {flow['no_cycle']}")
            off = abs(flow["cycle_s"] / cycle - 1)
            worst = max(worst, off)
            limits[limit] = limits.get(limit, 0) + 1
            if off > 1e-3:
                sys.exit(f"seed {seed}, most {most}: {flow['cycle_s']} s (expected {cycle} s by the closed form, for {limit})")
    if len(limits) < 2:
        sys.exit(f"each cell was limited alike: {limits}")
    print(f"{sum(limits.values())} cells, the worst off by {worst:.6f}; limited by {limits}")


main()
