"""What robots are told: by shipped rules, by lists and by rules of one's own (rules 13 and 14)."""
from flow_parts import Refused
from flow_rules import backward, begin_or_go, carry_on, first_entered, in_order, leave_failed, swap


def pumped_by_hand(rule):
    """Locks that a list turns: only lists turn them."""
    lists = rule["order"].values() if isinstance(rule, dict) else []
    return {action[1] for actions in lists for action in actions if action[0] == "pump"}


def ask(model, robot):
    """Asks the rules once. True if the robot begins anything."""
    robot.told = robot.brings = robot.waits = None
    stranded = [wafer for wafer in robot.held() if wafer.stranded and not wafer.ended]
    if stranded:
        robot.told = "waiting for place"
        return leave_failed(model, robot, stranded[0])
    if any(wafer.toward is not None and wafer.destination for wafer in robot.held()):
        return carry_on(model, robot)
    if callable(model.rule):
        return answer(model, robot, model.rule(view(model), robot.name) or [])
    if isinstance(model.rule, dict):
        return next_of_list(model, robot)
    if model.rule == "swap" and len(robot.arms) > 1:
        return swap(model, robot)
    return {"backward": backward, "swap": backward}.get(model.rule, in_order)(model, robot)


# ------------------------------------------------------------------------------------------------------- rules 13 and 14
def view(model):
    """The tool as a rule of one's own sees it."""
    return {"now": model.now,
            "stations": {station.name: {"state": station.state, "wafers": {place.slot: place.wafer.name for place in station.places if place.wafer}}
                         for station in model.stations.values()},
            "wafers": {wafer.name: {"station": wafer.place and wafer.place.station.name, "step": wafer.step, "done": wafer.done,
                                    "toward": wafer.toward, "entered": wafer.entered, "ended": wafer.ended} for wafer in model.wafers},
            "robots": {robot.name: {"at": robot.at, "holds": [wafer.name for wafer in robot.held()]} for robot in model.robots}}


def fits(wafer, action, robot):
    """The wafer is, or will be, on a step from which the action takes it."""
    start, to = action[0], action[1]
    first = wafer.step if wafer.toward is None else wafer.toward
    for number in range(first, len(wafer.steps) - 1):
        here = any(place.station.name == start for place in wafer.steps[number][0])
        after = [place.station.name for place in wafer.steps[number + 1][0]]
        if here and (to in after if to != "keep" else any(name in robot.serves for name in after)):
            return True
    return False


def names_after(model, wafer):
    """Stations of the wafer's next step."""
    after = model.following(wafer, wafer.step)
    return [] if after is None else [place.station.name for place in wafer.steps[after][0]]


def fits_now(model, robot, wafer, action):
    names = names_after(model, wafer)
    return wafer.lies() and wafer.place.station.name == action[0] and (
        action[1] in names if action[1] != "keep" else any(name in robot.serves for name in names))


def refuse(robot, action, why):
    raise Refused(f"{robot.name}: {action}: {why}")


def check(model, robot, action):
    """Refuses an action that can never begin."""
    names = [name for name in action[:2] if name != "keep"]
    for name in names:
        if name not in model.stations:
            refuse(robot, action, f"there is no station {name}")
        if name not in robot.serves:
            refuse(robot, action, f"the robot does not serve {name}")
    wafers = [wafer for wafer in model.wafers if not wafer.ended and (len(action) < 3 or wafer.name == action[2])]
    if len(action) > 2 and not any(wafer.name == action[2] for wafer in model.wafers):
        refuse(robot, action, f"there is no wafer {action[2]}")
    if action[0] == "keep":
        kept = [wafer for wafer in robot.held() if wafer.kept is not None and wafer in wafers]
        if not any(action[1] in names_after(model, wafer) for wafer in kept):
            refuse(robot, action, "no wafer that goes there is kept")
        return
    if not any(fits(wafer, action, robot) or fits_now(model, robot, wafer, action) for wafer in wafers):
        refuse(robot, action, "no wafer will be on that step")
    if robot.free_arm() is None:
        refuse(robot, action, "no arm is free")


def told_wafer(model, robot, action):
    """The wafer that an action means, as far as it is there."""
    named = [wafer for wafer in model.wafers if len(action) < 3 or wafer.name == action[2]]
    if action[0] == "keep":
        kept = [wafer for wafer in named if wafer.robot is robot and wafer.kept is not None and action[1] in names_after(model, wafer)]
        return min(kept, key=lambda wafer: (wafer.kept, wafer.order), default=None)
    there = [wafer for wafer in named if not wafer.ended and fits_now(model, robot, wafer, action)]
    return first_entered(there) if there else None


def told_places(model, robot, wafer, action):
    if action[1] == "keep":
        return [None]
    begin = model.picking_from(robot, wafer, model.arrival(robot, wafer.place.station))
    places = model.destinations(robot, wafer, model.following(wafer, wafer.step), wafer.place, begin)
    return [place for place in places if place.station.name == action[1]]


def begin_told(model, robot, action):
    """Begins an action that is told, or goes ahead. Returns (begun anything, the action itself has begun)."""
    check(model, robot, action)
    wafer = told_wafer(model, robot, action)
    if model.go(robot, model.stations[action[1] if action[0] == "keep" else action[0]]):
        return True, False
    if wafer is None:
        return False, False
    if action[0] == "keep":
        number = model.following(wafer, wafer.step)
        places = [place for place in model.destinations(robot, wafer, number, None, model.now) if place.station.name == action[1]]
        if any(place.wafer is None for place in places):
            robot.brings = (places[0].station, wafer)
        places = [place for place in places if place.wafer is None and place.clean_end is None and model.free(robot, place.station)]
        if places:
            model.place(robot, wafer, places[0])
        else:
            robot.told = "waiting for place"
        return bool(places), bool(places)
    begun = begin_or_go(model, robot, wafer, told_places(model, robot, wafer, action))
    if not begun and isinstance(model.rule, dict) and action[1] != "keep":
        robot.waits = wafer
    return begun, begun


def next_of_list(model, robot):
    actions = model.rule["order"].get(robot.name, [])
    if robot.next == len(actions):
        return False
    action = actions[robot.next]
    if action[0] == "pump":
        return pump(model, robot, action)
    begun, itself = begin_told(model, robot, action)
    robot.next += itself
    return begun


def pump(model, robot, action):
    """The robot goes on as soon as the pump has begun, or if there is nothing to pump."""
    if action[1] not in model.stations or not model.stations[action[1]].pump:
        refuse(robot, action, "this is no lock")
    station = model.stations[action[1]]
    if station.turning is None and station.state != action[2]:
        if station.busy_until > model.now:
            return False
        model.turn(station, action[2])
    elif station.turning and station.turning[0] != action[2]:
        return False
    robot.next += 1
    return True


def answer(model, robot, actions):
    """The first that can begin as soon as the robot gets there, else it goes ahead to the first."""
    for action in actions:
        check(model, robot, action)
    for action in actions:
        wafer = told_wafer(model, robot, action)
        if wafer is None:
            continue
        arrival = model.arrival(robot, model.stations[action[1] if action[0] == "keep" else action[0]])
        if action[0] == "keep":
            able = any(place.station.name == action[1] and place.wafer is None for place in model.destinations(
                robot, wafer, model.following(wafer, wafer.step), None, model.now))
        else:
            able = model.picking_from(robot, wafer, arrival) == arrival and told_places(model, robot, wafer, action)
        if able:
            return begin_told(model, robot, action)[0]
    return begin_told(model, robot, actions[0])[0] if actions else False
