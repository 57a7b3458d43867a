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

# Every node below the robots, by its path: where it is in the page's world (y up), whether it has something to show, its colour.
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
const top = viewer.scene_tree.find(['DRAKE_VIEWER', '0']);
walk(top, []);
return found;
"""


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
        cls.nodes = cls.page.js(NODES)

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
        self.assertEqual(len(covers), 2)
        for wafer in self.run_of["wafers"]:
            if wafer["holder"]:
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
        self.assertNotEqual(self.nodes["held/EE/0"]["colour"], self.nodes["held/PA/0"]["colour"])

    def test_nothing_went_wrong_in_the_page(self):
        self.page.drain()
        self.assertEqual([line for line in self.page.errors if "favicon" not in line], [])
        self.page.js("viewer.set_camera_target([0.15, 0.75, 0]); viewer.camera.position.set(0.75, 1.35, 1.15)")
        time.sleep(1)
        pathlib.Path(RUN + ".png").write_bytes(
            base64.b64decode(self.page.cdp("Page.captureScreenshot", format="png")["data"]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
