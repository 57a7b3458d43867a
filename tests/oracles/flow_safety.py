"""Which transfers are safe (rule 11)."""


def place_is_mine(place):
    """It is empty, or being emptied: the robot that is under way to it no longer chooses."""
    return place.wafer is None or place.leaves is not None


def swappable(model, robot, other):
    return other.lies() and not other.ended and model.carries(robot, other)


def safe_after(model, moves):
    """One after another each wafer inside can go to its route's end alone, once the moved ones lie where they go: {wafer: (place, step)}."""
    where, inside = {}, []
    for wafer in model.wafers:
        place, step = wafer.place, wafer.step
        if wafer.toward is not None:
            place, step = wafer.destination, wafer.toward
        place, step = moves.get(wafer, (place, step))
        if place is not None:
            where.setdefault(place, []).append(wafer)
        if not wafer.ended and step > 0 and place is not None:
            inside.append((wafer, place, step))
    while inside:
        for each in inside:
            end = way_out(model, where, *each)
            if end is not None:
                break
        else:
            return False
        wafer, place, _ = each
        where[place].remove(wafer)
        where.setdefault(end, []).append(wafer)
        inside.remove(each)
    return True


def way_out(model, where, wafer, place, step):
    """Where the wafer's route ends if it goes alone through places with room, None if it cannot."""
    reached = [place]
    number = model.following(wafer, step, reached)
    while number is not None:
        room = []
        for to in wafer.steps[number][0]:   # two places of a station stand for all: from one to itself nobody carries
            others = sum(place.station is to.station for place in room)
            if others < 2 and not to.station.failed_at(model.now) and is_free(where, to, wafer):
                starts = [start for start in reached if start is not to]
                if any(model.enters(robot, to) for start in starts for robot in model.common[start.station.name, to.station.name]):
                    room.append(to)
        if not room or not has_room(model, where, wafer, number):
            return None
        reached = room
        number = model.following(wafer, number, reached)
    return reached[0]


def is_free(where, place, wafer):
    return place.station.for_ends or all(other is wafer for other in where.get(place, ()))


def has_room(model, where, wafer, number):
    """A step of which places are kept empty (rule 12) has room only beside those."""
    kept = model.partial(wafer, number)
    return not kept or sum(is_free(where, to, wafer) for to in wafer.steps[number][0]) > kept
