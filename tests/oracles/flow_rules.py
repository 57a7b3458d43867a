"""The shipped rules of flow_model: which transfer a robot begins, or to which wafer it goes ahead (rules 5 and 8 to 10)."""
from flow_safety import place_is_mine, safe_after, swappable

SHIPPED = ("backward", "swap", "first_come", "longest_wait")
NEVER = 1 << 62


# ------------------------------------------------------------------------------------------------------------ carrying out
def carry_on(model, robot):
    """With a wafer aboard whose destination is fixed: goes there, and places as soon as placing can begin."""
    aboard = [wafer for wafer in robot.held() if wafer.destination]
    wafer = min(aboard, key=lambda each: (each.destination.station.name != robot.at, each.begun, each.order))
    place = wafer.destination
    if place.station.failed_at(model.now):
        place.coming = wafer.destination = None
        return swap(model, robot) if model.rule == "swap" and len(robot.arms) > 1 else leave_failed(model, robot, wafer)
    if model.rule == "swap" and len(robot.arms) > 1 and not place_is_mine(place):
        return swap(model, robot)
    if model.go(robot, place.station):
        return True
    if place.wafer is None and place.clean_end is None and model.free(robot, place.station):
        model.place(robot, wafer, place)
        return True
    robot.told = "pump" if model.pressure_from(place.station, robot) != model.now or place.station.turning else "waiting for place"
    return False


def leave_failed(model, robot, wafer):
    """Its destination has failed: another place of the step, or the step behind. It waits aboard while that is full; if there is none
    its route ends on the arm."""
    wafer.toward, wafer.stranded = None, False
    number = model.following(wafer, wafer.step)
    if number is None:
        wafer.ended = wafer.lost = True
        return False
    places = model.destinations(robot, wafer, number, None, model.now)
    if not places:
        wafer.stranded = True
        return False
    wafer.toward, wafer.destination, places[0].coming = number, places[0], wafer
    model.go(robot, places[0].station)
    return True


def begin_or_go(model, robot, wafer, places):
    """Begins the transfer if it can begin now, else goes to the wafer (rule 5). True if the robot begins anything."""
    here = wafer.place
    if model.go(robot, here.station):
        return True
    if model.picking_from(robot, wafer, model.now) == model.now and model.free(robot, here.station):
        if places and robot.free_arm(wafer.steps[wafer.step][2]) is not None:
            model.pick(robot, wafer, places[0])
            return True
        robot.told = "waiting for place"
    elif wafer.done is not None and wafer.done <= model.now:
        robot.told = "pump" if model.pressure_from(here.station, robot) != model.now else "waiting for place"
    return False


def places_for(model, robot, wafer):
    """The best place that may take the wafer from where it lies, as a list of it or none; shipped rules leave out what is not safe."""
    begin = model.picking_from(robot, wafer, model.arrival(robot, wafer.place.station))
    number = model.following(wafer, wafer.step)
    places = model.destinations(robot, wafer, number, wafer.place, begin)
    safe = (place for place in places if not model.safe or safe_after(model, {wafer: (place, number)}))
    return [place for place in [next(safe, None)] if place]


# ------------------------------------------------------------------------------------------------------------ rule 8
def steps_emptied(model, robot):
    """(step, route) that the robot empties, with the wafers that lie there. A robot goes ahead to a wafer that lies in a place."""
    found = {}
    for wafer in model.wafers:
        if not wafer.ended and wafer.lies() and model.carries(robot, wafer):
            found.setdefault((wafer.step, wafer.route), []).append(wafer)
    return found


def round_key(model, step):
    return -step[0], model.routes.index(step[1])


def entry(wafer):
    return wafer.entered, -wafer.lot.get("priority", 0), wafer.order


def first_entered(wafers):
    return min(wafers, key=entry)


def to_come(model, route, number):
    """Wafers of lots that have arrived which are still to come into a step."""
    return [wafer for wafer in model.wafers if wafer.route == route and not wafer.ended and (wafer.entered is not None or wafer.rows)
            and (wafer.step if wafer.toward is None else wafer.toward) < number and number < len(wafer.steps)]


