"""The measuring tool's figures are those of a script's measure, distance and angle, to 1e-9."""
import json
import subprocess
import unittest

import browser
from assemble import ROOT
from documents import FOLDER, PROGRAM

PAIRS = [("base", "EE"), ("EE", "Wafer 1"), ("Wafer 2", "B/10"), ("B/10", "Wafer 2"), ("A", "Wafer 1"), ("A/25", "B/1"),
         ("P", "PA"), ("PA", "EE"), ("P/1", "Wafer 2"), ("Wafer 1", "Wafer 2"), ("A", "B")]
KEYS = ["distance", "dx", "dy", "dz", "angle", "turn"]
COMMANDS = ['wait(0.1)', 'get("A", 1)', 'put("B", 2)', 'get("B", 1)', 'move { yaw = 40 }', 'put("P", 1)', 'rotate("P", 77.5)',
            'get("P", 1)', 'line { dx = -5, dz = 3, speed = 20 }', 'put("B", 10)']


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
    return f'cell "{ROOT}/lua/layouts/paper.lua"\n' + tell.join(COMMANDS) + tell


class Lua(unittest.TestCase):
    def test_figures_are_the_page_s(self):
        FOLDER.mkdir(parents=True, exist_ok=True)
        path, page, data = FOLDER / "measure.lua", FOLDER / "measure_lua.html", FOLDER / "measure_lua.json"
        path.write_text(script())
        said = subprocess.run([PROGRAM, "run", path, "--report", page, "--data", data], cwd=ROOT, check=True,
                              capture_output=True, text=True).stdout
        lines = said.splitlines()[:len(COMMANDS) * len(PAIRS)]
        ends = [command["end_s"] for command in json.loads(data.read_text())["run"]["commands"]]
        self.assertEqual(len(ends), len(COMMANDS))
        shown = browser.plain()
        shown.open(page)
        for i, line in enumerate(lines):
            t, pair = ends[i // len(PAIRS)], PAIRS[i % len(PAIRS)]
            shown.js("arguments[0].forEach((name, i) => { document.getElementById('measure-' + i).value = name; })", pair)
            found = shown.js("return Waferhand.measure.at(arguments[0])", t)
            for key, value in zip(KEYS, line.split()):
                self.assertAlmostEqual(found[key], float(value), delta=1e-9, msg=(t, pair, key))
        self.assertEqual(shown.faults(), [])


if __name__ == "__main__":
    unittest.main()
