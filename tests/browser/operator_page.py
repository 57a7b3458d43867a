"""A person commands a cell from its page, by keys and clicks; the recording of it plays again to the same hash.

A file of its own, for it takes a network in which two processes meet: tests/end_to_end/live_operator."""
import pathlib
import subprocess
import sys
import unittest

import browser
import documents

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "end_to_end/page"))
import page as pages  # noqa: E402  its folder was just named

RECORD = documents.FOLDER / "operator.log"
PORTS = documents.FOLDER / "operator_ports.log"


class Operator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = browser.shared(True)

    def open(self, layout, record):
        record.unlink(missing_ok=True)
        self.sim = pages.Served("sim", layout, "--page", "0", "--record", record)
        self.addCleanup(self.sim.kill)
        self.prompt = pages.Served("mcs", "--layout", layout, "--page", "0", "--page-control", stdin=subprocess.PIPE)
        self.addCleanup(self.prompt.kill)
        self.addCleanup(self.page.driver.get, "about:blank")
        self.page.visit("http://" + next(line for line in self.prompt.lines if "#token=" in line).split("http://")[1].strip())

    def end(self, record):
        """Both programs end well, and the recording plays again to the hash that the simulator had."""
        self.prompt.process.stdin.close()
        self.assertEqual(self.prompt.process.wait(60), 0)
        status, _ = self.sim.end()
        self.assertEqual(status, 0)
        played = subprocess.run([pages.PROGRAM, "replay", record], cwd=pages.ROOT, capture_output=True, text=True, check=False)
        self.assertEqual(played.returncode, 0, played.stdout + played.stderr)
        return played.stdout

    def typed(self, text):
        """Typed into what has the focus, as by a keyboard."""
        for sign in text:
            self.page.key(sign)

    def line(self):
        self.press("#line")
        self.page.wait("return document.activeElement.id === 'line'")

    def press(self, selector):
        before, now = None, self.page.box(selector)
        while now != before:  # what comes in between may move it
            self.page.settle()
            before, now = now, self.page.box(selector)
        left, top, width, height = now
        self.page.click(left + width / 2, top + height / 2)

    def choose(self, selector, value):
        self.page.js("const found = document.querySelector(arguments[0]); found.value = arguments[1];"
                     "found.dispatchEvent(new Event('change'))", selector, value)

    def answered(self, text):
        """Waits for an answer that begins so; page.wait outlives a page that is loaded anew."""
        self.page.wait(f"const found = document.getElementById('answer'); return !!found && found.textContent.startsWith({text!r})")
        return self.page.text("#answer")

    def send(self, text, answer):
        self.line()
        self.typed(text)
        self.page.key("Enter")
        return self.answered(f"{text}: {answer}")

    def anew(self, act):
        """After that the page is loaded anew, and all of it is there again."""
        before = self.page.js("return performance.timeOrigin")
        act()
        self.page.wait(f"return performance.timeOrigin !== {before} && performance.getEntriesByName('complete').length > 0"
                       " && !!document.getElementById('restore')")

    def row(self, station):
        """The text beside a station's name."""
        return self.page.js("return Array.from(document.querySelectorAll('#card-stations tr')).find("
                            "(row) => row.cells[0].textContent === arguments[0]).cells[1].textContent", station)

    def test_session(self):
        page = self.page
        self.open("lua/layouts/paper.lua", RECORD)
        self.choose("#rate", "0")
        # Completion as at the prompt: one candidate, a list to choose from, and keys of the page that are letters here.
        self.line()
        self.typed("ge")
        page.key("Tab")
        page.wait("return document.getElementById('line').value === 'GET '")
        page.key("Tab")
        page.wait("return !document.getElementById('candidates').hidden")
        names = page.js("return Array.from(document.querySelectorAll('#candidates button'), (each) => each.textContent)")
        self.assertIn("A", names)
        page.shoot("operator_completion")
        page.js("Array.from(document.querySelectorAll('#candidates button')).find((each) => each.textContent === 'A').click()")
        self.assertEqual(page.js("return document.getElementById('line').value"), "GET A ")
        self.typed("1")
        page.key("Enter")
        self.assertIn('wafer="Wafer 1"', self.answered("GET A 1: OK"))
        # A name in two words, an error, and nothing that is markup.
        self.send('HOLDER "Wafer 1"', "OK holder=EE")
        self.send('GET "<img src=x onerror=alert(1)>" 1', "ERROR ")
        self.assertEqual(page.js("return document.querySelectorAll('img').length"), 0)
        # The arrows recall.
        self.line()
        page.key("ArrowUp")
        page.key("ArrowUp")
        self.assertEqual(page.js("return document.getElementById('line').value"), 'HOLDER "Wafer 1"')
        page.key("Escape")
        self.assertEqual(page.js("return document.getElementById('line').value"), "")
        # A jog: clicks add up; each is a line.
        z = page.js("return Waferhand.shown.names.axes.findIndex((axis) => axis.name.toLowerCase() === 'z')")
        at = page.js(f"return Waferhand.tracks.curve(Waferhand.shown.tracks.axes[{z}], Waferhand.shown.duration, false)")
        self.choose("#jogaxis", str(z))
        self.choose("#jogstep", "1")
        self.press("#jogmore")
        self.press("#jogmore")
        self.press("#jogless")
        page.wait(f"const t = Waferhand.shown.tracks.axes[{z}]; return Waferhand.operator.open === 0"
                  f" && Math.abs(t.v[t.v.length - 1] - {at} - 1) < 1e-3")
        self.choose("#jogaxis", page.js("return Array.from(document.getElementById('jogaxis').options).find((each) => each.textContent === 'z, straight').value"))
        self.press("#jogless")
        page.wait(f"const t = Waferhand.shown.tracks.axes[{z}]; return Waferhand.operator.open === 0"
                  f" && Math.abs(t.v[t.v.length - 1] - {at}) < 1e-3")
        # Kept, changed, taken back, put back.
        self.press("#save")
        kept = float(self.answered("SAVE state1: OK").rsplit("=", 1)[1])
        page.wait("return Array.from(document.getElementById('restore').options).some((each) => each.value === 'state1')")
        self.send("PUT B 2", 'OK wafer="Wafer 1"')
        self.anew(lambda: self.press("#undo"))
        self.answered("UNDO: OK ")
        self.assertAlmostEqual(page.now(), kept, places=6)
        self.send('HOLDER "Wafer 1"', "OK holder=EE")
        self.send("PUT B 2", 'OK wafer="Wafer 1"')
        page.wait("return Array.from(document.getElementById('restore').options).some((each) => each.value === 'state1')")
        self.anew(lambda: self.choose("#restore", "state1"))
        self.answered("RESTORE state1: OK ")
        self.assertAlmostEqual(page.now(), kept, places=6)
        self.send('HOLDER "Wafer 1"', "OK holder=EE")
        # A fault from the list, which the line takes, and its answer.
        self.choose("#faults", "FAULT leak gripper=EE")
        self.typed(" value=0.01")
        page.key("Enter")
        number = self.answered("FAULT leak gripper=EE value=0.01: OK fault=").rsplit("=", 1)[1]
        self.send(f"CLEAR {number}", "OK")
        # A command is held up, goes a slice on, and is stopped.
        self.choose("#rate", "0.2")
        page.wait("return Waferhand.live.state.rate === 0.2")
        self.line()
        self.typed("PUT B 2")
        page.key("Enter")
        page.wait("return document.getElementById('card-tasks').textContent.includes('PUT B 2')")
        self.press("#pause")
        page.wait("return Waferhand.live.state.stands && document.getElementById('liveline').textContent.includes('paused')")
        begun = page.now()
        self.press("#slice")
        page.wait(f"return Waferhand.clock.now > {begun}")
        self.assertAlmostEqual(page.now(), begun + 0.001, places=6)
        page.shoot("operator_paused")
        self.press("#stop")
        page.wait("return document.getElementById('card-errors').textContent.includes('PUT B 2')")
        page.wait("return !Waferhand.live.state.paused")
        self.choose("#rate", "0")
        self.send("RECOVER", "OK ")
        self.send("PUT B 2", "OK ")
        page.shoot("operator")
        self.assertEqual(page.faults(), [])
        out = self.end(RECORD)
        self.assertRegex(out, "hash")
        said = "".join(self.sim.lines)
        # Each line stands in the recording, with its number, as motion control told it.
        log = RECORD.read_bytes()
        for text in ("GET A 1", "SAVE state1", "UNDO", "RESTORE state1", "LINE dz=-1", "FAULT leak gripper=EE value=0.01", "STOP"):
            self.assertIn(text.encode() + b"\0", log, said)

    def test_carrier(self):
        """A carrier is brought, opened and taken away; the page has its wafers as long as they are there."""
        page = self.page
        self.open("lua/layouts/load_ports.lua", PORTS)
        self.choose("#rate", "0")
        self.assertRegex(self.row("LP2"), "^empty")
        self.send("CARRIER LP2 name=C2", "OK ")
        self.send("WAIT_FOR LP2", "OK ")
        page.wait("return Array.from(document.querySelectorAll('#card-stations tr'), (row) => row.textContent)"
                  ".some((text) => text.startsWith('LP2') && text.includes('1: C2.1, 3: C2.3'))")
        # Wafers that are away wait 100 m below: the picture is of the cell all the same. Wafers of a carrier are no faults.
        self.assertLess(page.js("return Math.max(...Waferhand.stage.view.corners.map((corner) => corner.length()))"), 10)
        self.assertEqual(page.js("return Waferhand.shown.events.map((event) => event.kind)"), ["wafer_placed"] * 3)
        page.shoot("operator_carrier")
        self.send("GET LP2 1", 'OK wafer=C2.1')
        page.wait("return Array.from(document.querySelectorAll('#card-stations tr'), (row) => row.textContent)"
                  ".some((text) => text.startsWith('LP2') && !text.includes('C2.1'))")
        self.send("HOME", "OK ")
        self.send("TAKE_AWAY LP2", "OK ")
        page.wait("return Array.from(document.querySelectorAll('#card-stations tr'), (row) => row.textContent)"
                  ".some((text) => text.startsWith('LP2empty'))")
        page.shoot("operator_carrier_gone")
        self.assertEqual(page.faults(), [])
        self.end(PORTS)


if __name__ == "__main__":
    unittest.main()
