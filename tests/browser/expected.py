"""What the page ought to show at a time, computed from the document here: cubics, slerps, the chain of the arm."""
import bisect
import math


def point(times, at):
    """The last point at or before a time, the next one, and how far between them."""
    i = max(bisect.bisect_right(times, at) - 1, 0)
    if i + 1 >= len(times) or at <= times[i]:
        return i, i, 0.0
    return i, i + 1, (at - times[i]) / (times[i + 1] - times[i])


def linear(times, values, at):
    i, k, share = point(times, at)
    if share == 0:
        return values[i]
    if values[i] is None or values[k] is None:
        return None
    return values[i] * (1 - share) + values[k] * share


def curve(track, at):
    """(value, slope) of a curve: Hermite's cubic, by its four basis polynomials; None in a gap."""
    times, values, slopes = track["t"], track["v"], track["slope"]
    if not times or at < times[0]:
        return None, None
    i, k, share = point(times, at)
    if i == k:
        at_point = at == times[i] or values[i] is None
        return values[i], slopes[i] if at_point else 0.0
    if share == 0:
        return values[i], slopes[i]
    if values[i] is None or values[k] is None:
        return None, None
    width, x = times[k] - times[i], share
    value = (values[i] * (1 + 2 * x) * (1 - x) ** 2 + width * slopes[i] * x * (1 - x) ** 2
             + values[k] * x * x * (3 - 2 * x) + width * slopes[k] * x * x * (x - 1))
    slope = (6 * x * (x - 1) * (values[i] - values[k]) / width + slopes[i] * (1 - x) * (1 - 3 * x)
             + slopes[k] * x * (3 * x - 2))
    return value, slope


def step(times, values, at):
    return values[max(bisect.bisect_right(times, at) - 1, 0)]


def slerp(a, b, share):
    a, b = unit(a), unit(b)
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        b, cosine = [-x for x in b], -cosine
    if cosine > 1 - 1e-9:
        mixed = [x + share * (y - x) for x, y in zip(a, b)]
        return unit(mixed)
    angle = math.acos(cosine)
    return [(math.sin((1 - share) * angle) * x + math.sin(share * angle) * y) / math.sin(angle) for x, y in zip(a, b)]


def unit(q):
    size = math.sqrt(sum(x * x for x in q))
    return [x / size for x in q]


def matrix(q):
    """The rotation matrix, row by row."""
    x, y, z, w = unit(q)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


def apply(m, v):
    return [sum(row[i] * v[i] for i in range(3)) for row in m]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def about(angle):
    """The rotation matrix about z."""
    return [[math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0.0, 0.0, 1.0]]


def compose(a, b):
    return [x + y for x, y in zip(a[0], apply(a[1], b[0]))], product(a[1], b[1])


def gripper(document, index, at):
    """(position, rotation matrix) of base_from_gripper: its own, or what follows from the axes."""
    track = document["tracks"]["grippers"][index]
    if track["t"] and at >= track["t"][0]:
        i, k, share = point(track["t"], at)
        r = [linear([0, 1], [track["r"][3 * i + n], track["r"][3 * k + n]], share) for n in range(3)]
        return r, matrix(slerp(track["q"][4 * i:4 * i + 4], track["q"][4 * k:4 * k + 4], share))
    mount = document["machine"]["grippers"][index]
    fixed = mount["r"], matrix(mount["q"])
    axes = [curve(each, at)[0] for each in document["tracks"]["axes"]]
    if mount["axis"] is not None:
        return compose(fixed, ([0.0, 0.0, 0.0], about(axes[mount["axis"]])))
    theta, r, z, yaw = axes[:4]
    return compose(([r * math.cos(theta), r * math.sin(theta), z], about(theta + yaw)), fixed)


def links(document, at):
    """Lift, upper arm, forearm and hand, of an arm whose gripper is the end-effector: two sides of a triangle are known."""
    arm = document["machine"]["arm"]
    r, rotation = gripper(document, 0, at)
    wrist = [r[k] - arm["reach"] * rotation[k][0] for k in range(3)]
    far, out = math.hypot(wrist[0], wrist[1]), math.atan2(wrist[1], wrist[0])
    fold = math.acos(min(far / 2 / arm["link"], 1)) * (-1 if arm["right_handed"] else 1)
    elbow = [arm["link"] * math.cos(out + fold), arm["link"] * math.sin(out + fold), r[2]]
    return [([0, 0, r[2]], about(0)), ([0, 0, r[2]], about(out + fold)), (elbow, about(out - fold)), (wrist, rotation)]


def wafer(document, index, at):
    states = document["tracks"]["wafers"][index]
    state = states[max(bisect.bisect_right([each["t"] for each in states], at) - 1, 0)]
    if state["holder"] is None:
        return state["r"], matrix(state["q"])
    r, rotation = gripper(document, state["holder"], at)
    return [a + b for a, b in zip(r, apply(rotation, state["r"]))], product(rotation, matrix(state["q"]))


def holder(document, index, at):
    states = document["tracks"]["wafers"][index]
    return states[max(bisect.bisect_right([each["t"] for each in states], at) - 1, 0)]["holder"]


def slot(document, station, number):
    number_of = document["names"]["stations"].index(station)
    found = next(each for each in document["slots"] if each["station"] == number_of and each["slot"] == number)
    return found["r"], matrix(found["q"])


def measure(first, second):
    """distance, dX, dY, dz (mm, in the first frame) and the angle between the z axes (degrees)."""
    apart = [b - a for a, b in zip(first[0], second[0])]
    local = [sum(first[1][k][i] * apart[k] for k in range(3)) for i in range(3)]
    z = [[pose[1][k][2] for k in range(3)] for pose in (first, second)]
    cross = [z[0][1] * z[1][2] - z[0][2] * z[1][1], z[0][2] * z[1][0] - z[0][0] * z[1][2], z[0][0] * z[1][1] - z[0][1] * z[1][0]]
    angle = math.degrees(math.atan2(math.hypot(*cross), sum(a * b for a, b in zip(*z))))
    return {"distance": math.hypot(*apart), "dx": local[0], "dy": local[1], "dz": local[2], "angle": angle}
