"""What the page shows at a time is what its document says: exactly at points, by cubics in between."""
import json
import random
import subprocess
import unittest

import browser
import documents
import expected


def setUpModule():
    global page
    page = browser.plain()


def shown(value, decimals):
    """A number as the page writes it."""
    text = f"{abs(value):.{decimals}f}"
    return ("\u2212" if value < 0 and float(text) != 0 else "") + text


def times_of(document):
    """The ends, every event, every command's begin and end, points of the tracks, and times between them."""
    times = {0, document["duration_s"]}
    times |= {event["utime"] / 1e6 for event in document["run"]["events"]}
    times |= {command[key] for command in document["run"]["commands"] for key in ("begin_s", "end_s")}
    times |= set(document["tracks"]["axes"][0]["t"][1::3])
    maker = random.Random(7)
    times |= {maker.uniform(0, document["duration_s"]) for _ in range(40)}
    return sorted(times)


class Values(unittest.TestCase):
    names = ["01_transfer", "02_prealigner", "04_scrape", "05_leak"]

    def test_poses(self):
        for name in self.names:
            document, path = documents.example(name)
            page.fresh(path)
            times = times_of(document)
            poses = page.js("""const [times] = arguments, W = Waferhand, tracks = W.shown.tracks;
                const flat = (pose) => [pose.r, [0, 1, 2].map((i) => W.pose.axis(pose.q, i))];
                return times.map((t) => [tracks.grippers.map((_, i) => flat(W.robot.gripper(tracks, i, t))),
                    tracks.wafers.map((_, i) => flat(W.tracks.wafer(tracks, i, t)))])""", times)
            for t, found in zip(times, poses, strict=True):
                self.compare_poses(document, t, name, found)

    def compare_poses(self, document, t, name, found):
        for kind, wanted_of in ((0, expected.gripper), (1, expected.wafer)):
            for i, (r, axes) in enumerate(found[kind]):
                wanted = wanted_of(document, i, t)
                for k in range(3):
                    self.assertAlmostEqual(r[k], wanted[0][k], delta=1e-9, msg=(name, t, kind, i))
                    for row in range(3):
                        self.assertAlmostEqual(axes[k][row], wanted[1][row][k], delta=1e-8, msg=(name, t, kind, i))

    def test_links(self):
        document, path = documents.example("01_transfer")
        page.fresh(path)
        times = times_of(document)[::4]
        links = page.js("""const [times] = arguments, W = Waferhand; return times.map((t) => [0, 1, 2, 3].map((i) => {
            const pose = W.robot.link(W.shown.tracks, i, t);
            return [pose.r, [0, 1].map((k) => W.pose.axis(pose.q, 0)[k])]; }))""", times)
        for t, found in zip(times, links, strict=True):
            for (r, x), wanted in zip(found, expected.links(document, t), strict=True):
                for k in range(3):
                    self.assertAlmostEqual(r[k], wanted[0][k], delta=1e-6)
                for k in range(2):
                    self.assertAlmostEqual(x[k], wanted[1][k][0], delta=1e-8)

    def test_links_of_other_robots(self):
        """At keyframes of the program's own scene, which is thinned."""
        for name, robot, place, stations in documents.OTHER_ROBOTS:
            scene, path = documents.of_robot(name, robot, place, stations)
            page.open(path)
            moved = set()
            frames = documents.keyframes(scene, "link")
            poses = page.js("""return arguments[0].map(([link, t]) => { const pose = Waferhand.robot.link(Waferhand.shown.tracks, link, t);
                return [pose.r, pose.q]; })""", [frame[:2] for frame in frames])
            for (link, t, r, q), (there, turned) in zip(frames, poses, strict=True):
                for k in range(3):
                    self.assertAlmostEqual(there[k], 1000 * r[k], delta=1.2, msg=(name, link, t))
                self.assertGreater(abs(sum(a * b for a, b in zip(turned, q))), 1 - 1e-5, msg=(name, link, t))
                moved.add(link)
            self.assertLessEqual({0, 1, 2, 3} | ({4} if "rail" in robot else set()), moved, msg=name)

    def test_exact_at_points(self):
        """At a point of a track the page computes nothing: the same bits."""
        document, path = documents.example("01_transfer")
        page.fresh(path)
        for track, axis in enumerate(document["tracks"]["axes"]):
            found = page.js("""const [track, times] = arguments, axis = Waferhand.shown.tracks.axes[track];
                return times.map((t) => Waferhand.tracks.curve(axis, t, false))""", track, axis["t"][::3])
            self.assertEqual(found, axis["v"][::3])

    def test_exact_at_events(self):
        """What the run itself measured, where nothing draws wafers onto the pads, and where it says that they ended."""
        for name in ("01_transfer", "02_prealigner"):
            document, path = documents.example(name)
            page.fresh(path)
            run, names = document["run"], document["names"]
            for event in [each for each in run["events"] if each["kind"] in ("picked", "handed_over")]:
                t, g = event["utime"] / 1e6, names["grippers"].index(event["gripper"])
                found = page.js("""const [t, g] = arguments, W = Waferhand, tracks = W.shown.tracks;
                    return ['dr_proj_z', 'dr_proj_xy', 'n1_proj_n2'].map((key) => W.tracks.curve(tracks.proximity[g][key], t, false))""",
                                t, g)
                wanted = [abs(event["dr_proj_z"]), event["dr_proj_xy_norm"], event["n1_proj_n2"]]
                self.assertEqual(found, wanted, (name, t))
            for i, wafer in enumerate(run["wafers"]):
                r = page.js("return Waferhand.tracks.wafer(Waferhand.shown.tracks, arguments[0], Waferhand.clock.end).r", i)
                for k in range(3):
                    self.assertAlmostEqual(r[k], wafer["position"][k], delta=1e-9, msg=(name, i))

    def test_table_of_now(self):
        for name in self.names:
            document, path = documents.example(name)
            page.fresh(path)
            times = times_of(document)[::3]
            tables = page.js("""return arguments[0].map((t) => { Waferhand.clock.seek(t); Waferhand.clock.flush();
                return Array.from(document.querySelectorAll('#now td[data-name]'),
                    (cell) => [cell.dataset.gripper, cell.dataset.name, cell.textContent]); })""", times)
            for t, cells in zip(times, tables, strict=True):
                self.compare_now(document, t, name, cells)

    def compare_now(self, document, t, name, cells):
        texts = {(gripper, key): text for gripper, key, text in cells}
        limits = document["limits"]
        for i, gripper in enumerate(document["names"]["grippers"]):
            r = expected.gripper(document, i, t)[0]
            for k, key in enumerate("xyz"):
                self.assertEqual(texts[gripper, key], shown(r[k], 3), (name, t))
            held = [wafer for k, wafer in enumerate(document["names"]["wafers"]) if expected.holder(document, k, t) == i]
            self.assertEqual(texts[gripper, "holds"], ", ".join(held) or "nothing", (name, t))
            valve = document["tracks"]["valves"][i]
            self.assertEqual(texts[gripper, "valve"], ["open", "closed"][expected.step(valve["t"], valve["v"], t)], (name, t))
            near = document["tracks"]["proximity"][i]
            nearest = document["tracks"]["nearest"][i]
            wafer = expected.step(nearest["t"], nearest["v"], t)
            self.assertEqual(texts[gripper, "nearest"], "none near" if wafer is None else document["names"]["wafers"][wafer])
            for key, limit, decimals in (("dr_proj_z", "projz", 4), ("dr_proj_xy", "projxy", 4), ("n1_proj_n2", "planar", 6)):
                value = expected.curve(near[key], t)[0]
                text = texts[gripper, key]
                if value is None:
                    self.assertEqual(text, "\u2013", (name, t))
                    continue
                value = value if key == "n1_proj_n2" else abs(value)
                ready = value > limits[limit] if key == "n1_proj_n2" else value < limits[limit]
                self.assertEqual(text, shown(value, decimals) + (" \u2713" if ready else " \u2717"), (name, t, key))

    def test_legends(self):
        """The figures beside the plots, axes among them, at the shown time."""
        document, path = documents.example("01_transfer")
        page.fresh(path)
        times = times_of(document)[::5]
        legends = page.js("""Waferhand.plots.panels.forEach((panel) => { panel.seen = true; });
            return arguments[0].map((t) => { Waferhand.clock.seek(t); Waferhand.clock.flush();
                return Array.from(document.querySelectorAll('#axes figcaption .item'),
                    (item) => [item.firstChild.nextSibling.textContent.trim(), item.querySelector('.value').textContent]); })""", times)
        for t, values in zip(times, legends, strict=True):
            self.assertEqual(len(values), 2 * len(document["names"]["axes"]))
            for k, (name, text) in enumerate(values):
                index = next(i for i, axis in enumerate(document["names"]["axes"]) if axis["name"] == name)
                axis, track = document["names"]["axes"][index], document["tracks"]["axes"][index]
                speed = k >= len(document["names"]["axes"])
                value = expected.curve(track, t)[1 if speed else 0]
                value *= 180 / 3.141592653589793 if axis["unit"] == "rad" else 1
                self.assertEqual(text, shown(value, 2 if speed else 3), (t, name, speed))

    def test_verdict_of_a_session(self):
        """Whoever was told errors alone has not passed."""
        document, _ = documents.example("03_missed_pick")
        document["source"], document["run"]["ok"] = "session", True
        for failing, word in ((1, "1 of 2 commands failed"), (2, "no command succeeded"), (0, "no command failed")):
            document["run"]["commands"] = [dict(document["run"]["commands"][0], error=42 if i < failing else 0) for i in range(2)]
            page.open(documents.page_of(document, "session"))
            self.assertIn(word, page.text(".verdict"))

    def test_verdict(self):
        """What a run failed for is said where its expectations do not say it."""
        page.fresh(documents.example("04_scrape")[1])
        self.assertIn("failed", page.text(".verdict"))
        self.assertRegex(page.text(".failure"), "^It failed for too close: EE .* at 4.505.s; hit: EE .* at 4.506.s, though what "
                         "the script expected came about.$")
        page.fresh(documents.example("01_transfer")[1])
        self.assertEqual(page.js("return document.querySelectorAll('.failure').length"), 0)

    def test_reasons(self):
        """What ended a run, what it did not do and what went wrong are each said in a sentence."""
        document = documents.example("04_scrape")[0]
        document["run"]["failure"] = "x.lua:9: no such slot"
        document["run"]["expectations"] = [{"line": n, "text": f"wish {n}", "ok": n == 1} for n in range(1, 6)]
        page.open(documents.page_of(document, "reasons"))
        said = page.js("return Array.from(document.querySelectorAll('.failure'), (each) => each.textContent)")
        self.assertEqual(said[:2], ["The script ended early: x.lua:9: no such slot",
                                    "The script expected what did not come about: wish 2 (line 2); wish 3 (line 3); wish 4 (line 4); "
                                    "1 other."])
        self.assertRegex(said[2], "^It failed for too close: .*6.s[.]$")

    def test_lone_value(self):
        """A value between two gaps is a dot that can be seen."""
        document = documents.example("04_scrape")[0]
        track = next(each for each in document["tracks"]["clearances"] if len(each.get("t", [])) > 4)
        track["gap"] = [2 if i == 2 else None for i in range(len(track["t"]))]
        page.open(documents.page_of(document, "lone"))
        dark = page.js("""const panel = Waferhand.plots.panels.find((each) => each.title === arguments[1]);
            const [x, y] = panel.graph.toDomCoords(arguments[0], 2), pen = panel.graph.hidden_.getContext('2d');
            const image = pen.getImageData(Math.round(x) - 5, Math.round(y) - 5, 11, 11).data;
            return Array.from({ length: 121 }, (_, i) => image[4 * i + 3]).filter((alpha) => alpha > 128).length""",
                       track["t"][2], track["pair"].replace("_", " "))
        self.assertGreaterEqual(dark, 12)

    def test_ticks(self):
        """Neighbours differ in what is written, however narrow the range, and rounding shows nowhere."""
        page.fresh(documents.example("01_transfer")[1])
        told = page.js("""return [[1 - 1.2e-16, 2e-5], [0.99998, 2e-5], [1 - 2e-7, 1e-6], [900.0000001, 5e-7], [900.0000002, 5e-7],
            [3599.999981, 1e-5], [3599.999982, 1e-5], [-2e-17, 3], [0.30000000000000004, 1], [-250, 900]]
            .map(([value, span]) => Waferhand.tick(value, span))""")
        self.assertEqual(told, ["1", "0.99998", "1 \u2212 2e\u22127", "900.0000001", "900.0000002", "3599.999981", "3599.999982", "0",
                                "0.3", "\u2212250"])

    def test_scans(self):
        """Each scan is reached; plot and words are the document's; what is missing is a gap; not sure is shown as such."""
        document = documents.example("09_edge_scan")[0]
        self.assertEqual(len(document["scans"]), 1)
        second = documents.copy.deepcopy(document["scans"][0])
        second.update(number=2, sure=False, missed=40, words=["not sure: the scan does not tell the notch or flat (76)", "a", "b"])
        for key in ("rho", "residual"):
            second[key][1000:1040] = [None] * 40
        document["scans"].append(second)
        page.open(documents.page_of(document, "scans"))
        shown = """const W = Waferhand; return [document.querySelector('#scans .verdict').className,
            document.querySelector('#scans .words').innerText, W.scans.graphs.map((graph) => Array.from(
                { length: graph.numRows() }, (_, i) => Array.from({ length: graph.numColumns() }, (_, k) => graph.getValue(i, k))))]"""
        for scan, kind in zip(document["scans"], ("good", "warn")):
            style, words, (rim, residuals) = page.js(shown)
            self.assertEqual(style, "verdict " + kind)
            for line in scan["words"]:
                self.assertIn(line, words)
            self.assertEqual(len(rim), 3600)
            self.assertEqual(sum(row[1] is None for row in rim), scan["missed"])
            self.assertEqual(sum(row[1] is not None for row in residuals), sum(
                counts and each is not None for counts, each in zip(scan["counts"], scan["residual"])))
            for theta, rho, circle in rim:
                self.assertLess(abs((rho or circle) - circle), 1.3, theta)
            for (_, rho, circle), (_, counts, _) in zip(rim, residuals):
                if counts is not None:
                    self.assertAlmostEqual(rho - circle, counts / 1000, delta=2e-4)
            page.js("document.querySelector('#scans button[title=\"The next scan\"]').click()")
        page.js("Waferhand.scans.graphs[0].updateOptions({ dateWindow: [30, 45] })")
        self.assertEqual(page.js("return Waferhand.scans.graphs[1].xAxisRange()"), [30, 45])
        self.assertEqual(page.faults(), [])

    def test_centrings(self):
        """Each centring is reached; marks, circles and words are the document's; what is not sure is never called fitted."""
        document, path = documents.example("13_centring")
        centrings = document["run"]["centrings"]
        self.assertEqual([each["sure"] for each in centrings], [True, True, False])
        page.open(path)
        shown = """const all = (of) => Array.from(document.querySelectorAll('#centrings ' + of));
            const drawn = all('.blade > figure')[0], circle = (each) => ['cx', 'cy', 'r'].map((key) => Number(each.getAttribute(key)));
            const within = (look) => Array.from(drawn.querySelectorAll(look));
            return [document.querySelector('#centrings .verdict').className, document.querySelector('#centrings .words').innerText,
                circle(drawn.querySelector('.nominal')), within('.circle').map(circle),
                ['rim', 'notch', 'other', 'none'].map((use) => within('.' + use).map((each) => each.textContent)),
                all('figure.wide .dot0').length, document.querySelector('#centrings p.row').innerText]"""
        for centring in centrings:
            style, words, nominal, circles, marks, residuals, key = page.js(shown)
            self.assertEqual(style, "verdict " + ("good" if centring["sure"] else "warn"))
            for line in centring["words"]:
                self.assertIn(line, words)
            scale = nominal[2] / 150
            for circle, candidate in zip(circles, centring["candidates"], strict=True):
                self.assertAlmostEqual((circle[0] - nominal[0]) / scale, candidate["x"], delta=1e-6)
                self.assertAlmostEqual((nominal[1] - circle[1]) / scale, candidate["y"], delta=1e-6)
                self.assertAlmostEqual(circle[2] / scale, candidate["radius"], delta=1e-6)
            for use, found in zip(("rim", "notch", "other", "none"), marks):
                self.assertEqual(found, [f"beam {each['beam']} {each['edge']}: {each['use']}"
                                         for each in centring["crossings"] if each["use"] == use])
            self.assertEqual(residuals, len(centring["crossings"]))
            self.assertEqual("fitted" in key, centring["sure"])
            page.js("document.querySelector('#centrings button[title=\"The next centring\"]').click()")
        self.assertEqual(page.faults(), [])

    def test_centrings_without_a_place(self):
        """Crossings that nothing is told of are not judged, a notch that was known is drawn, and more are counted."""
        document = documents.example("13_centring")[0]
        centring = document["run"]["centrings"][0]
        centring.update(sure=False, error=70, candidates=[], words=["no estimate: too few"], wafer=None)
        centring["known"]["notch_deg"] = 30
        for each in centring["crossings"]:
            each["use"] = "none"
        document["run"].update(centrings=[centring], centrings_left_out=2)
        page.open(documents.page_of(document, "centrings"))
        text = page.text("#centrings")
        for words in ("no estimate: too few", "not judged", "notch", "2 later ones are not shown"):
            self.assertIn(words, text)
        self.assertNotIn("fitted", text)
        self.assertEqual(page.js("return document.querySelectorAll('#centrings figure .none').length"), 4)
        self.assertEqual(page.faults(), [])

    def test_tables(self):
        document, path = documents.example("01_transfer")
        page.fresh(path)
        rows = page.js("""return ['wafers', 'expectations', 'commands', 'events'].map((id) => Array.from(
            document.querySelectorAll(`#${id} tbody tr`), (row) => Array.from(row.cells, (cell) => cell.textContent)))""")
        run = document["run"]
        for row, wafer in zip(rows[0], run["wafers"], strict=True):
            self.assertEqual(row, [wafer["name"], "\u2013", wafer["station"], str(wafer["slot"])]
                             + [shown(wafer[key], 4) for key in ("dx", "dy", "dz", "tilt_deg")])
        self.assertEqual([row[1] for row in rows[1]], [each["text"] for each in run["expectations"]])
        self.assertEqual([row[1:4] for row in rows[2]],
                         [[c["text"], shown(c["begin_s"], 3), shown(c["end_s"], 3)] for c in run["commands"]])
        self.assertEqual([row[:3] for row in rows[3]],
                         [[shown(e["utime"] / 1e6, 3), e["kind"].replace("_", " "), e["wafer"]] for e in run["events"]])
        self.assertIn(run["hash"], page.text("#reproduce"))
        self.assertIn(document["reproduce"], page.text("#reproduce code"))
        self.assertIn(f"{run['throughput']['wafers_per_hour']:.1f}", page.text("#split"))



