"""A live cell: late joiners, slow ones, what is told, and that the run does not notice."""
import json
import os
import re
import socket
import statistics
import subprocess
import time
import unittest

import page

TRANSFER = "lua/examples/01_transfer.lua"
HASH = "e4e148111c08e2e0"


def value(curve, t):
    """A curve of cubics at a time."""
    i = max(k for k, at in enumerate(curve["t"]) if at <= t)
    if i + 1 == len(curve["t"]):
        return curve["v"][i]
    width = curve["t"][i + 1] - curve["t"][i]
    x = (t - curve["t"][i]) / width
    a, b = curve["v"][i:i + 2]
    p, q = (width * slope for slope in curve["slope"][i:i + 2])
    return a + x * (p + x * (3 * (b - a) - 2 * p - q + x * (p + q - 2 * (b - a))))


class Live(unittest.TestCase):
    def serve(self, *arguments, **more):
        served = page.Served(*arguments, **more)
        self.addCleanup(served.kill)
        return served

    def plain(self, script):
        """What the run prints without a page, and its document."""
        path = page.ROOT / "build/live_page.json"
        ran = subprocess.run([page.PROGRAM, "run", script, "--data", path], cwd=page.ROOT, capture_output=True, text=True, check=False)
        return ran.stdout, json.loads(path.read_text())

    def test_run_is_the_same(self):
        """Its table, its status and its hash; it stays until it is ended."""
        plain, _ = self.plain(TRANSFER)
        served = self.serve("run", TRANSFER, "--page", "0", "--rate", "50")
        stream = page.Stream(served, served.document())
        served.said("its page stays until Ctrl-C")
        stream.wait(lambda told: any(what.get("state", {}).get("over") for _, _, what in told))
        status, out = served.end()
        self.assertEqual(status, 0)
        self.assertIn(HASH, out)
        wall = re.compile(r"[0-9.]+ s of wall.*|.*wall.*\n")
        self.assertEqual(wall.sub("", out), wall.sub("", plain))

    def test_whole_past(self):
        """A browser that comes after the end gets all events and commands, and curves that are those of --report."""
        _, wanted = self.plain(TRANSFER)
        served = self.serve("run", TRANSFER, "--page", "127.0.0.1:0")
        served.said("its page stays until Ctrl-C")
        got = served.until(lambda got: got["state"]["over"])
        document = got["document"]
        self.assertEqual(got["state"]["good"], True)
        self.assertEqual(document["run"]["events"], wanted["run"]["events"])
        self.assertEqual([each["text"] for each in document["run"]["commands"]],
                         [each["text"] for each in wanted["run"]["commands"]])
        self.assertEqual(document["run"]["expectations"], wanted["run"]["expectations"])
        self.assertEqual(document["duration_s"], wanted["duration_s"])
        for axis, curve in enumerate(wanted["tracks"]["axes"][:3]):
            # A busy machine may leave out some looks; half of them are there in any case.
            off = sorted(abs(value(document["tracks"]["axes"][axis], t) - value(curve, t))
                         for t in (k / 100 * wanted["duration_s"] for k in range(100)))
            self.assertLess(off[50], 0.5 if axis else 0.002)
        for event in wanted["run"]["events"]:
            t = event["utime"] / 1e6
            for axis, curve in enumerate(wanted["tracks"]["axes"]):
                self.assertAlmostEqual(value(document["tracks"]["axes"][axis], t), value(curve, t), places=3)
        self.assertEqual(document["names"], wanted["names"])
        self.assertEqual(document["scene"], wanted["scene"])

    def test_joins_in_the_middle(self):
        """What a stream adds to a document is what a later document has."""
        served = self.serve("run", TRANSFER, "--page", "0", "--rate", "4")
        first = served.until(lambda got: got["document"]["duration_s"] > 2 and got["document"]["run"]["events"])
        stream = page.Stream(served, first)
        served.said("its page stays until Ctrl-C")
        stream.wait(lambda told: any(what.get("state", {}).get("over") for _, _, what in told))
        last = served.document()["document"]
        numbers = [number for number, _, _ in stream.told]
        self.assertEqual(numbers, sorted(set(numbers)))
        self.assertGreater(sum(kind == "frame" for _, kind, _ in stream.told), 10)
        lists = {name: list(entries) for name, entries in first["document"]["run"].items()}
        stays = [list(each) for each in first["document"]["tracks"]["wafers"]]
        valves = [each["v"][:] for each in first["document"]["tracks"]["valves"]]
        for _, kind, what in stream.told:
            if kind == "growth":
                for name, more in what["lists"].items():
                    lists[name][more["from"]:] = more["list"]
                for i, more in enumerate(what["tracks"]["wafers"]):
                    stays[i] += more
                for i, more in enumerate(what["tracks"]["valves"]):
                    valves[i] += more["v"]
        self.assertEqual(lists, last["run"])
        self.assertEqual(stays, last["tracks"]["wafers"])
        self.assertEqual(valves, [each["v"] for each in last["tracks"]["valves"]])

    def asleep(self, streams, quick):
        """Waits until none of these streams takes a byte more, however much is told to another one."""
        before = None
        while before is None or [stream.at_server() for stream in streams] != before or not all(size for _, size in before):
            before, count = [stream.at_server() for stream in streams], len(quick.told)
            quick.wait(lambda told, count=count: len(told) > count + 10)
        return before

    def test_slow_reader_disturbs_nobody(self):
        """Three readers sleep until their connections are full, and ten read. The ten get all; the run keeps its pace and its memory.
        A sleeper that wakes gets all that counts, too."""
        served = self.serve("run", "tests/bench/hour.lua", "--budget", "1e12", "--page", "0", "--rate", "100")
        first = served.until(lambda got: got["state"]["pace"])
        alone = first["state"]["pace"]
        slow = [page.Stream(served, first, reads=False) for _ in range(3)]
        quick = [page.Stream(served, first) for _ in range(10)]
        full = self.asleep(slow, quick[0])
        memory, before, begun = page.resident(served.process), page.processor(served.process), time.monotonic()
        since = [len(stream.told) for stream in quick]
        for stream, count in zip(quick, since):
            stream.wait(lambda told, count=count: sum(kind == "frame" for _, kind, _ in told[count:]) > 20
                        and sum(bool(what["state"]["pace"]) for _, kind, what in told[count:] if kind == "growth") > 8
                        and any(what["lists"].get("events") for _, kind, what in told[count:] if kind == "growth"))
        after, passed = page.processor(served.process), time.monotonic() - begun
        # They slept all the while, one that is given up to its end.
        for stream, (_, size) in zip(slow, full):
            self.assertIn(stream.at_server(), ((True, size), (False, size), (False, size + 1)))
        self.assertLess(page.resident(served.process) - memory, 8e6)
        # On a slow machine it may be given up meanwhile.
        awake = [stream for stream in slow[:1] if stream.at_server()[0]]
        for stream in awake:
            stream.wake()
        last = served.document()
        for stream in awake + quick:
            stream.wait(lambda told: told[-1:] and told[-1][0] >= last["next"] - 1)
            told = list(stream.told)
            self.assertNotIn("anew", [kind for _, kind, _ in told])
            # Readers join one after the other: each list goes on where the reader's own ends.
            ends = {name: len(entries) for name, entries in first["document"]["run"].items()}
            for _, kind, what in told:
                for name, more in what["lists"].items() if kind == "growth" else ():
                    self.assertLessEqual(more["from"], ends[name])
                    ends[name] = more["from"] + len(more["list"])
            self.assertGreaterEqual(ends["events"], len(last["document"]["run"]["events"]))
        paces = [what["state"]["pace"] for _, kind, what in quick[0].told[since[0]:] if kind == "growth" and what["state"]["pace"]]
        # A machine that has more to do is slower with and without them.
        self.assertGreater(statistics.median(paces), 0.5 * alone)
        print(f"\nstepping at 100x: {(after[0] - before[0]) / passed:.3f} of a core; the page with 10 readers and 3 that sleep: "
              f"{(sum(after[1:]) - sum(before[1:])) / passed:.3f}, for {passed:.1f} s")
        for stream in slow + quick:
            stream.close()

    def test_one_page_takes_little(self):
        """At most 5 % of a core at the pace of the wall clock, with one browser."""
        served = self.serve("run", "lua/examples/23_two_robots.lua", "--page", "0")
        stream = page.Stream(served, served.document())
        stream.wait(lambda told: told)
        before, begun, count = page.processor(served.process), time.monotonic(), len(stream.told)
        stream.wait(lambda told: told[-1][2].get("now", told[-1][2]).get("t", 0) > 4)
        after, passed = page.processor(served.process), time.monotonic() - begun
        taken = (sum(after[1:]) - sum(before[1:])) / passed
        print(f"\nthe page's thread, one reader, two robots: {taken:.3f} of a core; {(len(stream.told) - count) / passed:.0f} messages a second")
        self.assertLess(taken, 0.05)
        stream.close()

    def test_host_and_frames(self):
        """serve: the frames at its port, a command that fails, and RESET, by which all begins anew."""
        served = self.serve("serve", "lua/layouts/paper.lua", "--dialect", "lua/dialects/prompt.lua", "--tcp", "127.0.0.1:0",
                            "--lockstep", "--page", "0")
        served.said("prompt, at ")
        host = next(line.rsplit(" at ", 1)[1].strip() for line in served.lines if "prompt, at " in line)
        address, port = host.split(":")
        stream = page.Stream(served, served.document())
        line = socket.create_connection((address, int(port)), 20)
        answers = line.makefile("r")
        for command, begin in (("GET A 1", "OK"), ("GET B 7", "ERROR"), ("PUT B 2", "OK")):
            line.sendall((command + "\r\n").encode())
            self.assertTrue(answers.readline().startswith(begin))
        stream.wait(lambda told: sum(len(what["lists"].get("frames", {"list": []})["list"]) for _, kind, what in told
                                     if kind == "growth") >= 7)
        run = served.document()["document"]["run"]
        self.assertEqual([each["text"] for each in run["frames"] if each["kind"] == ">"], ["GET A 1\\r\\n", "GET B 7\\r\\n", "PUT B 2\\r\\n"])
        self.assertEqual([each["error"] != 0 for each in run["commands"]], [False, True, False])
        self.assertEqual([each["kind"] for each in run["events"]], ["picked", "released"])
        line.sendall(b"RESET\r\n")
        self.assertTrue(answers.readline().startswith("OK"))
        stream.wait(lambda told: told[-1][1] == "anew" or any(kind == "anew" for _, kind, _ in told))
        self.assertEqual(served.document()["document"]["run"]["commands"], [])
        line.sendall(b"GET A 1\r\n")
        self.assertTrue(answers.readline().startswith("OK"))
        got = served.until(lambda got: got["document"]["run"]["events"])
        self.assertEqual([each["text"] for each in got["document"]["run"]["commands"]], ["GET A 1"])
        self.assertEqual(served.end()[0], 0)

    def test_hold(self):
        """A HOLD: the page says so, stands where the cell stands, and has all frames up to its present; RESUME and STOP end it."""
        served = self.serve("serve", "lua/layouts/paper.lua", "--dialect", "lua/dialects/prompt.lua", "--tcp", "127.0.0.1:0",
                            "--page", "0")
        served.said("prompt, at ")
        host = next(line.rsplit(" at ", 1)[1].strip() for line in served.lines if "prompt, at " in line)
        address, port = host.split(":")
        stream = page.Stream(served, served.document())
        line = socket.create_connection((address, int(port)), 20)
        answers = line.makefile("r")

        def say(text):
            line.sendall((text + "\r\n").encode())
            return answers.readline()

        def is_held(is_so):
            stream.wait(lambda told: [what["state"]["held"] for _, kind, what in told if kind == "growth"][-1:] == [is_so])

        line.sendall(b"GET A 1\r\n")
        at = 0
        for count, goes_on in enumerate(("RESUME", "RESUME", "STOP")):
            stream.wait(lambda told: told and told[-1][2].get("now", told[-1][2]).get("t", 0) > at + 0.1)
            self.assertEqual(say("HOLD"), "OK\n")
            is_held(True)
            status = dict(word.split("=", 1) for word in say("STATUS").split() if "=" in word)
            stream.wait(lambda told: sum("phase=" in each["text"] for _, kind, what in told if kind == "growth"
                                         for each in what["lists"].get("frames", {"list": []})["list"]) > count)
            now = stream.told[-1][2]["now"]
            at = float(status["time"])
            self.assertEqual(now["t"], at)
            self.assertAlmostEqual(now["axes"][1], float(status["r"]), places=3)
            got = served.document()
            self.assertTrue(got["state"]["held"])
            self.assertEqual(got["document"]["duration_s"], now["t"])
            self.assertEqual(got["document"]["run"]["frames"][-1]["at_s"], now["t"])
            self.assertEqual(say(goes_on), "OK\n")
            is_held(False)
        self.assertTrue(answers.readline().startswith("ERROR 52 STOPPED"))
        line.close()

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_killed_simulator(self):
        """The page of motion control stands at the last slice that was answered, with that slice's axes."""
        _, wanted = self.plain("lua/examples/12_three_foups.lua")
        simulator = self.serve("sim", "lua/layouts/three_foups.lua", "--page", "0")
        control = self.serve("mcs", "lua/examples/12_three_foups.lua", "--page", "0")
        stream = page.Stream(control, control.document())
        stream.wait(lambda told: told and told[-1][2].get("now", told[-1][2]).get("t", 0) > 0.3)
        simulator.kill()
        control.said("no answer from the simulator: holding at slice")
        slices = [int(found[1]) for found in (re.search("holding at slice ([0-9]+)", line) for line in control.lines) if found]
        stands = (slices[0] - 1) / 1000
        stream.wait(lambda told: told[-1][2].get("now", told[-1][2])["t"] >= stands)
        now = stream.told[-1][2].get("now", stream.told[-1][2])
        self.assertAlmostEqual(now["t"], stands, places=6)
        self.assertEqual(control.document()["document"]["duration_s"], now["t"])
        for axis, curve in enumerate(wanted["tracks"]["axes"]):
            self.assertAlmostEqual(now["axes"][axis], value(curve, now["t"]), delta=0.02)

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_first_command(self):
        """The page of a simulator shows the first command of a run while it runs, once, though the run was not known when it began."""
        simulator = self.serve("sim", "lua/layouts/paper.lua", "--page", "0")
        stream = page.Stream(simulator, simulator.document())
        control = self.serve("mcs", TRANSFER, "--page", "0", "--rate", "1")
        stream.wait(lambda told: any("GET A 1" in json.dumps(what) for _, _, what in told))
        self.assertLess(simulator.document()["document"]["duration_s"], 1.9)
        self.assertEqual(json.dumps(simulator.document()["document"]["run"]["commands"]).count("GET A 1"), 1)
        control.kill()

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_two_processes(self):
        """sim and mcs, each with its page: both show the run; a second one begins anew, also after the simulator was killed."""
        simulator = self.serve("sim", "lua/layouts/paper.lua", "--page", "0")
        control = self.serve("mcs", TRANSFER, "--page", "0")
        document = control.document()
        out = control.process.stdout.read()
        control.process.wait(20)
        self.assertIn(HASH, out)
        self.assertEqual(document["document"]["source"], "live")
        shown = simulator.until(lambda got: len(got["document"]["run"]["commands"]) == 4
                                and all(each["end_s"] is not None for each in got["document"]["run"]["commands"]))["document"]
        self.assertEqual(shown["duration_s"], 8.283)
        self.assertEqual([each["kind"] for each in shown["run"]["events"]], ["picked", "released"] * 2)
        self.assertEqual([(each["text"], each["error"]) for each in shown["run"]["commands"]],
                         [("GET A 1", 0), ("PUT B 2", 0), ("GET B 1", 0), ("PUT B 10", 0)])
        place = simulator.place
        simulator.kill()
        simulator = self.serve("sim", "lua/layouts/paper.lua", "--page", place)
        prompt = self.serve("mcs", "--layout", "lua/layouts/paper.lua", "--page", "0", stdin=subprocess.PIPE)
        seen = page.Stream(prompt, prompt.document())
        for line in ("GET A 1", "GET B 9", "RESET", "GET A 1"):
            prompt.process.stdin.write(line + "\n")
        prompt.process.stdin.flush()
        seen.wait(lambda told: any(kind == "anew" for _, kind, _ in told))
        got = prompt.until(lambda got: [each["end_s"] is not None for each in got["document"]["run"]["commands"]] == [True])
        self.assertEqual([each["text"] for each in got["document"]["run"]["commands"]], ["GET A 1"])
        got = simulator.until(lambda got: got["document"]["run"]["events"])
        self.assertEqual([each["kind"] for each in got["document"]["run"]["events"]], ["picked"])
        prompt.process.stdin.close()
        prompt.process.wait(20)

    def test_restart(self):
        """The same port again at once; a reader with numbers of the run before is told to begin anew."""
        served = self.serve("run", TRANSFER, "--page", "0", "--rate", "20")
        place, first = served.place, served.document()
        served.kill()
        again = self.serve("run", TRANSFER, "--page", place, "--rate", "20")
        again.document()
        stream = page.Stream(again, first)
        stream.wait(lambda told: told and told[0][1] == "anew")
        stream.close()
        stream = page.Stream(again, dict(again.document(), next=1 << 60))
        stream.wait(lambda told: told and told[0][1] == "anew")
        stream.close()

    def test_refusals(self):
        """An option that cannot be offered is refused by name."""
        for arguments, message in (
                (("run", TRANSFER, "--open"), "--open goes with --page"),
                (("run", TRANSFER, "--rate", "2"), "--rate: 2 (goes with --page"),
                (("run", TRANSFER, "--page", "--counted"), "--counted does not go with --page"),
                (("run", TRANSFER, "--page", "--watch"), "--watch does not go with --page"),
                (("run", TRANSFER, "--page=localhost:80"), "--page: localhost:80: no address"),
                (("run", "lua/examples/33_lots_and_locks.lua", "--page", "0"), "nothing to show (expected robots with axes"),
        ):
            ran = subprocess.run([page.PROGRAM, *arguments], cwd=page.ROOT, capture_output=True, text=True, timeout=30, check=False)
            self.assertEqual(ran.returncode, 2, arguments)
            self.assertIn(message, ran.stderr)
        taken = socket.socket()
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        ran = subprocess.run([page.PROGRAM, "run", TRANSFER, "--page", f"127.0.0.1:{taken.getsockname()[1]}"], cwd=page.ROOT,
                             capture_output=True, text=True, timeout=30, check=False)
        taken.close()
        self.assertEqual(ran.returncode, 2)
        self.assertIn("Address already in use", ran.stderr)


if __name__ == "__main__":
    unittest.main()
