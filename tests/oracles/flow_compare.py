"""Plays random tools by the model and by `waferhand run`, and compares every visit of every wafer to the microsecond.

    flow_compare.py PROGRAM FOLDER LEVEL FIRST COUNT     prints the seeds that differ; exit 1 if there are any

Lost wafers are the same as well; so are stays beyond windows."""
import json
import pathlib
import subprocess
import sys

import flow_model
import flow_tools
from flow_tools import Seconds, lua, seconds, script_step


def robot_text(robot):
    fields = {"kind": "timed", "arms": robot["arms"], "at": robot["at"],
              **{name: seconds(robot[name]) for name in ("pick", "place", "swap") if robot.get(name) is not None}}
    move = robot["move"]
    if isinstance(move, dict):
        text = "{ default = 0, " + ", ".join(f'["{start}>{end}"] = {Seconds(value)!r}' for (start, end), value in move.items()) + " }"
    else:
        text = repr(Seconds(move))
    return f"{robot['name']} = {lua(fields)[:-2]}, move = {text} }},"


def served_by(tool, station):
    for robot, names in tool["serves"].items():
        if station["name"] in names:
            door = (station.get("doors") or {}).get(robot)
            fields = {"side": (station.get("sides") or {}).get(robot),
                      "door": door and {"open": seconds(door.get("open", 0)), "close": seconds(door.get("close", 0))}}
            yield f"{robot} = {lua(fields)}"


