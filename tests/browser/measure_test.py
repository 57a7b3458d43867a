"""The measuring tool: its figures against a computation here, by lists, by keys and by clicks, with WebGL and without. They are those
of a script's measure, distance and angle, to 1e-9."""
import json
import subprocess
import unittest

import browser
import documents
import expected

PAIRS = [("base", "EE"), ("EE", "Wafer 1"), ("Wafer 2", "B/10"), ("B/10", "Wafer 2"), ("A", "Wafer 1"), ("A/25", "B/1"),
         ("P", "PA"), ("PA", "EE"), ("P/1", "Wafer 2"), ("Wafer 1", "Wafer 2"), ("A", "B")]
KEYS = ["distance", "dx", "dy", "dz", "angle", "turn"]
COMMANDS = ['wait(0.1)', 'get("A", 1)', 'put("B", 2)', 'get("B", 1)', 'move { yaw = 40 }', 'put("P", 1)', 'rotate("P", 77.5)',
            'get("P", 1)', 'line { dx = -5, dz = 3, speed = 20 }', 'put("B", 10)']


def setUpModule():
    global document, path
    document, path = documents.example("01_transfer")


class Measure:
    @classmethod
    def setUpClass(cls):
        cls.page = browser.shared(cls.webgl)
        cls.page.open(path)

    @classmethod
    def tearDownClass(cls):
        faults, outside = cls.page.faults(), cls.page.outside()
        assert faults == [] and outside == [], (faults, outside)

    def choose(self, first, second):
        self.page.js("""arguments[0].forEach((name, i) => { const select = document.getElementById('measure-' + i);
            select.value = name; select.dispatchEvent(new Event('change')); })""", [first, second])

    def frame(self, name, t):
        names = document["names"]
        if name == "base":
            return [0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        if name in names["wafers"]:
            return expected.wafer(document, names["wafers"].index(name), t)
        if name in names["grippers"]:
            return expected.gripper(document, names["grippers"].index(name), t)
        station, _, number = name.partition("/")
        return expected.slot(document, station, int(number or 1))

    def told(self, times):
        """At each time: what the tool computes and what it writes."""
        return self.page.js("""return arguments[0].map((t) => { Waferhand.clock.seek(t); Waferhand.clock.flush();
            return [Waferhand.measure.at(t), Object.fromEntries(Array.from(document.querySelectorAll('#measure dd[data-name]'),
                (each) => [each.dataset.name, each.textContent]))]; })""", times)

    def compare(self, first, second, t, told):
        wanted = expected.measure(self.frame(first, t), self.frame(second, t))
        found, texts = told
        for key, value in wanted.items():
            self.assertAlmostEqual(found[key], value, delta=1e-6 if key == "angle" else 1e-9, msg=(first, second, t, key))
            text = texts[key].replace("\u2212", "-").split("\u00a0")
            self.assertAlmostEqual(float(text[0]), value, delta=0.5001e-4, msg=(first, second, t, key))
            self.assertEqual(text[1], "\u00b0" if key == "angle" else "mm")

    def test_figures(self):
        pairs = [("EE", "Wafer 1"), ("Wafer 2", "B/10"), ("A", "Wafer 1"), ("base", "EE"), ("A/25", "B/1"), ("PA", "EE")]
        for first, second in pairs:
            self.choose(first, second)
            times = [0, 1.158, 2.34567, 3.501, 6.0001, document["duration_s"]]
            for t, told in zip(times, self.told(times), strict=True):
                self.compare(first, second, t, told)

    def test_offset_at_the_end_is_the_run_s(self):
        """Wafer 2 in B slot 10, as the run's own table has it."""
        self.choose("B/10", "Wafer 2")
        self.page.seek(document["duration_s"])
        wafer = document["run"]["wafers"][1]
        found = self.page.js("return Waferhand.measure.at(Waferhand.clock.now)")
        for key in ("dx", "dy", "dz"):
            self.assertAlmostEqual(found[key], wafer[key], delta=1e-9)
        self.assertAlmostEqual(found["angle"], wafer["tilt_deg"], delta=1e-6)

    def test_the_line_is_drawn(self):
        """At once, and gone when measuring ends: seen in the picture, the label apart."""
        self.page.seek(2.3)
        self.choose("PA", "Wafer 1")
        pictures = []
        for armed in (False, True, False):
            self.page.js("Waferhand.measure.arm(arguments[0])", armed)
            self.page.settle()
            pictures.append(self.page.js("return Waferhand.stage.view.canvas.toDataURL()"))
        self.assertNotEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[0], pictures[2])

    def test_every_frame_is_there(self):
        options = self.page.js("return Array.from(document.querySelectorAll('#measure-0 option'), (option) => option.value)")
        names = document["names"]
        for name in names["wafers"] + names["grippers"] + names["stations"] + ["base", "A/1", "A/25", "B/10", "P/1"]:
            self.assertIn(name, options)

    def test_key_and_clicks(self):
        self.page.js("document.activeElement.blur(); Waferhand.stage.show('whole'); Waferhand.measure.arm(false)")
        self.page.seek(2.3)
        self.choose("", "")
        self.page.key("m")
        self.assertEqual(self.page.js("return document.activeElement.id"), "measure-0")
        left, top, width, height = self.page.box("#canvas canvas")
        for name in self.clicked:
            x, y = self.spot(name)
            self.page.click(left + x, top + y)
        self.assertEqual(self.page.js("return Waferhand.measure.selects.map((select) => select.value)"), self.clicked)
        self.compare(*self.clicked, 2.4, self.told([2.4])[0])
        self.page.shoot("measure" if self.webgl else "measure_without_webgl")
        self.page.js("document.activeElement.blur()")
        self.page.key("m")
        self.assertFalse(self.page.js("return Waferhand.measure.armed"))


