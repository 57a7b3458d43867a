"""Random tools whose robots are all timed, in a cell with axes: beside a robot that never moves they do the same to the microsecond as
the model, which shares no code with the engine. Wafers end where the model has them.

    flow_mixed.py PROGRAM FOLDER LEVEL FIRST COUNT     prints the seeds that differ; exit 1 if there are any

Doors, ports and slots for one way alone are left out: the first two are real in such a cell, the third it has not."""
import json
import math
import pathlib
import subprocess
import sys

import flow_compare
import flow_model
import flow_tools
from flow_tools import lua, seconds

FAR = 3000   # mm between two stations


def plain(tool, flow):
    """The tool without what such a cell has otherwise; all lots lie there when the flow begins."""
    for station in tool["stations"]:
        for field in ("doors", "ways", "load_port"):
            station.pop(field, None)
    for lot in flow["lots"]:
        lot["arrives"] = 0


def station_text(tool, number, station):
    clean = station.get("clean")
    fields = {"at": [FAR * (number + 1), 0, 900], "slots": station.get("slots", 1), "pitch": 10, "process": seconds(station.get("process")),
              "window": seconds(station.get("window")), "pump": seconds(station.get("pump")),
              "state": station["state"] if station.get("pump") else None,
              "clean": clean and {"after": clean.get("after"), "seconds": seconds(clean["seconds"]), "empty": clean.get("empty", True),
                                  "idle": seconds(clean.get("idle"))},
              "by": {robot: {"side": (station.get("sides") or {}).get(robot)} for robot, names in tool["serves"].items()
                     if station["name"] in names}}
    return f"{station['name']} = {lua(fields)},"


def layout_text(tool, flow):
    wafers = [{"name": f"L{number}.{index}", "station": station, "slot": slot} for number, lot in enumerate(flow["lots"])
              for index, (_, station, slot) in enumerate(lot["wafers"], 1)]
    return "\n".join(["return { robots = {", *map(flow_compare.robot_text, tool["robots"]), "STANDS = {} },", 'grippers = { { name = "EE" } },',
                      "stations = { SPARE = { at = { 700, 0, 900 }, by = { STANDS = {} } },",
                      *(station_text(tool, number, station) for number, station in enumerate(tool["stations"])), "},",
                      f"wafers = {lua(wafers)} }}", ""])


def ends_of(result, names):
    """Where each wafer is last, as a script sees it: in a slot, or away on an arm."""
    for name, rows in result["wafers"].items():
        rows = [row for row in rows if row[5] is not None and row[5] <= result["now"]]
        if rows:
            last = rows[-1]
            placed = last[9] is not None and last[9] <= result["now"]
            yield names[name], (last[6], last[7]) if placed else None


def check_places(run, result, names, tool):
    numbers = {station["name"]: number for number, station in enumerate(tool["stations"])}
    at = {wafer["name"]: wafer["position"] for wafer in run["wafers"]}
    for name, place in ends_of(result, names):
        x, _, z = at[name]
        if place is None:
            if z > -1000:
                return f"{name} is at {at[name]} (expected: aboard)"
        elif math.dist(at[name], (FAR * (numbers[place[0]] + 1), 0, 900 + 10 * (place[1] - 1))) > 1e-9:
            return f"{name} is at {at[name]} (expected {place})"
    return None


def compare(program, folder, level, seed):
    tool, flow = flow_tools.make(seed, level)
    plain(tool, flow)
    names, result = {}, flow_model.run(tool, flow)
    (folder / "flow.lua").write_text(flow_compare.script_text(flow, names), encoding="utf-8")
    (folder / "tool.lua").write_text(layout_text(tool, flow), encoding="utf-8")
    ran = subprocess.run([program, "run", folder / "flow.lua", "--counted", "--json"], capture_output=True, text=True, timeout=60, check=False)
    run = json.loads(ran.stdout) if ran.stdout.startswith("{") else {}
    told = run.get("flow")
    if not told or ran.returncode not in (0, 1):
        return f"the program ended with {ran.returncode}: {ran.stdout}{ran.stderr}"
    model, ours = set(flow_compare.visits_of_model(result, names)), set(flow_compare.visits_of_program(told))
    ends = {"done": "done", "STUCK": "stuck", "refused": "broken", "until": "cut"}
    if ends[result["state"]] != told["end"]:
        return f"the model ends {result['state']}, the program {told['end']}: {told['why']}"
    differs = min(((visit[4], visit in model, visit) for visit in model ^ ours), default=None)
    return differs or flow_compare.compare_stays(result, told, names) or check_places(run, result, names, tool)


def main(arguments):
    program, folder = arguments[0], pathlib.Path(arguments[1])
    level, first, count = map(int, arguments[2:])
    folder.mkdir(parents=True, exist_ok=True)
    found = [(seed, compare(program, folder, level, seed)) for seed in range(first, first + count)]
    for seed, difference in found:
        if difference:
            print(f"level {level}, seed {seed}: {difference}")
    return 1 if any(difference for _, difference in found) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
