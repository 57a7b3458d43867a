"""Looks at a result of flow_model (or of an engine in the same form) without any rule: is what the histories say possible in the tool?
Returns sentences, one for each violation."""
from collections import defaultdict

from flow_parts import Robot, Station


class Action:
    """A pick, place or swap as its robot and station see it."""

    def __init__(self, robot, station, slot, begin, end):
        self.robot, self.station, self.slot, self.begin, self.end = robot, station, slot, begin, end
        self.taken = self.left = None

    def kind(self):
        return "swap" if self.taken and self.left else "pick" if self.taken else "place"


def actions_of(result):
    found = {}
    for wafer, rows in result["wafers"].items():
        for row in rows:
            for key, side in ((row[0], *row[2:6]), "taken"), ((row[0], *row[6:10]), "left"):
                if key[3] is not None:
                    setattr(found.setdefault(key, Action(*key)), side, wafer)
    return sorted(found.values(), key=lambda action: (action.begin, action.end))


def look(tool, flow, result):
    robots = {given["name"]: Robot(given, tool["serves"][given["name"]]) for given in tool["robots"]}
    stations = {given["name"]: Station(given) for given in tool["stations"]}
    actions = actions_of(result)
    return [*look_at_robots(robots, actions), *look_at_stations(robots, stations, actions, result, flow),
            *look_at_places(flow, stations, actions, result), *look_at_wafers(flow, result), *look_at_splits(result)]


def shortest(robot):
    """The least time between two stations: a robot may be sent elsewhere on its way."""
    stations = sorted(robot.serves)
    least = {(a, b): robot.move(a, b) for a in stations for b in stations}
    for via in stations:
        for a, b in least:
            least[a, b] = min(least[a, b], least[a, via] + least[via, b])
    return least


def look_at_robots(robots, actions):
    for name, robot in robots.items():
        least = shortest(robot)
        aboard, at, free = set(), robot.at, 0
        for action in (each for each in actions if each.robot == name):
            if action.station not in robot.serves:
                yield f"{name} does not serve {action.station}"
            if action.begin < free + least[at, action.station]:
                yield f"{name} cannot be at {action.station} at {action.begin}"
            need = robot.seconds(action.kind(), action.station)
            if action.end - action.begin != need:
                yield f"{name}: {action.kind()} at {action.station} takes {action.end - action.begin}, not {need}"
            if action.left and action.left not in aboard:
                yield f"{name} places {action.left}, which is not aboard"
            aboard |= {action.taken} - {None}
            if len(aboard) > len(robot.arms):
                yield f"{name} has {sorted(aboard)} aboard"
            aboard -= {action.left}
            at, free = action.station, action.end


def look_at_stations(robots, stations, actions, result, flow):
    """Nothing overlaps at a station: its picks, places and swaps with their doors, its pumps; pressure; down times."""
    spans = defaultdict(list)
    for action in actions:
        opening, closing = stations[action.station].door(robots[action.robot])
        spans[action.station].append((action.begin - opening, action.end + closing, action))
    for name, to, begin, end in result["pumps"]:
        spans[name].append((begin, end, to))
    for name, found in spans.items():
        station, state = stations[name], stations[name].state
        found.sort(key=lambda span: span[:2])
        for before, after in zip(found, found[1:]):
            if after[0] < before[1]:
                yield f"{name}: {before[:2]} and {after[:2]} overlap"
        for begin, _, what in found:
            side = station.sides.get(what.robot) if isinstance(what, Action) else None
            if station.pump and side and side != state:
                yield f"{name}: {what.robot} at {begin} at {state}"
            state = state if isinstance(what, Action) else what
            for down in flow.get("down") or []:
                if down["station"] == name and down["at"] <= begin and (down["seconds"] is None or begin < down["at"] + down["seconds"]):
                    yield f"{name}: something begins at {begin}, while it is down"


def look_at_places(flow, stations, actions, result):
    """One wafer at a time in each place; cleans after so many wafers, and nobody in the place meanwhile."""
    inside, count, cleans = {}, defaultdict(int), defaultdict(list)
    for station, slot, begin, end in result["cleans"]:
        cleans[station, slot].append((begin, end))
    for lot in flow["lots"]:
        inside |= {(station, slot): wafer for wafer, station, slot in lot["wafers"]}
    for action in actions:
        place = action.station, action.slot
        if action.taken and inside.pop(place, None) != action.taken:
            yield f"{action.taken} is not in {place} at {action.begin}"
        if action.left and place in inside:
            yield f"{place} is not empty at {action.begin}"
        clean = stations[action.station].clean
        for begin, end in cleans[place]:
            if action.begin < end and begin < action.end and (clean.get("empty", True) or action.taken):
                yield f"{place}: {action.kind()} at {action.begin} during a clean"
            if action.left and begin < action.begin <= max(end, action.begin) and begin >= inside.get(("since", place), 0):
                count[place], inside["since", place] = 0, action.begin
        if action.left:
            if clean and clean.get("after") and count[place] >= clean["after"]:
                yield f"{place}: {action.left} at {action.begin} without a clean"
            count[place] += 1
            inside[place] = action.left


def look_at_wafers(flow, result):
    starts = []
    for lot in flow["lots"]:
        steps = flow["routes"][lot["route"]]["steps"]
        for wafer, station, slot in lot["wafers"]:
            rows, here, ready = result["wafers"][wafer], (station, slot), lot.get("arrives", 0)
            for number, row in enumerate(rows):
                if row[2:4] != here or ready is None or row[4] < ready:
                    yield f"{wafer}: taken from {row[2:4]} at {row[4]}, lies in {here}, ready at {ready}"
                if number < len(steps) and row[6] and not flow.get("down") and row[6] not in steps[number]["stations"] and row[6] != lot.get("back"):
                    yield f"{wafer}: {row[6]} is no station of step {number + 1}"
                here, ready = row[6:8], row[11]
            starts += [(rows[0][4], wafer)] if rows else []
            if result["state"] == "done" and not flow.get("down") and (not rows or rows[-1][9] is None or (
                    lot.get("back") and rows[-1][6:8] != (lot["back"], slot))):
                yield f"{wafer} is not where its route ends"
    starts.sort()
    for before, after in zip(starts, starts[1:]):
        if after[0] - before[0] < (flow.get("takt") or 0):
            yield f"{after[1]} starts {after[0] - before[0]} after {before[1]}"


def look_at_splits(result):
    if result["state"] == "done":
        for robot, classes in result["robots"].items():
            if sum(classes.values()) != result["makespan"]:
                yield f"{robot}: classes add up to {sum(classes.values())}, not {result['makespan']}"