def backward(model, robot):
    steps = steps_emptied(model, robot)
    order = sorted(steps, key=lambda step: round_key(model, step))
    if robot.behind is not None:
        here = round_key(model, robot.behind)
        order = [step for step in order if round_key(model, step) > here] + [step for step in order if round_key(model, step) <= here]
    for step in order:
        number, route = step
        count, may = model.count(steps[step][0], number)
        if number > 0 and count < may and to_come(model, route, number) and not model.relaxed:
            continue
        for wafer in sorted(steps[step], key=entry):
            places = places_for(model, robot, wafer)
            if places:
                begun = begin_or_go(model, robot, wafer, places)
                if wafer.toward is not None and wafer.place:
                    robot.behind = step
                return begun
    return False


# ------------------------------------------------------------------------------------------------------------ rule 9
def in_order(model, robot):
    """first_come and longest_wait."""
    ready, later = [], []
    for wafer in model.wafers:
        if wafer.ended or not wafer.lies() or wafer.done is None or not model.carries(robot, wafer):
            continue
        arrival = model.arrival(robot, wafer.place.station)
        begin, places = model.picking_from(robot, wafer, arrival), places_for(model, robot, wafer)
        if begin is None or not places:
            continue
        key = (wafer.done, -wafer.lot.get("priority", 0), -wafer.step, wafer.entered, wafer.order)
        key = (wafer.order,) if model.rule == "first_come" else key
        (ready if begin == arrival else later).append(((key if begin == arrival else (begin, *key)), wafer, places))
    if not ready and not later:
        return False
    _, wafer, places = min(ready or later, key=lambda each: each[0])
    return begin_or_go(model, robot, wafer, places)


# ------------------------------------------------------------------------------------------------------------ rule 10
def swap(model, robot):
    aboard = sorted((wafer for wafer in robot.held() if not wafer.ended), key=lambda wafer: (wafer.begun, wafer.order))
    if aboard:
        first = is_open(aim(model, robot, aboard[0]))
        if len(aboard) > 1 and not first and is_open(find_target(model, robot, aboard[1])):
            return swap_loaded(model, robot, aboard[1])
        return not aboard[0].ended and swap_loaded(model, robot, aboard[0])
    steps = steps_emptied(model, robot)
    firsts = {route: first_step(model, robot, route) for route in model.routes}
    coming = [route for route in model.routes if not model.relaxed and to_come_or_there(model, route, firsts[route])]
    wanted = [wafer for (number, route), wafers in steps.items() if route in coming and number == firsts[route] for wafer in wafers]
    wanted = [wafer for wafer in wanted if target_of(model, robot, wafer)]
    if not wanted and not any(steps.get((firsts[route], route)) for route in coming) and coming:
        return False
    if not wanted:
        able = {step: [wafer for wafer in wafers if target_of(model, robot, wafer)]
                for step, wafers in steps.items()}
        able = {step: wafers for step, wafers in able.items() if wafers}
        if not able:
            return False
        earliest = min(number for number, route in able)
        wanted = [wafer for (number, route), wafers in able.items() if number == earliest for wafer in wafers]
    return swap_empty(model, robot, first_entered(wanted))


def first_step(model, robot, route):
    """The first step of a route that the robot empties."""
    firsts = []
    for wafer in model.wafers:
        if wafer.route == route:
            pairs = zip(wafer.steps, wafer.steps[1:])
            firsts += [number for number, (here, after) in enumerate(pairs) if serves_any(robot, here[0]) and serves_any(robot, after[0])][:1]
    return min(firsts, default=None)


def serves_any(robot, places):
    return any(place.station.name in robot.serves for place in places)


def to_come_or_there(model, route, number):
    if number is None:
        return False
    there = [wafer for wafer in model.wafers if wafer.route == route and not wafer.ended and (
        wafer.lies() and wafer.step == number or wafer.toward == number) and wafer.entered is not None]
    return bool(to_come(model, route, number) or there)


