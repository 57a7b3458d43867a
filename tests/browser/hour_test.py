"""An hour at 1 kHz: its page is small, shows it truly, opens at once, and the scrubber, play and zoom do not stall."""
import os
import statistics
import unittest

import browser
import documents

# The page's own work in a frame, ms; on most screens a frame lasts 16.7 ms. Our page needs a third of this limit; the machine
# may be busy.
FRAME_MS = 16
# From a zoom or a jump that moves the window to the plots that show it.
ZOOM_MS = 250


class Hour(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.document, cls.path = documents.hour()
        cls.page = browser.common()
        # The usual times are about 0.7 s and 0.3 s. These wide limits hold on a busy machine, too.
        cls.limits = (5, 5000)
        cls.work, cls.interactive = cls.page.opened(cls.path, *cls.limits)

    def tearDown(self):
        self.assertEqual(self.page.faults(), [])

    def test_opens(self):
        """Small, quickly, and near to what was."""
        thinning, points = self.document["thinning"], [len(track["t"]) for track in self.document["tracks"]["axes"]]
        work, interactive = self.work, self.interactive
        print(f"hour: {self.path.stat().st_size} bytes, {points} points, off by {thinning['gripper_mm']:.3f} mm at most; {work:.2f} s "
              f"of work to show all of it; interactive after {interactive:.0f} ms, machine's load {os.getloadavg()[0]:.1f}")
        self.assertGreater(self.document["duration_s"], 3500)
        self.assertGreater(sum(points), 30000)
        self.assertLess(self.path.stat().st_size, 3e6)
        self.assertLess(thinning["gripper_mm"], 0.1)
        self.assertLess(thinning["mm"], 0.05)
        self.assertLess(work, self.limits[0])
        self.assertLess(interactive, self.limits[1])

    def spent(self, steps):
        """Milliseconds of the page's work for each of some steps, and from frame to frame."""
        return self.page.driver.execute_async_script("""
            const [steps, done] = arguments, W = Waferhand, spent = [], frames = [];
            const make = new Function('W', 'i', steps.step);
            let i = 0, last = null;
            function frame(stamp) {
                if (last !== null) { frames.push(stamp - last); }
                last = stamp;
                if (i === steps.count) { done([spent, frames]); return; }
                const begin = performance.now();
                make(W, i++);
                W.clock.flush();
                spent.push(performance.now() - begin);
                requestAnimationFrame(frame);
            }
            requestAnimationFrame(frame);""", steps)

    def judge(self, name, steps, limit):
        spent, frames = self.spent(steps)
        median = statistics.median(spent)
        print(f"hour, {name}: work a step, ms: median {median:.2f}, longest {max(spent):.1f}; "
              f"frame to frame, in software GL: median {statistics.median(frames):.1f}, longest {max(frames):.1f}")
        # Where more want to run than there are processors, the page gets a share of one.
        self.assertLess(median, limit * max(1, os.getloadavg()[0] / os.cpu_count()), name)
        return spent

    def test_scrubbing(self):
        self.judge("scrubbing over all", {"step": "W.clock.seek((i * 617 % 1000) / 1000 * W.clock.end)", "count": 100}, FRAME_MS)

    def test_slices(self):
        self.page.seek(1800)
        self.judge("slice by slice", {"step": "W.clock.stepSlice(1)", "count": 50}, FRAME_MS)

    def test_zoom(self):
        self.page.seek(1800)
        self.judge("zooming all plots", {"step": """W.plots.panels.forEach((panel) => { panel.seen = true; });
            W.clock.zoom(i < 8 ? 0.5 : 2)""", "count": 16}, ZOOM_MS)

    def test_play_at_a_hundred(self):
        self.page.js("Waferhand.clock.reset(); Waferhand.clock.seek(0); Waferhand.clock.setSpeed(100); Waferhand.clock.play()")
        self.page.wait("return Waferhand.clock.now > 150", 30)
        self.page.js("Waferhand.clock.pause()")

    def test_cost_does_not_grow_with_points(self):
        """A look-up is a binary search: an hour's costs no more than a few times a second's."""
        cost = self.page.js("""const W = Waferhand, all = W.shown.tracks;
            const head = (axis) => ['t', 'v', 'slope'].reduce((made, key) => Object.assign(made, { [key]: axis[key].slice(0, 20) }), {});
            const few = Object.assign({}, all, { axes: all.axes.map(head) });
            const run = (from, end) => { const begin = performance.now(); for (let i = 0; i < 20000; ++i)
                { W.robot.gripper(from, 0, end * i / 20000); } return performance.now() - begin; };
            run(few, 1); run(all, 3600);
            return [run(few, few.axes[0].t[19]), run(all, 3600)]""")
        print(f"hour: 20,000 poses of 20 points {cost[0]:.0f} ms, of all points {cost[1]:.0f} ms")
        self.assertLess(cost[1], 8 * cost[0] + 20)


if __name__ == "__main__":
    unittest.main()
