"""viewer.py [OPTIONS OF MELDIS]: Drake's viewer, meldis, with a camera that shows the whole cell. LCM has no message for the camera.
So this program looks at the bodies that the viewer shows, and places the camera when a cell comes that is not the one before."""
import itertools

import numpy
from drake import lcmt_viewer_draw, lcmt_viewer_geometry_data, lcmt_viewer_load_robot
from pydrake.common.eigen_geometry import Quaternion
from pydrake.visualization import meldis

# The viewer's position, from the cell's middle: as in board.c, whose writing faces it.
FROM = numpy.array([1.1, -1.3, 1.1])
# The camera's angle up and down, deg, and the narrowest window for which all is seen, width by height.
ANGLE, NARROWEST = 30, 1.3
# Bodies this far away, m, are hidden on purpose.
AWAY = 100
CHANNELS = ("", "_ILLUSTRATION")


def half_lengths(shape):
    """Half of the box around a shape along its own axes, and the box's middle."""
    lengths = shape.float_data
    if shape.type == lcmt_viewer_geometry_data.BOX:
        return numpy.array(lengths) / 2, numpy.zeros(3)
    if shape.type == lcmt_viewer_geometry_data.SPHERE:
        return numpy.full(3, lengths[0]), numpy.zeros(3)
    if shape.type == lcmt_viewer_geometry_data.CYLINDER:
        return numpy.array([lengths[0], lengths[0], lengths[1] / 2]), numpy.zeros(3)
    if shape.type == lcmt_viewer_geometry_data.CAPSULE:
        return numpy.array([lengths[0], lengths[0], lengths[1] / 2 + lengths[0]]), numpy.zeros(3)
    if shape.type != lcmt_viewer_geometry_data.MESH or shape.string_data or len(lengths) < 5:
        return numpy.zeros(3), numpy.zeros(3)  # another program's, of which only the place is known
    points = numpy.array(lengths[2 : 2 + 3 * int(lengths[0])]).reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    return (high - low) / 2, (high + low) / 2


def moved(points, position, wxyz):
    return numpy.array(position) + points @ Quaternion(wxyz=wxyz / numpy.linalg.norm(wxyz)).rotation().T


def corners(load, draw):
    """The corners of boxes around all shapes where they are drawn, in the world."""
    places = {name: (draw.position[i], draw.quaternion[i]) for i, name in enumerate(draw.link_name)}
    found = [numpy.zeros((0, 3))]
    for link in load.link:
        position, turn = places.get(link.name, (None, None))
        if position is None or max(map(abs, position)) > AWAY:
            continue
        for shape in link.geom:
            half, middle = half_lengths(shape)
            signs = numpy.array(list(itertools.product((-1, 1), repeat=3)))
            found.append(moved(moved(middle + signs * half, shape.position, shape.quaternion), position, turn))
    return numpy.concatenate(found)


def camera_for(points):
    """Where the camera stands so that all points are just within the picture, and what it looks at."""
    back = FROM / numpy.linalg.norm(FROM)
    right = numpy.cross((0, 0, 1), back)
    right /= numpy.linalg.norm(right)
    up = numpy.cross(back, right)
    tangent = numpy.tan(numpy.radians(ANGLE) / 2)
    target = (points.min(axis=0) + points.max(axis=0)) / 2
    distance = 0.1
    for _ in range(8):  # near parts look larger, so the middle of the picture is not that of the box
        x, y, z = (points - target) @ right, (points - target) @ up, (points - target) @ back
        distance = 1.05 * max((abs(y) / tangent + z).max(), (abs(x) / tangent / NARROWEST + z).max(), 0.1)
        across, above = x / (distance - z), y / (distance - z)
        target = target + distance / 2 * ((across.max() + across.min()) * right + (above.max() + above.min()) * up)
    return target + distance * back, target


def what_it_is(load):
    """All of it but the colours, and what is written."""
    return [(link.name, [(shape.type, shape.position, shape.float_data) for shape in link.geom]) for link in load.link
            if not link.name.startswith(("board::command", "board::hit", "board::with"))]


class Viewer(meldis._Meldis):
    def __init__(self, **arguments):
        super().__init__(**arguments)
        self._loads, self._known, self._corners = {}, {}, {}
        for channel in CHANNELS:
            self._subscribe("DRAKE_VIEWER_LOAD_ROBOT" + channel, lcmt_viewer_load_robot,
                            lambda message, channel=channel: self._on_load(channel, message))
            self._subscribe("DRAKE_VIEWER_DRAW" + channel, lcmt_viewer_draw,
                            lambda message, channel=channel: self._on_draw(channel, message))

    def _on_load(self, channel, message):
        if what_it_is(message) != self._known.get(channel):
            self._known[channel] = what_it_is(message)
            self._loads[channel] = message

    def _on_draw(self, channel, message):
        load = self._loads.pop(channel, None)
        if load is None:
            return
        self._corners[channel] = corners(load, message)
        points = numpy.concatenate(list(self._corners.values()))
        if len(points) > 0:
            self.meshcat.SetCamera(self.meshcat.PerspectiveCamera(fov=ANGLE, far=1000))
            self.meshcat.SetCameraPose(*camera_for(points))


if __name__ == "__main__":
    meldis._Meldis = Viewer
    meldis._main()
