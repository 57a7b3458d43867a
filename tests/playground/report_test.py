"""A report of --live in a browser, from disk: it plays its run again with other parameters, to native's hash."""
import json
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/browser"))
import browser  # noqa: E402  its folder was just named

TOLD = "document.getElementById('rerun-told').textContent"


def run(script, *options, folder=ROOT):
    done = subprocess.run([ROOT / "build/waferhand", "run", script, *options], cwd=folder, capture_output=True, text=True, check=False)
    return json.loads(done.stdout) if done.stdout.startswith("{") else done


class LiveReport(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        browser.FOLDER.mkdir(parents=True, exist_ok=True)
        cls.page = browser.shared(True)

    def open(self, script, *options, folder=ROOT):
        """Writes and opens the report; waits until the engine has played the run as it was."""
        self.script, self.folder = script, folder
        path = browser.FOLDER / "live.html"
        first = run(script, "--json", "--report", path, "--live", *options, folder=folder)
        self.page.open(path)
        self.page.wait(f"return !!document.getElementById('rerun-told') && {TOLD} !== ''", 120)
        self.assertIn("gives the hash of this report", self.page.text("#rerun-told"))
        return first["hash"]

    def put(self, name, value):
        """Another value, as if typed; waits until the page shows its run, and compares the hash with native's."""
        self.page.js("""const input = document.getElementById(`set-${arguments[0]}`); input.value = arguments[1];
            input.dispatchEvent(new Event('input'))""", name, str(value))

    def shows(self, *options):
        want = run(self.script, "--json", *options, folder=self.folder)["hash"]
        self.page.wait(f"return document.getElementById('rerun-hash')?.textContent === '{want}'"
                       f" && !!window.Waferhand.shown && window.Waferhand.shown.run.hash === '{want}'", 120)
        self.assertEqual(self.page.js("return window.Waferhand.faults.length"), 0)
        return want

    def sound(self):
        self.assertEqual(self.page.outside(), [])
        self.assertEqual(self.page.errors, [])

    def test_cell(self):
        """A cell with axes, played again with a slider, with text, and as it was; a value that is none is refused by name."""
        page = self.page
        script = "lua/examples/20_series.lua"
        first = self.open(script, "--set", "n=2")
        self.assertEqual(page.js("return document.querySelector('#set-n').parentElement.querySelector('input').type"), "range")
        page.js("""const slider = document.querySelector('#set-n').parentElement.querySelector('input'); slider.value = 3;
            slider.dispatchEvent(new Event('input'))""")
        second = self.shows("--set", "n=3")
        self.assertNotEqual(first, second)
        page.shoot("live_report")
        page.js("document.getElementById('rerun-reset').click()")
        self.assertEqual(self.shows("--set", "n=2"), first)
        self.put("n", "none")
        page.wait(f"return {TOLD}.includes('not usable') || {TOLD}.includes('failed')", 60)
        self.sound()

    def test_flow(self):
        """A flow by times alone."""
        script = "lua/examples/34_two_layers.lua"
        first = self.open(script)
        self.put("rule", "first_come")
        self.assertNotEqual(self.shows("--set", "rule=first_come"), first)
        self.sound()

    def test_other_folders(self):
        """Files of folders above, and modules; what has no parameters says so."""
        top = browser.FOLDER / "above"
        (top / "in/side").mkdir(parents=True, exist_ok=True)
        (top / "cell.lua").write_text((ROOT / "lua/layouts/paper.lua").read_text())
        (top / "in/far.lua").write_text("return { slot = params.slot or 2 }\n")
        (top / "in/side/run.lua").write_text('cell "../../cell.lua"\nlocal far = require "far"\nget("A", 1)\nput("B", far.slot)\n')
        (top / "in/side/far.lua").write_text((top / "in/far.lua").read_text())
        first = self.open("../side/run.lua", folder=top / "in/side")
        self.put("slot", 5)
        self.assertNotEqual(self.shows("--set", "slot=5"), first)
        self.open("lua/examples/01_transfer.lua")
        self.assertIn("nothing to change", self.page.text("#rerun"))
        self.sound()

    def test_hostile(self):
        """Values and names are text."""
        page = self.page
        self.open("lua/examples/34_two_layers.lua")
        self.put("rule", '"><img src=x onerror=window.hit=1>')
        page.wait(f"return {TOLD}.includes('not usable') || {TOLD}.includes('failed')", 60)
        page.settle()
        self.assertEqual(page.js("return [window.hit, document.querySelectorAll('img').length]"), [None, 0])


if __name__ == "__main__":
    unittest.main()
