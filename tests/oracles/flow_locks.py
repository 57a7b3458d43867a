"""When a lock turns (rule 16)."""
from flow_rules import target_of
from flow_safety import place_is_mine, safe_after, swappable


def wanted_side(model, station):
    """To which pressure the lock should turn, None if nothing asks for any."""
    begun, able, lying = {}, {}, {}
    for wafer in model.wafers:
        for robot in model.robots:
            side = station.sides.get(robot.name)
            if side is None or wafer.ended or wafer.done is None and wafer.robot is None:
                continue
            look_for_side(model, station, wafer, robot, (begun, able, lying))
    if station.state in begun:
        return station.state
    for robot in model.robots:
        if robot.doing is None and robot.brings and robot.brings[0] is station and robot.brings[1] in robot.held() and any(
                place.station is station and place.wafer is None
                for place in model.destinations(robot, robot.brings[1], model.following(robot.brings[1], robot.brings[1].step), None, model.now)):
            side = station.sides[robot.name]
            able[side] = min(robot.brings[1].done, able.get(side, robot.brings[1].done))
    for wants in (begun, able, lying):
        if wants:
            return min(wants, key=lambda side: (wants[side], side != station.state))
    return None


def look_for_side(model, station, wafer, robot, wants):
    """Puts a wafer under its side: (its transfer by this robot has begun, it could begin but for the pressure, it lies there for it)."""
    begun, able, lying = wants
    side, since = station.sides[robot.name], wafer.done if wafer.done is not None else model.now

    def note(found):
        found[side] = min(since, found.get(side, since))
    under_way = wafer.robot is robot and wafer.destination or wafer.toward is not None and wafer.destination and wafer.place
    if under_way:
        mine = wafer.robot is robot or wafer.rows and wafer.rows[-1][0] == robot.name
        if mine and wafer.destination.station is station and (place_is_mine(wafer.destination) or can_swap(model, robot, wafer.destination)):
            note(begun)
        return
    if not wafer.lies() or wafer.done > model.now or not model.carries(robot, wafer):
        return
    number, out = model.following(wafer, wafer.step), wafer.place.station is station
    if not out and not any(place.station is station for place in wafer.steps[number][0]):
        return
    if any(out or place.station is station for place in able_places(model, robot, wafer, number)):
        note(able)
    elif out:
        note(lying)


def can_swap(model, robot, place):
    return model.rule == "swap" and place.wafer and swappable(model, robot, place.wafer)


def able_places(model, robot, wafer, number):
    """Where the wafer could go at once if pressure and robot were right."""
    if model.rule == "swap" and len(robot.arms) > 1:
        return [place for place in [target_of(model, robot, wafer)] if place]
    places = model.destinations(robot, wafer, number, wafer.place, None)
    return (place for place in places if not model.safe or safe_after(model, {wafer: (place, number)}))
