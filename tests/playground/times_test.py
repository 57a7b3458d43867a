"""How long each example takes in the playground, from the change that begins its run: to the verdict, and to the picture."""
import os
import unittest

import page_test

VERDICT_MS, PICTURE_MS, AT_LEAST = 300, 600, 26

# Notes the ms from the begin of a run to its verdict, and to its picture.
CLOCK = """
window.took = {};
Playground.on('answer', () => { took.verdict = took.verdict || performance.now() - window.begun; });
Playground.on('seen', () => { took.picture = took.picture || performance.now() - window.begun; });
"""
AGAIN = "window.took = {}; window.begun = performance.now(); Playground.runner.run();"

class Times(page_test.Playground):
    def take(self, name):
        """The best of three runs, or the first of one that is slow, once the example is open and its pages are loaded."""
        page = self.page
        self.choose(name)
        self.shown()
        found = []
        while len(found) < 3 and (not found or found[0]["verdict"] < 3000):
            page.settle()
            page.js(AGAIN)
            page.wait("return !!took.verdict && !!took.picture && !Playground.runner.busy", 180)
            found.append(page.js("return took"))
        return [min(each[key] for each in found) for key in ("verdict", "picture")]

    def test_times(self):
        page = self.page
        page.js(CLOCK)
        names = page.js("return Playground.files.examples().map((path) => path.replace(/^.*\\//, '').replace('.lua', ''))")
        load = max(1, os.getloadavg()[0] / os.cpu_count())
        print(f"\nmachine's load {load:.1f} a processor; ms at best of 3\n{'example':24}{'verdict':>9}{'picture':>9}")
        quick = [0, 0]
        for name in names:
            verdict, picture = self.take(name)
            print(f"{name:24}{verdict:9.0f}{picture:9.0f}")
            quick[0] += verdict < VERDICT_MS * load
            quick[1] += picture < PICTURE_MS * load
        print(f"of {len(names)}: {quick[0]} have the verdict within {VERDICT_MS} ms, {quick[1]} the picture within {PICTURE_MS} ms")
        self.assertGreaterEqual(quick[0], AT_LEAST)
        self.assertGreaterEqual(quick[1], AT_LEAST)

def load_tests(loader, tests, pattern):
    """Its own test alone: the others are page_test's."""
    del loader, tests, pattern
    return unittest.TestSuite([Times("test_times")])

if __name__ == "__main__":
    unittest.main()