def target_of(model, robot, wafer):
    """Where the robot would go with the wafer. It counts with all swaps that follow; None if the last of them leads to no place that is
    or will be empty, or if the tool is not safe then."""
    number, begin = model.following(wafer, wafer.step), model.picking_from(robot, wafer, model.arrival(robot, wafer.place.station))
    start, first, moves = wafer.place, None, {}
    arm = robot.free_arm(wafer.steps[wafer.step][2])
    while wafer not in moves:
        places = model.destinations(robot, wafer, number, start, begin, refilled=first is not None)
        for place in places:    # the best one after which the tool is safe
            if not model.safe or safe_after(model, moves | {wafer: (place, number)}):
                return first or place
        target = best_full(model, robot, wafer, number)
        if places or target is None:
            return None
        first, moves[wafer] = first or target, (target, number)
        wafer, start, begin = target.wafer, target, None
        arm = None if arm is None else 1 - arm
        if not swappable(model, robot, wafer) or wafer.steps[wafer.step][2] and arm == 0:
            return None
        number = model.following(wafer, wafer.step)
    return None


def swap_empty(model, robot, wafer):
    """Empty-handed: it takes the wafer as soon as it is done, wherever it may go then."""
    here = wafer.place
    if model.go(robot, here.station):
        return True
    if not (model.picking_from(robot, wafer, model.now) == model.now and model.free(robot, here.station)):
        if wafer.done is not None and wafer.done <= model.now:
            robot.told = "pump" if model.pressure_from(here.station, robot) != model.now else "waiting for place"
        return False
    model.pick(robot, wafer, target_of(model, robot, wafer))
    return True


def best_full(model, robot, wafer, number):
    """Among the places that are not empty: first those against whose wafer it swaps, the one done first; then any."""
    full = []
    for index, place in enumerate(wafer.steps[number][0]):
        if place.wafer and model.may_enter(robot, place, wafer):
            other = place.wafer
            done = NEVER if other.done is None else other.done
            full.append(((not swappable(model, robot, other), done, -other.lot.get("priority", 0), -other.step, other.entered, index), place))
    return min(full, key=lambda each: each[0])[1] if full else None


def is_open(place):
    """It is or will be empty."""
    return place is not None and (place.wafer is None or place.leaves is not None)


def find_target(model, robot, wafer):
    """Where a wafer aboard goes next: an empty place of its next step, else the place done first."""
    if wafer.destination and wafer.destination.coming is wafer:
        wafer.destination.coming = None
    wafer.destination, wafer.toward = None, model.following(wafer, wafer.step)
    if wafer.toward is None:
        wafer.ended = wafer.lost = True
        return None
    places = model.destinations(robot, wafer, wafer.toward, None, model.now)
    return places[0] if places else best_full(model, robot, wafer, wafer.toward)


def aim(model, robot, wafer):
    """Its next place awaits it from now on."""
    place = find_target(model, robot, wafer)
    if place is not None:
        wafer.destination, place.coming = place, wafer
    return place


def swap_loaded(model, robot, wafer):
    """With a wafer: to an empty place of its next step, else to the place done first; there it waits and swaps."""
    place = aim(model, robot, wafer)
    if place is None:
        if not wafer.ended:
            robot.told = "waiting for place"
        return False
    if model.go(robot, place.station):
        return True
    robot.told = "waiting for place"
    other = place.wafer
    if other is None or place.leaves is not None:
        return carry_on(model, robot)
    able = swappable(model, robot, other) and other.done is not None and other.done <= model.now
    if not able or not model.free(robot, place.station) or robot.free_arm(other.steps[other.step][2]) is None:
        if able and model.pressure_from(place.station, robot) != model.now:
            robot.told = "pump"
        return False
    target = target_of(model, robot, other)
    if target is None:
        return False
    if model.clean_due(place):
        model.pick(robot, other, target)
    else:
        model.swap(robot, wafer, place, target)
    return True
