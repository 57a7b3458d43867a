"""Play, pause, speed, scrubber, keys and plots: all show one time and one window of it."""
import json
import os
import time
import unittest

import browser
import documents


def setUpModule():
    global document, path
    document, path = documents.example("01_transfer")


class Time(unittest.TestCase):
    # The control that shows the picture of the cell; beside it one each of play, scrubber and zoom.
    drawn = ["test_opens", "test_whole_cell_is_in_the_picture", "test_play_and_pause", "test_scrubber", "test_zoom_is_shared",
             "test_views_and_switches", "test_riding_along", "test_orbit", "test_link", "test_picture"]

    def setUp(self):
        global page
        page = browser.shared(self._testMethodName in self.drawn)
        page.fresh(path)
        self.events = sorted({event["utime"] / 1e6 for event in document["run"]["events"]})

    def tearDown(self):
        self.assertEqual(page.faults(), [])

    def test_opens(self):
        """Quickly, alone, small."""
        # The usual times are about 0.1 s and 0.25 s. These wide limits hold on a busy machine, too.
        work, interactive = page.opened(path, 2, 10000)
        self.assertEqual(page.outside(), [])
        self.assertLess(path.stat().st_size, 1.5e6)
        self.assertEqual(page.driver.title, document["title"])
        print(f"transfer run: {path.stat().st_size} bytes; {work:.2f} s of work to show all of it; interactive after "
              f"{interactive:.0f} ms, machine's load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
        self.assertLess(work, 2)
        self.assertLess(interactive, 10000)

    def test_whole_cell_is_in_the_picture(self):
        spots = page.js("""const { corners, rig } = Waferhand.stage.view; rig.camera.updateMatrixWorld();
            return corners.map((corner) => corner.clone().project(rig.camera).toArray())""")
        self.assertLess(max(max(abs(x), abs(y)) for x, y, _ in spots), 1)
        self.assertGreater(max(max(abs(x), abs(y)) for x, y, _ in spots), 0.75)

    def test_play_and_pause(self):
        page.key(" ", code="Space")
        self.assertTrue(page.js("return Waferhand.clock.playing"))
        began, at = time.monotonic(), page.now()
        page.wait("return Waferhand.clock.now > 0.8")
        passed = time.monotonic() - began
        self.assertLess(page.now() - at, passed + 0.3)
        page.key(" ", code="Space")
        rests = page.now()
        page.settle()
        self.assertEqual(page.now(), rests)
        self.assertEqual(page.text("#time"), f"{rests:.3f}")

    def test_speed(self):
        page.js("""const select = document.getElementById('speed'); select.value = '100';
            select.dispatchEvent(new Event('change'))""")
        page.click(*self.middle("#play"))
        page.wait("return !Waferhand.clock.playing", 20)
        self.assertEqual(page.now(), document["duration_s"])
        page.key("[")
        self.assertEqual(page.js("return document.getElementById('speed').value"), "50")
        page.js("Waferhand.clock.setSpeed(0.1)")
        page.key(" ", code="Space")
        self.assertEqual(page.js("return [Waferhand.clock.playing, Waferhand.clock.now < 1]"), [True, True])

    def middle(self, selector):
        left, top, width, height = page.box(selector)
        return left + width / 2, top + height / 2

    def test_scrubber(self):
        left, top, width, _ = page.box("#scrubber")
        page.click(left + width / 2, top + 11)
        self.assertAlmostEqual(page.now(), document["duration_s"] / 2, delta=0.02)
        page.drag((left + width / 2, top + 11), (left + width / 4, top + 11))
        self.assertAlmostEqual(page.now(), document["duration_s"] / 4, delta=0.1)
        self.assertIn("seconds", page.js("return document.getElementById('scrubber').getAttribute('aria-valuetext')"))

    def test_keys(self):
        page.key("ArrowRight")
        page.key("ArrowRight")
        self.assertEqual(page.now(), 0.002)
        page.key("ArrowLeft")
        self.assertEqual(page.now(), 0.001)
        for wanted in self.events:
            page.key("ArrowRight", shift=True)
            self.assertEqual(page.now(), wanted)
        self.assertIn("released", page.text("#transport .here"))
        page.key("ArrowLeft", shift=True)
        self.assertEqual(page.now(), self.events[-2])
        page.key("End")
        self.assertEqual(page.now(), document["duration_s"])
        page.key("Home")
        self.assertEqual(page.now(), 0)

    def test_views_and_switches(self):
        for key, name in (("2", "top"), ("3", "side"), ("4", "gripper"), ("1", "whole")):
            page.key(key)
            self.assertEqual(page.js("return Waferhand.stage.shown"), name)
            self.assertEqual(page.js("return document.querySelector('[data-name=%s]').getAttribute('aria-pressed')" % name), "true")
        page.key("n")
        self.assertIn("Wafer 1", page.js("return Array.from(document.querySelectorAll('.tag:not([hidden])'), (tag) => tag.textContent)"))
        self.assertEqual(page.js("return Array.from(document.querySelectorAll('.tag.station:not([hidden])'), (tag) => tag.textContent).sort()"),
                         sorted(document["names"]["stations"]))
        page.key("f")
        self.assertTrue(page.js("return Waferhand.stage.view.triads.every((triad) => triad.visible)"))
        page.key("t")
        self.assertEqual(page.js("return document.documentElement.dataset.theme"), "dark")
        page.key("?")
        self.assertTrue(page.js("return document.getElementById('help').open"))
        page.key("Escape")
        self.assertFalse(page.js("return document.getElementById('help').open"))

    def test_riding_along(self):
        page.key("4")
        before = page.js("return Waferhand.stage.view.rig.camera.position.toArray()")
        page.seek(3)
        page.settle()
        self.assertNotEqual(page.js("return Waferhand.stage.view.rig.camera.position.toArray()"), before)

    def test_orbit(self):
        left, top, width, height = page.box("#canvas canvas")
        before = page.js("return Waferhand.stage.view.rig.camera.position.toArray()")
        page.drag((left + width / 2, top + height / 2), (left + width / 2 + 120, top + height / 2 + 10))
        self.assertNotEqual(page.js("return Waferhand.stage.view.rig.camera.position.toArray()"), before)

    def test_link(self):
        """Moment, window, view and eye come back with the address; nonsense in it is passed over."""
        left, top, width, height = page.box("#canvas canvas")
        page.drag((left + width / 2, top + height / 2), (left + width / 2 + 120, top + height / 2 + 10))
        page.js("Waferhand.clock.setWindow(2, 4)")
        page.seek(2.5)
        state = """const { rig } = Waferhand.stage.view; return [Waferhand.clock.now, ...Waferhand.clock.window,
            ...rig.camera.position.toArray(), ...rig.controls.target.toArray()]"""
        wanted = page.js(state)
        page.key("l")
        address = page.driver.current_url
        self.assertIn("#t=2.5&window=2,4&view=whole&eye=", address)
        page.driver.get("about:blank")
        page.driver.get(address)
        page.wait("return performance.getEntriesByName('complete').length > 0")
        for found, value in zip(page.js(state), wanted, strict=True):
            self.assertAlmostEqual(found, value, delta=1e-3)
        page.js("location.hash = 't=3&view=top&eye=1,2'")
        page.settle()
        self.assertEqual([page.now(), page.js("return Waferhand.stage.shown")], [3, "top"])
        page.js("location.hash = 't=x&window=5,1&view=constructor&gripper=9&eye='")
        page.settle()
        self.assertEqual([page.now(), page.js("return Waferhand.stage.shown")], [3, "top"])

    def test_picture(self):
        """It is saved as a PNG that is named after the run and the moment."""
        page.seek(2.5)
        page.js("HTMLAnchorElement.prototype.click = function () { window.saved = [this.download, this.href]; }")
        page.key("p")
        name, data = page.js("return window.saved")
        self.assertEqual(name, "01_transfer.lua_2.500s.png")
        self.assertTrue(data.startswith("data:image/png;base64,iVBOR"))
        self.assertGreater(len(data), 10000)

    def test_space_on_a_button_is_the_buttons(self):
        page.js("document.getElementById('theme').focus()")
        page.key(" ", code="Space")
        self.assertFalse(page.js("return Waferhand.clock.playing"))
        self.assertEqual(page.js("return document.documentElement.dataset.theme"), "dark")

    def test_events_lead_there(self):
        page.js("document.querySelectorAll('#events button.time')[2].click(); Waferhand.clock.flush()")
        self.assertEqual(page.now(), document["run"]["events"][2]["utime"] / 1e6)

    def cursors(self):
        """Where each plot's and each chart's cursor says the time is, within the window."""
        return page.js("""Waferhand.plots.panels.forEach((panel) => { panel.seen = true; }); Waferhand.clock.seek(Waferhand.clock.now);
            Waferhand.clock.flush(); return Array.from(document.querySelectorAll('.cursor'), (cursor) =>
            cursor.getBoundingClientRect().left + 1)""")

    def test_one_cursor(self):
        page.seek(2.5)
        at = self.cursors()
        self.assertGreater(len(at), 8)
        self.assertLess(max(at) - min(at), 1.5)
        x = page.js("""const panel = Waferhand.plots.panels[0]; return panel.host.getBoundingClientRect().left
            + panel.graph.toDomXCoord(2.5)""")
        self.assertAlmostEqual(at[0], x, delta=1.5)

    def windows(self):
        return page.js("""Waferhand.plots.panels.forEach((panel) => { panel.seen = true; });
            Waferhand.clock.setWindow(...Waferhand.clock.window); Waferhand.clock.flush();
            return Waferhand.plots.panels.map((panel) => panel.graph.xAxisRange())""")

    def test_zoom_is_shared(self):
        left, top, width, height = page.box("#proximity .graph")
        page.drag((left + width * 0.4, top + height / 2), (left + width * 0.6, top + height / 2))
        low, high = page.js("return Waferhand.clock.window")
        self.assertAlmostEqual(high - low, 0.2 * document["duration_s"] * width / (width - 102), delta=0.15)
        for window in self.windows():
            self.assertAlmostEqual(window[0], low, delta=1e-6)
            self.assertAlmostEqual(window[1], high, delta=1e-6)
        page.box("#proximity .graph")
        page.click(left + width * 0.5, top + height / 2, 1)
        page.click(left + width * 0.5, top + height / 2, 2)
        page.settle()
        self.assertEqual(page.js("return Waferhand.clock.window"), [0, document["duration_s"]])
        left, top, width, height = page.box("#holders canvas")
        page.drag((left + width * 0.5, top + 10), (left + width * 0.7, top + 10))
        self.assertLess(page.js("return Waferhand.clock.window[1] - Waferhand.clock.window[0]"), 2.5)
        page.key("0")
        self.assertEqual(page.js("return Waferhand.clock.window"), [0, document["duration_s"]])

    def test_click_in_a_plot_goes_there(self):
        left, top, width, height = page.box("#proximity .graph")
        wanted = page.js("return Waferhand.plots.panels[0].graph.toDataXCoord(arguments[0])", width / 2)
        page.click(left + width / 2, top + height / 2)
        page.settle()
        self.assertAlmostEqual(page.now(), wanted, delta=0.02)

    def test_window_follows(self):
        page.js("Waferhand.clock.setWindow(0, 1)")
        page.seek(5)
        low, high = page.js("return Waferhand.clock.window")
        self.assertTrue(low <= 5 <= high)

    def test_copy(self):
        page.cdp("Browser.grantPermissions", permissions=["clipboardReadWrite", "clipboardSanitizedWrite"])
        page.click(*self.middle("#copy"))
        page.wait("return document.getElementById('copy').textContent === 'Copied'", 5)


class Cycles(unittest.TestCase):
    """A run of many cycles opens with the first steady one; combs become bands."""

    def setUp(self):
        text, self.path = documents.cycles()
        self.document = json.loads(text)
        self.steady = self.document["run"]["steady_cycle"]
        self.page = browser.plain()
        self.page.fresh(self.path)

    def tearDown(self):
        self.assertEqual(self.page.faults(), [])

    def window(self):
        return self.page.js("return Waferhand.clock.window")

    def assert_window(self, low, high):
        self.assertAlmostEqual(self.window()[0], low, delta=1e-6)
        self.assertAlmostEqual(self.window()[1], high, delta=1e-6)

    def said(self):
        return self.page.text(".zoom .window").replace("\u00a0", " ")

    def test_the_first_steady_cycle_is_in_view(self):
        begins = [each["begin_s"] for each in self.document["run"]["cycles"]]
        self.assertEqual([self.steady["begin_s"], self.steady["end_s"]], begins[1:3])
        self.assert_window(*begins[1:3])
        self.assertAlmostEqual(self.page.now(), begins[1], delta=1e-6)
        self.assertEqual(self.said(), f"Shown: the first steady cycle, {self.steady['times']} like it in a row: "
                         f"{begins[1]:.3f} s to {begins[2]:.3f} s of {self.document['duration_s']:.3f} s")
        self.page.key("0")
        self.assert_window(0, self.document["duration_s"])
        self.assertEqual(self.said(), f"Shown: the whole run, {self.document['duration_s']:.3f} s")
        self.page.key("c")
        self.assert_window(*begins[1:3])
        pressed = "return document.querySelector('.zoom [aria-keyshortcuts=c]').getAttribute('aria-pressed')"
        self.assertEqual(self.page.js(pressed), "true")
        self.page.key("-")
        self.assertEqual(self.page.js(pressed), "false")

    def test_a_link_to_the_whole_run(self):
        self.page.key("0")
        self.page.key("l")
        self.assertIn("window=0,", self.page.driver.current_url)
        address = self.page.driver.current_url
        self.page.driver.get("about:blank")
        self.page.driver.get(address)
        self.page.wait("return performance.getEntriesByName('complete').length > 0")
        self.assert_window(0, self.document["duration_s"])

    def test_no_cycle_no_guess(self):
        for run, words in (({"found": False, "reason": "of no reason"}, "of no reason"), ({}, "the document holds none"),
                           ({"found": True, "begin_s": 5, "end_s": 1e9}, "the document holds none")):
            made = dict(self.document, run=dict(self.document["run"], steady_cycle=run))
            made["run"]["commands"] = made["run"]["commands"] * 3
            self.page.open(documents.page_of(made, "no_cycle"))
            self.assert_window(0, made["duration_s"])
            self.assertTrue(self.said().endswith(f"; no steady cycle: {words}"), self.said())
            self.assertEqual(self.page.js("return document.querySelectorAll('.zoom [aria-keyshortcuts=c]').length"), 0)

    def test_bands(self):
        """A comb's lowest, highest and mean values in columns of pixels; a gap is one."""
        found = self.page.js("""const t = [], v = [];
            for (let i = 0; i <= 4000; ++i) { t.push(i / 100); v.push(i % 4 === 1 ? 3 : i % 4 === 3 ? -1 : 1); }
            const gap = v.map((value, i) => (i > 2000 ? null : value)), { bands } = Waferhand;
            return [bands.isComb(v, 400), bands.isComb(v.slice(0, 50), 400), bands.curve([t, v], [0, 40], 400),
                bands.curve([t, gap], [0, 40], 400), bands.curve([[0, 40], [0, 8]], [0, 40], 80)]""")
        comb, few, band, half, ramp = found
        self.assertEqual([comb, few], [True, False])
        self.assertEqual([len(band["t"]), set(band["low"]), set(band["high"])], [50, {-1}, {3}])
        for mean in band["mean"]:
            self.assertAlmostEqual(mean, 1, delta=0.01)
        self.assertEqual([half["low"].count(None), half["mean"][24] is None, half["mean"][26]], [24, False, None])
        self.assertEqual(len(ramp["mean"]), 10)
        for i, (low, mean, high) in enumerate(zip(ramp["low"], ramp["mean"], ramp["high"], strict=True)):
            for value, wanted in ((low, 0.8 * i), (mean, 0.8 * i + 0.4), (high, 0.8 * i + 0.8)):
                self.assertAlmostEqual(value, wanted, delta=1e-9)

    def test_shares(self):
        """Bars too close to be seen are as high as their share of a column's time; the shares add up."""
        columns = self.page.js("""const bars = [];
            for (let i = 0; i < 1000; ++i) { bars.push({ from: i / 100, to: i / 100 + 0.0025, colour: i % 2 ? 's0' : 's1' }); }
            return [Waferhand.bands.areDense(0, 1000, 400), Waferhand.bands.areDense(0, 50, 400),
                Waferhand.bands.shares(bars, [0, 20], 400).map((column) => [column.get('s0') || 0, column.get('s1') || 0])]""")
        self.assertEqual(columns[:2], [True, False])
        for i, (even, odd) in enumerate(columns[2]):
            self.assertAlmostEqual(even, 0.125 if i < 25 else 0, delta=1e-6)
            self.assertAlmostEqual(odd, 0.125 if i < 25 else 0, delta=1e-6)

    def test_a_comb_is_drawn_as_a_band(self):
        made = json.loads(json.dumps(self.document))
        curve = made["tracks"]["axes"][1]
        curve["t"] = [i * made["duration_s"] / 5000 for i in range(5001)]
        curve["v"] = [400 + 100 * (i % 2) for i in range(5001)]
        curve["slope"] = [0] * 5001
        made["tracks"]["valves"][0] = {"t": curve["t"], "v": [i % 2 for i in range(5001)]}
        self.page.open(documents.page_of(made, "comb"))
        self.page.key("0")
        self.page.js("document.getElementById('axes').scrollIntoView()")
        self.page.settle()
        bands = self.page.js("""Waferhand.plots.showAll(); return Waferhand.plots.panels.map((panel) =>
            [panel.curves.map((curve, i) => curve.name + (panel.bands[i] ? '*' : '')).join(), panel.banded.hidden])""")
        self.assertIn(["R*,Z", False], bands)
        self.assertIn(["theta,yaw,PA chuck", True], bands)
        self.assertEqual(self.page.js("return Array.from(document.querySelectorAll('p.banded'), (each) => each.hidden)"),
                         [False, True, True])
        self.page.shoot("comb")


if __name__ == "__main__":
    unittest.main()