class WithWebGL(Measure, unittest.TestCase):
    webgl = True
    clicked = ["PA", "Wafer 1"]

    def spot(self, name):
        """A little beside the frame's origin, in pixels of the picture: on the body."""
        return self.page.js("""const { view } = Waferhand.stage, mover = view.moving.find((each) => each.name === arguments[0]);
            const point = mover.object.position.clone(); point.x += 0.02; point.y += 0.02;
            const at = point.project(view.rig.camera);
            return [(at.x + 1) / 2 * view.host.clientWidth, (1 - at.y) / 2 * view.host.clientHeight]""", name)


class WithoutWebGL(Measure, unittest.TestCase):
    webgl = False
    clicked = ["EE", "Wafer 1"]  # at one spot: the second click there takes the other

    def spot(self, name):
        return self.page.js("""const { view } = Waferhand.stage, mover = Object.values(view.movers).find((each) =>
            each.name === arguments[0]); return view.panels()[0].spot(mover.pose.r)""", name)

    def test_two_drawings_that_move(self):
        self.assertTrue(self.page.js("return document.getElementById('canvas').classList.contains('flat')"))
        self.assertEqual(self.page.js("return Waferhand.stage.view.panels().length"), 2)
        pictures = []
        for t in (0, 2, 5):
            self.page.seek(t)
            self.page.settle()
            pictures.append(self.page.js("return document.querySelector('#canvas canvas').toDataURL()"))
        self.assertEqual(len(set(pictures)), 3)
        self.page.key("2")
        self.assertEqual(self.page.js("return Waferhand.stage.view.panels().length"), 1)
        self.page.key("1")
        self.page.key("n")
        self.page.key("f")
        self.page.seek(2.4)
        self.page.shoot("without_webgl")

    def test_words_of_marks_do_not_overlap(self):
        """A blade that comes too close and then hits says both, each to be read, in both drawings."""
        browsed = self.page
        browsed.open(documents.example("04_scrape")[1])
        said = browsed.js("""const { view } = Waferhand.stage, pen = view.pen, said = [], fill = pen.fillText;
            pen.fillText = function (words, x, y) { const { width } = pen.measureText(words);
                said.push({ words, left: x, right: x + width, base: y }); fill.call(pen, words, x, y); };
            Waferhand.clock.seek(4.506); Waferhand.clock.flush(); view.still();
            return said.filter(({ words }) => words.includes(' and '))""")
        browsed.shoot("marks_without_webgl")
        browsed.open(path)
        self.assertEqual(sorted(each["words"] for each in said), ["hit: EE finger left and W04"] * 2
                         + ["too close: EE finger left and W04"] * 2)
        for i, one in enumerate(said):
            self.assertLess(one["right"], 1090)
            for other in said[i + 1:]:
                apart = one["right"] <= other["left"] or other["right"] <= one["left"]
                self.assertTrue(apart or abs(one["base"] - other["base"]) >= 13, (one, other))


def script():
    """Tells after each command how all pairs lie."""
    rows = ", ".join(f'{{ "{first}", "{second}" }}' for first, second in PAIRS)
    tell = f"""
for _, pair in ipairs {{ {rows} }} do
  local m = measure(pair[1], pair[2])
  assert(distance(pair[1], pair[2]) == m.distance and angle(pair[1], pair[2]) == m.angle)
  print(("%.17g %.17g %.17g %.17g %.17g %.17g"):format(m.distance, m.dx, m.dy, m.dz, m.angle, m.turn))
end
"""
    return f'cell "{documents.ROOT}/lua/layouts/paper.lua"\n' + tell.join(COMMANDS) + tell


class Lua(unittest.TestCase):
    def test_figures_are_the_page_s(self):
        documents.FOLDER.mkdir(parents=True, exist_ok=True)
        path, page, data = documents.FOLDER / "measure.lua", documents.FOLDER / "measure_lua.html", documents.FOLDER / "measure_lua.json"
        path.write_text(script())
        said = subprocess.run([documents.PROGRAM, "run", path, "--report", page, "--data", data], cwd=documents.ROOT, check=True,
                              capture_output=True, text=True).stdout
        lines = said.splitlines()[:len(COMMANDS) * len(PAIRS)]
        ends = [command["end_s"] for command in json.loads(data.read_text())["run"]["commands"]]
        self.assertEqual(len(ends), len(COMMANDS))
        shown = browser.plain()
        shown.open(page)
        asked = [(ends[i // len(PAIRS)], PAIRS[i % len(PAIRS)]) for i in range(len(lines))]
        figures = shown.js("""return arguments[0].map(([t, pair]) => {
            pair.forEach((name, i) => { document.getElementById('measure-' + i).value = name; });
            return Waferhand.measure.at(t); })""", asked)
        for (t, pair), line, found in zip(asked, lines, figures, strict=True):
            for key, value in zip(KEYS, line.split()):
                self.assertAlmostEqual(found[key], float(value), delta=1e-9, msg=(t, pair, key))
        self.assertEqual(shown.faults(), [])


if __name__ == "__main__":
    unittest.main()