class Study(unittest.TestCase):
    """The page of a study: what it shows is what the program says, and a click gives the command of that trial."""

    def test_points_and_worst_trials(self):
        path = documents.FOLDER / "study.html"
        documents.FOLDER.mkdir(parents=True, exist_ok=True)
        told = json.loads(subprocess.run(
            [documents.PROGRAM, "study", "lua/examples/07_study.lua", "--trials", "2000", "--worst", "100", "--json", "--report", path],
            cwd=documents.ROOT, check=True, capture_output=True).stdout)
        page.open(path)
        self.assertEqual(page.faults(), [])
        self.assertEqual(page.outside(), [])
        failed = told["trials"] - told["success"]["met"]
        self.assertIn(f"{failed} of 2000 failed", page.text("#head"))
        wafer = told["wafers"][0]
        self.assertEqual(page.js("return document.querySelectorAll('.cloud .point').length"), wafer["count"])
        self.assertEqual(page.js("return document.querySelectorAll('.histograms svg').length"), 5)
        self.assertEqual(page.js("return document.querySelectorAll('#causes .mean, #causes .range').length"),
                         2 * sum(each["failing"]["by_size"] is not None for each in told["drawn"]))
        self.assertEqual(page.js("return Array.from(document.querySelectorAll('#worst button'), (each) => Number(each.textContent))"),
                         [each["trial"] for each in told["worst"]])
        page.js("document.querySelectorAll('#worst button')[3].click()")
        worst = told["worst"][3]
        self.assertEqual(page.text("#chosen code"), f"waferhand study --seed 1 lua/examples/07_study.lua --trial {worst['trial']}")
        self.assertIn(f"Trial {worst['trial']}: {'ok' if worst['ok'] else 'failed'}", page.text("#chosen h2"))
        drawn = page.js("return Array.from(document.querySelectorAll('#chosen dt'), (each) => each.textContent)")
        self.assertIn("Wafer 1 dx", drawn)
        self.assertIn("B yaw", drawn)
        self.assertEqual(page.js("return document.querySelectorAll('.picked').length"), 1)
        page.js("document.querySelector('.cloud .point').dispatchEvent(new MouseEvent('click'))")
        trial = page.js("return document.querySelector('.cloud .point').dataset.trial")
        self.assertTrue(page.text("#chosen code").endswith(f" --trial {trial}"))
        page.shoot("study")

if __name__ == "__main__":
    unittest.main()
