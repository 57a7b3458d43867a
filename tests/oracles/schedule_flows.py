#!/usr/bin/env python3
"""Plays random tools by `waferhand run --schedule` and holds what it wrote against the rules, with the same layout and its routes: nothing
is found but the stays beyond windows that the flow itself tells.

    schedule_flows.py PROGRAM FOLDER LEVEL FIRST COUNT     prints the seeds that differ; exit 1 if there are any"""
import json
import pathlib
import subprocess
import sys

import flow_tools
from flow_compare import layout_text, route_text, script_text

NEEDED = range(1, 6)
WINDOW = 9


def whole_layout(tool, flow):
    """The layout with the flow's routes, and each station that lots come to."""
    return layout_text(tool).rstrip().removesuffix("}") + ", routes = { " + " ".join(route_text(*item) for item in flow["routes"].items()) + " } }\n"


def call(*words):
    return subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)


def look(program, folder, level, seed):
    """None if all is as it should be, else what is not."""
    tool, flow = flow_tools.make(seed, level)
    if any(down["seconds"] is None for down in flow.get("down") or []):
        return None
    (folder / "flow.lua").write_text(script_text(flow, {}), encoding="utf-8")
    (folder / "tool.lua").write_text(whole_layout(tool, flow), encoding="utf-8")
    ran = call(program, "run", folder / "flow.lua", "--json", "--schedule", folder / "schedule.csv")
    told = json.loads(ran.stdout).get("flow") if ran.stdout.startswith("{") else None
    if not told:
        return f"run ended with {ran.returncode}: {ran.stderr}"
    if not any(visit["placed_s"] is not None for visit in told["visits"]):
        return None
    held = call(program, "schedule", folder / "schedule.csv", "--layout", folder / "tool.lua", "--json")
    if not held.stdout.startswith("{"):
        return f"schedule ended with {held.returncode}: {held.stderr}"
    verdict = json.loads(held.stdout)
    late = {(stay["wafer"], stay["station"]) for stay in told["stays"]}
    for finding in verdict["findings"]:
        is_told = finding["rule"] == WINDOW and any(station == finding["row"]["station"] for _, station in late)
        if not finding["warning"] and not is_told:
            return f"rule {finding['rule']}, line {finding['row']['line']}: {finding['text']}"
    if not all(rule["looked_at"] for rule in verdict["rules"] if rule["number"] in NEEDED):
        return f"not looked at: {[rule['number'] for rule in verdict['rules'] if not rule['looked_at']]}"
    warned = any(finding["warning"] for finding in verdict["findings"])
    if told["end"] == "done" and warned:
        return f"a warning of a flow that is done: {verdict['findings'][0]['text']}"
    if told["end"] == "done" and not late:
        return look_at_play(program, folder, told)
    return None


def look_at_play(program, folder, told):
    """An accepted schedule that is played in its own order comes to its end, each row comes about, and it never takes longer."""
    played = call(program, "schedule", folder / "schedule.csv", "--layout", folder / "tool.lua", "--json", "--play")
    if played.returncode not in (0, 1) or not played.stdout.startswith("{"):
        return f"schedule --play ended with {played.returncode}: {played.stderr}"
    verdict = json.loads(played.stdout)
    play = verdict["play"]
    if play["end"] != "done" or play["played"] != play["actions"] or not verdict["ok"] or played.returncode != 0:
        return f"played to {play['played']} of {play['actions']} rows, {play['end']}, exit {played.returncode}: {play['why']}"
    if play["makespan_s"] > play["schedule_makespan_s"] + 1e-6:
        return f"played in {play['makespan_s']} s, the schedule takes {play['schedule_makespan_s']}"
    if abs(play["schedule_makespan_s"] - told["makespan_s"]) > 1e-6:
        return f"the schedule is {play['schedule_makespan_s']} s long, the flow {told['makespan_s']}"
    return None


def main(arguments):
    program, folder = arguments[0], pathlib.Path(arguments[1])
    level, first, count = map(int, arguments[2:])
    folder.mkdir(parents=True, exist_ok=True)
    found = [(seed, look(program, folder, level, seed)) for seed in range(first, first + count)]
    for seed, difference in found:
        if difference:
            print(f"level {level}, seed {seed}: {difference}")
    return 1 if any(difference for _, difference in found) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