def port_of(station):
    """A port's steps, whose sums are what the model has."""
    port = station.get("port")
    return port and {"state": "absent" if port.get("absent") else None, "place": seconds(port["comes"] // 3), "clamp": seconds(port["comes"] - port["comes"] // 3),
                     "dock": 0, "open": 0, "map": 0, "remove": seconds(port["goes"] // 3), "unclamp": seconds(port["goes"] - port["goes"] // 3)}


def station_text(tool, station):
    clean, ways = station.get("clean"), station.get("ways") or {}
    fields = {"slots": station.get("slots", 1), "process": seconds(station.get("process")), "window": seconds(station.get("window")),
              "kind": "load_port" if station.get("load_port") else None, "pump": seconds(station.get("pump")),
              "state": station["state"] if station.get("pump") else None,
              "into": [slot for slot, way in ways.items() if way == "in"] or None, "out": [slot for slot, way in ways.items() if way == "out"] or None,
              "port": port_of(station),
              "clean": clean and {"after": clean.get("after"), "seconds": seconds(clean["seconds"]), "empty": clean.get("empty", True),
                                  "idle": seconds(clean.get("idle"))}}
    return f"{station['name']} = {lua(fields)[:-2]}, by = {{ {', '.join(served_by(tool, station))} }} }},"


def layout_text(tool):
    return "\n".join(["return { robots = {", *map(robot_text, tool["robots"]), "}, stations = {",
                      *(station_text(tool, station) for station in tool["stations"]), "} }", ""])


def lot_text(number, lot, names):
    station, slots = lot["wafers"][0][1], [slot for _, _, slot in lot["wafers"]]
    assert slots == list(range(slots[0], slots[0] + len(slots)))
    names.update({name: f"L{number}.{index}" for index, (name, _, _) in enumerate(lot["wafers"], 1)})
    return lua({"name": f"L{number}", "recipe": lot.get("recipes"), "wafers": [station, slots[0], slots[-1]], "route": lot["route"], "arrives": seconds(lot.get("arrives") or None),
                "priority": lot.get("priority") or None, "back": lot.get("back"), "dummy": lot.get("dummy") or None}) + ","


def route_text(name, route):
    parts = [script_step(step) for step in route["steps"]]
    if route.get("partial"):
        parts.append("partial = " + lua(route["partial"]))
    return f"{name} = {{ {', '.join(parts)} }},"


def down_text(down):
    lasts = "" if down["seconds"] is None else f", seconds = {Seconds(down['seconds'])!r}"
    return f'{{ "{down["station"]}", at = {Seconds(down["at"])!r}{lasts} }}'


def script_text(flow, names):
    lines = ['cell "tool.lua"', "flow { lots = {", *(lot_text(number, lot, names) for number, lot in enumerate(flow["lots"])), "}, routes = {",
             *(route_text(name, route) for name, route in flow["routes"].items()), "},"]
    rule = flow["rule"]
    if isinstance(rule, dict):
        rule = {"order": {robot: [[names.get(part, part) for part in action] for action in actions] for robot, actions in rule["order"].items()}}
    downs = [down_text(down) for down in flow.get("down") or []]
    lines += [f"until_s = {Seconds(flow['until'])!r}," if flow.get("until") else "", f"rule = {lua(rule)},", f"down = {{ {', '.join(downs)} }},", f"takt = {Seconds(flow.get('takt') or 0)!r},",
              f"safe = {lua(flow.get('safe', True))},", 'late = "tell" }', ""]
    return "\n".join(lines)


def whole(value):
    return None if value is None else round(value * 1e6)


def visits_of_program(told):
    for visit in (visit for visit in told["visits"] if visit["placed_s"] is not None):
        yield (visit["wafer"], visit["robot"], visit["from"], visit["from_slot"], whole(visit["pick_s"]), whole(visit["picked_s"]), visit["to"],
               visit["to_slot"], whole(visit["place_s"]), whole(visit["placed_s"]))


def visits_of_model(result, names):
    """Placings that have ended: a flow that is cut or refused ends amid others."""
    for name, rows in result["wafers"].items():
        for robot, _, start, start_slot, pick, picked, end, end_slot, place, placed, *_ in rows:
            if placed is not None and placed <= result["now"]:
                yield names[name], robot, start, start_slot, pick, picked, end, end_slot, place, placed


def compare(program, folder, level, seed):
    """None if both are the same, else what differs first."""
    tool, flow = flow_tools.make(seed, level)
    endless = any(down["seconds"] is None for down in flow.get("down") or [])
    names, result = {}, flow_model.run(tool, flow)
    (folder / "flow.lua").write_text(script_text(flow, names), encoding="utf-8")
    (folder / "tool.lua").write_text(layout_text(tool), encoding="utf-8")
    ran = subprocess.run([program, "run", folder / "flow.lua", "--json"], capture_output=True, text=True, timeout=60, check=False)
    told = json.loads(ran.stdout).get("flow") if ran.stdout.startswith("{") else None
    if not told or ran.returncode not in (0, 1):
        return f"the program ended with {ran.returncode}: {ran.stdout}{ran.stderr}"
    model, ours = set(visits_of_model(result, names)), set(visits_of_program(told))
    ends = {"done": "done", "STUCK": "stuck", "refused": "broken", "until": "cut"}
    if ends[result["state"]] != told["end"]:
        return f"the model ends {result['state']}, the program {told['end']}: {told['why']}"
    lost = {wafer["name"] for lot in told["lots"] for wafer in lot["wafers"] if wafer["fate"] == "lost"}
    if lost != {names[name] for name in result["lost"]} or len(lost) != told["lost"]:
        return f"lost: the model's are {sorted(names[name] for name in result['lost'])}, the program's {sorted(lost)}"
    if told["end"] == "stuck" and not endless and isinstance(flow["rule"], str) and flow.get("safe", True):
        return f"safe, and STUCK: {told['why']}"
    summed = sum(whole(part["seconds"]) for part in told["path"])
    if summed != whole(told["makespan_s"]):
        return f"the critical path is {summed} us long, the flow {whole(told['makespan_s'])}"
    differs = min(((visit[4], visit in model, visit) for visit in model ^ ours), default=None)
    return differs or compare_stays(result, told, names)


def compare_stays(result, told, names):
    """Stays beyond their windows; of a flow that ends early those that go on count, too, which the model leaves out."""
    if result["state"] != "done":
        return None
    model = {(names[wafer], station, over) for wafer, station, over in result["stays"]}
    ours = {(stay["wafer"], stay["station"], whole(stay["stay_s"] - stay["window_s"])) for stay in told["stays"]}
    return f"stays beyond windows: {sorted(model ^ ours)}" if model ^ ours else None


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
