"""meldis.py PAGE RUN: Drake's viewer in a browser that comes late. Its scene is compared with RUN.json, what `mcs --json` said, and
with RUN.heard, what another program heard of the cell; a screenshot goes to RUN.png."""
import base64
import json
import pathlib
import re
import sys
import time
import unittest

from browser import WEBGL, Browser

PAGE, RUN = sys.argv[1], sys.argv[2]

# Every node below the robots, by its path: its place in the page's world (y up), whether it shows something, and its colour.
NODES = """
const found = {};
const walk = (node, path) => {
    const at = node.object.matrixWorld.elements;
    const mesh = node.children['<object>'] && node.children['<object>'].object;
    let meshes = 0, colour = null;
    if (mesh) mesh.traverse((each) => {
        if (each.isMesh) { meshes += 1; colour = each.material.color.getHexString(); }
    });
    found[path.join('/')] = { at: [at[12], -at[14], at[13]], meshes, colour, visible: node.object.visible };
    for (const name of Object.keys(node.children)) if (name !== '<object>') walk(node.children[name], path.concat([name]));
};
viewer.scene_tree.object.updateMatrixWorld(true);
for (const top of arguments) walk(viewer.scene_tree.find(top), []);
return found;
"""
CELL, BOARD = ["DRAKE_VIEWER", "0"], ["Visual Geometry", "0"]

# The part of the picture that the corners of all shapes take, from -1 to 1 to the right and up. Shapes that are put aside do
# not count.
PICTURE = """
const times = (m, [x, y, z, w]) => [0, 1, 2, 3].map((row) => m[row] * x + m[row + 4] * y + m[row + 8] * z + m[row + 12] * w);
const box = [1e9, 1e9, -1e9, -1e9];
viewer.scene_tree.object.updateMatrixWorld(true);
viewer.camera.updateMatrixWorld(true);
const view = viewer.camera.matrixWorld.clone().invert().elements;
for (const top of arguments) viewer.scene_tree.find(top).object.traverse((each) => {
    const world = each.matrixWorld.elements;
    if (!each.isMesh || Math.abs(world[13]) > 100) return;
    const points = each.geometry.attributes.position;
    for (let i = 0; i < points.count; i += 1) {
        const [x, y, z, w] = times(viewer.camera.projectionMatrix.elements,
                                   times(view, times(world, [points.getX(i), points.getY(i), points.getZ(i), 1])));
        if (w <= 0) box[0] = -1e9;
        box[0] = Math.min(box[0], x / w); box[1] = Math.min(box[1], y / w);
        box[2] = Math.max(box[2], x / w); box[3] = Math.max(box[3], y / w);
    }
});
return box;
"""
SEGMENTS = dict(zip("0123456789", (6, 2, 5, 5, 4, 5, 6, 3, 7, 6)))


def written(name):
    """A name as sim writes it."""
    return "".join(f"%{ord(c):02X}" if c in "/:%" else c for c in name)


class Shown(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_of = json.loads(pathlib.Path(RUN + ".json").read_text())
        cls.page = Browser(flags=WEBGL + ["--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost"], size=(1200, 800))
        cls.page.driver.get(PAGE)
        end = time.monotonic() + 60
        while cls.page.js("return typeof viewer === 'undefined' || !viewer.scene_tree.find(['DRAKE_VIEWER', '0', 'wafers', "
                          "arguments[0]]).children['0']", written(cls.run_of["wafers"][0]["name"])):
            assert time.monotonic() < end, "no wafer is shown"
            time.sleep(0.2)
        time.sleep(1)
        cls.nodes = cls.page.js(NODES, CELL)
        cls.board = cls.page.js(NODES, BOARD)
        cls.hits = [event["parts"] for event in cls.run_of["events"] if event["kind"] == "hit"]

    @classmethod
    def tearDownClass(cls):
        cls.page.close()

    def near(self, path, mm, message=None):
        for shown, wanted in zip(self.nodes[path]["at"], mm):
            self.assertAlmostEqual(shown, wanted / 1000, delta=2e-6, msg=message or path)

    def test_wafers_where_the_run_left_them(self):
        for wafer in self.run_of["wafers"]:
            path = "wafers/" + written(wafer["name"])
            self.near(path, wafer["position"])
            self.assertTrue(self.nodes[path]["visible"])

    def test_held_wafers_are_covered(self):
        covers = {path for path in self.nodes if path.startswith("held/") and path.count("/") == 1}
        self.assertGreaterEqual(len(covers), 1)
        for wafer in self.run_of["wafers"]:
            if wafer["holder"] and not any(wafer["name"] in parts for parts in self.hits):
                cover = "held/" + written(wafer["holder"])
                self.near(cover, wafer["position"])
                covers.discard(cover)
        for cover in covers:
            self.near(cover, (0, 0, -1e6))

    def test_every_shape_is_there(self):
        """The viewer itself leaves nodes of earlier cells behind, which show nothing."""
        heard = re.search(r"LOAD (\d+) bodies, (\d+) shapes: (.*)", pathlib.Path(RUN + ".heard").read_text())
        bodies = [body.replace("::", "/") for body in heard.group(3).split(", ")]
        shapes = {path: node for path, node in self.nodes.items() if node["meshes"] > 0}
        self.assertEqual(len(bodies), int(heard.group(1)))
        self.assertEqual(len(shapes), int(heard.group(2)))
        self.assertLessEqual({path.rpartition("/")[0] for path in shapes}, set(bodies))
        self.assertLessEqual(set(bodies), set(self.nodes) | {"obstacles"})
        if "held/PA/0" in self.nodes:
            self.assertNotEqual(self.nodes["held/EE/0"]["colour"], self.nodes["held/PA/0"]["colour"])

    def test_the_camera_shows_all_and_little_else(self):
        left, low, right, high = self.page.js(PICTURE, CELL, BOARD)
        self.assertGreaterEqual(min(left, low), -1)
        self.assertLessEqual(max(right, high), 1)
        self.assertGreater(max(right - left, high - low), 1.6)

    def test_what_collided_is_red(self):
        red = {path for path, node in self.nodes.items() if node["meshes"] and self.is_red(node["colour"])}
        self.assertEqual(len(red), 2 * len(self.hits[:1]), red)
        for name in self.hits[0] if self.hits else []:
            gripper_or_wafer = written(name.split(" ")[0])
            self.assertTrue(any(f"/{gripper_or_wafer}/" in path for path in red), (name, red))
        for line in ("board/hit", "board/with"):
            self.assertEqual(self.lines(line), len(self.hits[:1]), line)

    @staticmethod
    def is_red(colour):
        red, green, blue = (int(colour[i:i + 2], 16) for i in (0, 2, 4))
        return red > 150 and green < 40 and blue < 60

    def lines(self, path):
        return sum(node["meshes"] > 0 for each, node in self.board.items() if each.startswith(path + "/"))

    def test_the_board_shows_the_time(self):
        on = sum(SEGMENTS[digit] for digit in f"{int(10 * self.run_of['simulated_s'] + 1e-6):02d}")
        shown = [path for path, node in self.board.items() if node["meshes"] > 0 and "/time " in path and node["at"][2] > -100]
        self.assertEqual(len(shown), on, shown)
        self.assertEqual(self.lines("board/command"), 0, "no command runs any more")

    def test_nothing_went_wrong_in_the_page(self):
        self.page.drain()
        self.assertEqual([line for line in self.page.errors if "favicon" not in line], [])
        pathlib.Path(RUN + ".png").write_bytes(
            base64.b64decode(self.page.cdp("Page.captureScreenshot", format="png")["data"]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
