"""Figures of a flow: the steady cycle (rule 15), the circle of one that is stuck, each robot's time in classes."""
import flow_orders
from flow_parts import Place, Robot

CLASSES = ("moving empty", "moving loaded", "picking", "placing", "swapping", "door", "waiting for wafer", "waiting for place", "pump")

def steady_cycle(ends):
    """The least k <= 24 over which the last placings repeat in the middle third, as ((time, k), None), or (None, why)."""
    count = len(ends)
    first, last = count // 3, 2 * count // 3
    if last - first < 2:
        return None, "too few wafers"
    for k in range(1, 25):
        if last - 1 + k >= count:
            break
        steps = [ends[j + k] - ends[j] for j in range(first, last)]
        if max(steps) - min(steps) <= 1:
            return (steps[0], k), None
    return None, "the middle third does not repeat"


def awaited(model, robot):
    """What a robot waits for when nobody can go on: its wafer's destination, or the station of its next action."""
    aboard = [wafer.destination for wafer in robot.held() if wafer.destination]
    if aboard or not isinstance(model.rule, dict):
        return aboard
    actions = model.rule["order"].get(robot.name, [])
    if robot.next == len(actions):
        return []
    station = model.stations[actions[robot.next][1 if actions[robot.next][0] in ("keep", "pump") else 0]]
    there = [place for place in station.places if place.wafer]
    coming = [wafer for wafer in model.wafers if not wafer.ended and flow_orders.fits(wafer, actions[robot.next], robot)]
    return there or coming


def circle(model):
    """Who waits for whom, from the first robot or wafer that is on a circle."""
    def waits_for(node):
        if isinstance(node, Robot):
            return awaited(model, node)
        if isinstance(node, Place):
            return [each for each in (node.wafer, node.coming) if each]
        if node.robot:
            return [node.destination] if node.destination else [node.robot]
        carriers = [robot for robot in model.robots if model.carries(robot, node)] if not node.ended else []
        after = model.following(node, node.step)
        full = [place for place in node.steps[after][0] if place.wafer or place.coming] if after is not None else []
        return full or carriers

    def search(node, way):
        if node in way:
            return way[way.index(node):]
        found = (search(after, [*way, node]) for after in waits_for(node))
        return next((each for each in found if each), None)
    for node in [*model.robots, *(wafer for wafer in model.wafers if not wafer.ended and (wafer.place or wafer.robot))]:
        found = search(node, [])
        if found:
            return [each.station.name if isinstance(each, Place) else each.name for each in found]
    return []


def split(model, makespan):
    """The time of each robot in classes, up to the makespan."""
    times = {}
    for robot in model.robots:
        sums = times[robot.name] = dict.fromkeys(CLASSES, 0)
        for kind, begin, end in robot.intervals:
            sums[kind] += max(0, min(end, makespan) - begin)
    return times
