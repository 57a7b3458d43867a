"""--page-control: the token, what a run and a served cell take, and that a session plays again to the same hash."""
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


class Control(unittest.TestCase):
    def serve(self, *arguments, **more):
        served = page.Served(*arguments, **more)
        self.addCleanup(served.kill)
        line = next(line for line in served.lines if "page at" in line)
        self.token = re.search(r"/#token=([0-9a-f]{32})\n", line)[1]
        return served

    def ask(self, served, request, **headers):
        """(status, answer)"""
        told = {"Content_Type": "application/json", **headers}
        status, _, text = served.ask("/control", method="POST", body=json.dumps(request).encode(), **told)
        return status, text

    def tell(self, served, **request):
        status, text = self.ask(served, dict(request, token=self.token))
        self.assertIn(status, (200, 202), text)
        return json.loads(text)

    def now(self, served):
        return served.document()["document"]["duration_s"]

    def stands(self, served):
        """The document once the cell stands still."""
        return served.until(lambda got: got["state"]["paused"] and got["state"]["stands"])

    def test_run_is_held_up_and_stays_the_same(self):
        """Paused, a slice, a command, another pace; its hash is that of the run alone."""
        served = self.serve("run", TRANSFER, "--page", "0", "--page-control")
        served.document()
        self.tell(served, pause=True)
        stands = self.stands(served)["document"]["duration_s"]
        for count in (1, 1, 5):
            self.tell(served, slices=count)
            stands = round(stands + count / 1000, 3)
            served.until(lambda got: got["document"]["duration_s"] >= stands)
            self.assertEqual(self.stands(served)["document"]["duration_s"], stands)
        self.tell(served, command=True)
        got = served.until(lambda got: got["state"]["stands"] and got["document"]["duration_s"] > stands)
        commands = got["document"]["run"]["commands"]
        self.assertEqual(got["document"]["duration_s"], max(each["end_s"] for each in commands if each["end_s"]))
        self.tell(served, rate=50)
        self.tell(served, pause=False)
        served.said("its page stays until Ctrl-C")
        self.assertEqual(served.document()["state"]["rate"], 50)
        status, out = served.end()
        self.assertEqual(status, 0)
        self.assertIn(HASH, out)

    def refused(self, served, text, **request):
        status, answer = self.ask(served, dict(request, token=self.token))
        self.assertEqual((status, json.loads(answer)["ok"]), (400, False), answer)
        self.assertIn(text, json.loads(answer)["text"])

    def test_robots_of_a_flow_are_held(self):
        """Each alone, and all; the flow waits, and goes on to its end. A robot that cannot be held is refused by name."""
        served = self.serve("run", "tests/end_to_end/data/flow_mixed_run.lua", "--set", "wafers=1", "--json", "--page", "0", "--page-control",
                            "--rate", "20")
        for _ in range(500):
            if any(each["text"].startswith("GET ") for each in served.document()["document"]["run"]["commands"]):
                break
            time.sleep(0.02)
        self.assertEqual(served.document()["state"]["robots"], ["VAC", "ATM"])
        self.tell(served, hold="VAC")
        self.refused(served, "error 66 NOT_IN_PHASE: VAC is held already", hold="VAC")
        self.refused(served, "error 92 NO_SUCH_ROBOT: \"PM1\" is no robot of the flow (expected ATM, VAC)", hold="\"PM1\"")
        self.refused(served, "expected a robot's name, or true", hold=7)
        time.sleep(0.5)
        self.assertEqual(served.document()["state"]["held_robots"], "VAC")
        begun, at = len(served.document()["document"]["run"]["commands"]), self.now(served)
        while self.now(served) < at + 20:
            time.sleep(0.05)
        vac = [each for each in served.document()["document"]["run"]["commands"][begun:] if each["text"].split()[0] in ("GET", "PUT", "READY")]
        self.assertEqual(vac, [])
        self.tell(served, **{"continue": "VAC"})
        self.tell(served, hold=True)
        time.sleep(0.2)
        self.assertEqual(served.document()["state"]["held_robots"], "ATM, VAC")
        self.tell(served, pause=True)
        self.refused(served, "the run is paused", **{"continue": True})
        self.tell(served, pause=False)
        self.tell(served, **{"continue": True})
        self.refused(served, "none is held", **{"continue": True})
        self.tell(served, rate=0)
        served.said("its page stays until Ctrl-C", 60)
        self.assertFalse(served.document()["state"]["held"])
        self.refused(served, "no slice of a flow is played now", hold="VAC")
        status, out = served.end()
        self.assertEqual(status, 0)
        flow = json.loads(out)["flow"]
        down = {robot["name"]: robot["shares"]["waits_down"] * flow["counted_s"] for robot in flow["robots"]}
        self.assertEqual(flow["end"], "done")
        self.assertGreater(down["VAC"], 20)
        self.assertGreater(down["ATM"], 0)

    def test_served_cell_plays_again(self):
        """A fault from the page, between a host's commands: the transcript has it, and plays again to the same hash."""
        transcript = page.ROOT / "build/live_page_session.txt"
        transcript.unlink(missing_ok=True)
        served = self.serve("serve", "lua/layouts/paper.lua", "--dialect", "lua/dialects/prompt.lua", "--tcp", "127.0.0.1:0",
                            "--lockstep", "--page", "0", "--page-control", "--transcript", transcript)
        served.said("cell, ")
        place = next(found[1] for found in (re.search(r"prompt.*, at ([0-9.:]+)", line) for line in served.lines) if found)
        host, port = place.split(":")
        line = socket.create_connection((host, int(port)), 20)
        answers = line.makefile("r")

        def command(text, begin):
            line.sendall((text + "\r\n").encode())
            self.assertTrue(answers.readline().startswith(begin), text)

        command("GET A 1", "OK")
        number = self.tell(served, line="ALARM 42")["id"]
        self.assertNotEqual((number - 10**9) // 1000, int(self.token[:4], 16), "a part of the token")

        def told_of(got):
            return [each["text"] for each in got["document"]["run"]["frames"] if each["port"].startswith("control") and each["kind"] == "<"]

        told = told_of(served.until(told_of))
        self.assertIn(f'"id":{number},', told[0].replace("\\", ""))
        self.assertIn("OK fault=", told[0])
        command("PUT B 2", "OK")
        command("GET B 1", "ERROR 42")
        self.tell(served, rate=5)
        served.until(lambda got: len(told_of(got)) == 2)
        line.close()
        status, _ = served.end()
        self.assertEqual(status, 0)
        said = "".join(served.lines)
        self.assertIn("ALARM 42", transcript.read_text())
        played = subprocess.run([page.PROGRAM, "converse", transcript], cwd=page.ROOT, capture_output=True, text=True, check=False)
        self.assertEqual(played.returncode, 0, played.stdout + played.stderr)
        hashes = re.findall(r"hash ([0-9a-f]{16})", said + played.stdout + played.stderr)
        self.assertEqual(len(set(hashes)), 1, hashes)
        self.assertGreaterEqual(len(hashes), 1)

    def test_token(self):
        """Nobody else's, nothing like it, and no time that tells how much of it is right."""
        served = self.serve("run", "lua/examples/12_three_foups.lua", "--page", "0", "--page-control")
        served.document()
        right = self.token
        for token in ("", right[:-1], right + "0", right[:-1] + ("0" if right[-1] != "0" else "1"), right.upper() + "x", None, 7, [right],
                      right + "\u0000", "\u0000" + right, "x" * 3000):
            status, text = self.ask(served, {"token": token, "pause": True})
            self.assertIn(status, (400, 403), (token, text))
        self.assertEqual(self.ask(served, {"pause": True})[0], 403)
        self.assertFalse(served.document()["state"]["paused"])
        times = {}
        for name, token in (("first", "z" + right[1:]), ("last", right[:-1] + "z")):
            times[name] = []
            for _ in range(60):
                begun = time.perf_counter()
                self.ask(served, {"token": token, "pause": True})
                times[name].append(time.perf_counter() - begun)
        print(f"\na wrong first digit {1e6 * statistics.median(times['first']):.0f} us, a wrong last one "
              f"{1e6 * statistics.median(times['last']):.0f} us")
        self.assertNotIn(right, "".join(served.ask(path)[2] for path in ("/", "/page.js", "/document")))
        again = page.Served("run", TRANSFER, "--page", "0", "--page-control")
        self.addCleanup(again.kill)
        self.assertNotIn(right, "".join(again.lines))

    def test_wrong_requests(self):
        served = self.serve("run", "lua/examples/12_three_foups.lua", "--page", "0", "--page-control")
        served.document()
        for request in ({}, {"pause": 1}, {"slices": 0}, {"slices": 1.5}, {"slices": 10**7}, {"slices": "1"}, {"rate": -1},
                        {"rate": 1e9}, {"rate": "1"}, {"rate": 1e-9}, {"line": "STATUS"}, {"complete": "ST"}, {"nothing": 1},
                        {"pause": True, "rate": 1}, {"hold": False}, {"continue": ""}, {"hold": "VAC", "continue": "VAC"}):
            status, text = self.ask(served, dict(request, token=self.token))
            self.assertEqual((status, json.loads(text)["ok"]), (400, False), request)
        for body in (b"", b"[]", b"{", b'{"token":', b"\xff", b"[" * 3000, b'{"token":1,"token":2}'):
            status, _, text = served.ask("/control", method="POST", body=body, Content_Type="application/json")
            self.assertEqual((status, json.loads(text)["ok"]), (400, False), body)
        status, _, _ = served.ask("/control", method="POST", body=b"{}" + b" " * 5000, Content_Type="application/json")
        self.assertEqual(status, 413)
        good = {"token": self.token, "pause": True}
        self.assertEqual(self.ask(served, good, Content_Type="text/plain")[0], 415)
        self.assertEqual(self.ask(served, good, Origin="http://evil.example")[0], 403)
        self.assertEqual(self.ask(served, good, Host="evil.example")[0], 403)
        self.assertEqual(served.ask("/control", token=self.token)[0], 404)
        self.assertFalse(served.document()["state"]["paused"])

    def operate(self, simulator=("lua/layouts/paper.lua",), *more):
        """A simulator, and the prompt with a page that commands it."""
        sim = page.Served("sim", *simulator, "--page", "0")
        self.addCleanup(sim.kill)
        prompt = self.serve("mcs", "--layout", simulator[0], "--page", "0", "--page-control", *more, stdin=subprocess.PIPE)
        self.addCleanup(prompt.process.stdin.close)
        stream = page.Stream(prompt, prompt.document())
        self.addCleanup(stream.close)
        return sim, prompt, stream

    def answered(self, stream, number):
        """What the feed tells of a request."""
        def found(told):
            return [what for _, kind, what in told if kind == "answer" and what["id"] == number]

        stream.wait(found)
        return found(stream.told)[0]

    def say(self, prompt, stream, line):
        return self.answered(stream, self.tell(prompt, line=line)["id"])["text"]

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_operator(self):
        """Lines are executed in their order, whatever they are; words are completed; what was said is shown; a recording has all of it."""
        record = page.ROOT / "build/live_page_operator.log"
        record.unlink(missing_ok=True)
        sim, prompt, stream = self.operate(("lua/layouts/paper.lua", "--record", record))
        self.tell(prompt, rate=0)
        numbers = [self.tell(prompt, line=line)["id"] for line in ("GET A 1", "get a 1", "PUT B 2", "WHERE")]
        answers = [self.answered(stream, number) for number in numbers]
        self.assertEqual([each["ok"] for each in answers], [True, False, True, True])
        self.assertEqual(numbers, sorted(numbers))
        self.assertTrue(answers[0]["text"].startswith('OK wafer="Wafer 1" seconds='))
        self.assertTrue(answers[1]["text"].startswith("ERROR "))
        for line in ('GET "<img src=x>" 1', "GET \u00e4\u4e2d\u6587\U0001f600 1", "\u0001", " ", "QUIT", "x" * 1000, '"', "STOP \"x", "#"):
            text = self.say(prompt, stream, line)
            self.assertTrue(text.startswith("ERROR "), (line, text))
            self.assertNotIn("\u0001", text)
        self.assertEqual(self.say(prompt, stream, "STATUS")[:14], "OK phase=idle ")
        prompt.process.stdin.write("HOLDER \"Wafer 1\"\n")
        prompt.process.stdin.flush()
        got = prompt.until(lambda got: any(each["port"] == "prompt" and each["kind"] == "<" for each in got["document"]["run"]["frames"]))
        frames = got["document"]["run"]["frames"]
        self.assertEqual([(each["port"], each["kind"], each["text"]) for each in frames[-2:]],
                         [("prompt", ">", 'HOLDER "Wafer 1"'), ("prompt", "<", "OK holder=none")])
        self.assertEqual([each["text"] for each in frames if each["port"] == "page" and each["kind"] == ">"][:4],
                         ["GET A 1", "get a 1", "PUT B 2", "WHERE"])
        told = self.answered(stream, self.tell(prompt, complete="GET A 1 for")["id"])
        self.assertEqual((told["kept"], told["candidates"]), ("GET A 1 ", ["force="]))
        told = self.answered(stream, self.tell(prompt, complete="ge")["id"])
        self.assertEqual((told["kept"], told["candidates"]), ("", ["GET"]))
        told = self.answered(stream, self.tell(prompt, complete='HOLDER "\u00e4')["id"])
        self.assertEqual(told["candidates"], [])
        self.say(prompt, stream, "SAVE here")
        self.say(prompt, stream, "GET B 2")
        self.assertIn("undone=", self.say(prompt, stream, "UNDO"))
        self.assertTrue(self.say(prompt, stream, "RESTORE here").startswith("OK time="))
        self.assertTrue(self.say(prompt, stream, "GET B 1").startswith("OK "))
        prompt.process.stdin.close()
        self.assertEqual(prompt.process.wait(60), 0)
        self.assertEqual(sim.end()[0], 0)
        log = record.read_bytes()
        for line in (b"GET A 1", b"PUT B 2", b"WHERE", b"SAVE here", b"UNDO", b"RESTORE here", b"GET B 1"):
            self.assertIn(line + b"\0", log)
        replayed = subprocess.run([page.PROGRAM, "replay", record], cwd=page.ROOT, capture_output=True, text=True, check=False)
        self.assertEqual(replayed.returncode, 0, replayed.stdout + replayed.stderr)

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_operator_pauses_and_stops(self):
        """A pause holds motion control up, and the simulator with it; lines wait, but not STOP, which ends the pause; 16 lines may wait."""
        _, prompt, stream = self.operate()
        self.assertEqual(prompt.document()["state"]["control"], "prompt")
        self.tell(prompt, pause=True)
        running = self.tell(prompt, line="GET A 1")["id"]
        at = self.stands(prompt)["document"]["duration_s"]
        self.tell(prompt, slices=3)
        prompt.until(lambda got: got["document"]["duration_s"] > at + 0.0025)
        self.assertAlmostEqual(self.stands(prompt)["document"]["duration_s"], at + 0.003, places=6)
        self.assertIn("phase=running", self.say(prompt, stream, "STATUS"))
        told = self.answered(stream, self.tell(prompt, complete="GE")["id"])
        self.assertEqual(told["candidates"], [])
        waiting = [self.tell(prompt, line="READY B 1")["id"] for _ in range(16)]
        self.assertIn("BUSY", self.say(prompt, stream, "READY B 1"))
        self.assertEqual(self.say(prompt, stream, "STOP"), "OK")
        self.assertTrue(self.answered(stream, running)["text"].startswith("ERROR 52 STOPPED"))
        for number in waiting:
            self.assertTrue(self.answered(stream, number)["text"].startswith("ERROR 52 STOPPED"))
        self.assertFalse(prompt.until(lambda got: not got["state"]["paused"])["state"]["stands"])
        self.tell(prompt, command=True)
        number = self.tell(prompt, line="HOME")["id"]
        self.stands(prompt)
        self.assertFalse(any(kind == "answer" and what["id"] == number for _, kind, what in stream.told))
        self.tell(prompt, pause=False)
        self.assertTrue(self.answered(stream, number)["text"].startswith("OK "))
        self.tell(prompt, pause=True)
        self.tell(prompt, line="GET A 1")
        self.stands(prompt)
        prompt.process.send_signal(2)
        self.assertEqual(prompt.process.wait(60), 1)

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_operator_runs_free(self):
        """With --rate nothing holds motion control up; lines are executed all the same."""
        _, prompt, stream = self.operate(("lua/layouts/paper.lua",), "--rate", "20")
        self.assertFalse(prompt.document()["state"]["paces"])
        for request in ({"pause": True}, {"slices": 1}, {"rate": 2}):
            status, text = self.ask(prompt, dict(request, token=self.token))
            self.assertEqual((status, json.loads(text)["text"].split(" (")[0]), (400, f"{'rate' if 'rate' in request else 'pause'}: motion control runs free"))
        self.assertTrue(self.say(prompt, stream, "READY A 1").startswith("OK "))

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_script_over_lcm(self):
        """mcs with a script: pause, a slice, and on; the hash is that of the run in one process."""
        sim = page.Served("sim", "lua/layouts/paper.lua", "--page", "0")
        self.addCleanup(sim.kill)
        control = self.serve("mcs", TRANSFER, "--page", "0", "--page-control")
        control.document()
        self.tell(control, pause=True)
        at = self.stands(control)["document"]["duration_s"]
        self.tell(control, slices=2)
        control.until(lambda got: got["document"]["duration_s"] > at + 0.0015)  # two slices, however the sum is rounded
        self.tell(control, rate=0)
        self.tell(control, pause=False)
        self.assertIn(HASH, control.process.stdout.read())
        self.assertEqual(control.process.wait(60), 0)

    @unittest.skipIf(os.environ.get("WH_NETWORK") == "none", "processes do not reach each other")
    def test_operator_without_token(self):
        """Nothing is executed, completed or held up."""
        _, prompt, stream = self.operate()
        for request in ({"line": "GET A 1"}, {"complete": "GE"}, {"pause": True}, {"line": "STOP"}):
            self.assertEqual(self.ask(prompt, dict(request, token="0" * 32))[0], 403)
            self.assertEqual(self.ask(prompt, dict(request, token=self.token), Origin="http://evil.example")[0], 403)
        for line in ("x" * 1001, "a\nb", "a\rb", 7, None, ["GET A 1"]):
            self.assertEqual(self.ask(prompt, {"token": self.token, "line": line})[0], 400, line)
            self.assertEqual(self.ask(prompt, {"token": self.token, "complete": line})[0], 400, line)
        self.assertEqual(self.ask(prompt, {"token": self.token, "line": "WHERE", "complete": "W"})[0], 400)
        self.assertEqual(self.ask(prompt, {"token": self.token, "line": "a\u0000b"})[0], 400)
        self.assertTrue(self.say(prompt, stream, "GET A 1").startswith("OK "))
        self.assertEqual([each["text"] for each in prompt.document()["document"]["run"]["commands"]], ["GET A 1"])

    def test_refusals(self):
        for arguments, message in (
                (("run", TRANSFER, "--page-control"), "--page-control goes with --page"),
                (("sim", "lua/layouts/paper.lua", "--page", "0", "--page-control"), "--page-control: motion control commands this cell"),
                (("sim", "lua/layouts/paper.lua", "--udp", "0", "--page", "0", "--page-control"), "--page-control: a board commands this cell"),
                (("mcs", TRANSFER, "--rate", "1", "--page", "0", "--page-control"), "--page-control: motion control runs free"),
        ):
            if arguments[0] != "run" and os.environ.get("WH_NETWORK") == "none":
                continue
            ran = subprocess.run([page.PROGRAM, *arguments], cwd=page.ROOT, capture_output=True, text=True, timeout=30, check=False)
            self.assertEqual(ran.returncode, 2, arguments)
            self.assertIn(message, ran.stderr)


if __name__ == "__main__":
    unittest.main()
