"""host.py FOLDER: mutants of the host rooms and of collision, drawn from all their sources together. tests/verify/host_mutation
says what is asked and has the settings; it gives the names of sources and tests."""

import collections
import contextlib
import hashlib
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
import time

from mutants import Source
from records import Results, Survivors

LEAST_RATE = 0.9
LIST = "tests/verify/mutants/survivors"
LONGEST_S = float(os.environ.get("LONGEST", "240"))  # a test that takes longer is not used
TESTS_S = 240  # tests are begun against one mutant for this long
COUNTING_SHARE = 0.5  # share of the time for finding out which test runs which line
# Only C is counted: C++ has to be optimised, which takes long.
COUNTED = ["CFLAGS=-O0 -g1 --coverage -fprofile-update=atomic", "LDFLAGS=--coverage"]
# It is compiled as the Makefile compiles it, so that a compiler cache may have it; but linking is quicker without lines.
PLAIN = ["LDFLAGS=-Wl,--strip-debug"]
# In CI warnings are errors: a change that the compiler warns about does not pass there.
STRICT = [*PLAIN, "B=build/strict", "WERROR=1"]
COMPILER = "a warning of the compiler"
# Loops run longer than make test has time for under sanitizers; random rounds get WH_TEST_SECONDS.
CHECKED = "-O1 -g -DWH_DEBUG -DWH_DEBUG_TABLE -DWH_TEST_SHARE=5"
CHECKED = ["B=build/sanitize", f"CFLAGS={CHECKED}", f"CXXFLAGS={CHECKED}", *PLAIN,
           "EXTRA= -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all"]


RUNNING = set()  # process groups of tests


def stop(*_):
    """Interrupted: no test is left behind, and no thread begins another."""
    for group in list(RUNNING):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(group, signal.SIGKILL)
    os._exit(1)


def digest_of(*contents):
    total = hashlib.sha256()
    for content in contents:
        total.update(hashlib.sha256(content).digest())
    return total.hexdigest()[:16]


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


def tracked():
    return subprocess.run(["git", "ls-files", "-z"], capture_output=True, check=True, text=True).stdout.split("\0")[:-1]


def is_end_to_end(test):
    return test.startswith("tests/end_to_end/")


def patience():
    """How many times longer everything takes, as others use the machine."""
    return max(1, os.getloadavg()[0] / os.cpu_count())


class Tree:
    """A copy of the tree and its build. What did not change keeps its time, so that make has little to do."""

    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs
        for path in tracked():
            copy = self.place(path)
            os.makedirs(os.path.dirname(copy), exist_ok=True)
            if not os.path.lexists(copy) or not (os.path.islink(copy) or bytes_of(path) == bytes_of(copy)):
                shutil.copy(path, copy, follow_symlinks=False)

    def place(self, path):
        return os.path.join(self.folder, path)

    def write(self, path, content):
        with open(self.place(path), "wb") as file:
            file.write(content)

    def make(self, settings, targets):
        """False if that cannot be built; what make says is in the folder's log."""
        command = ["make", "-s", f"-j{self.jobs}", "-f", "lib/build/build.mk", "CC=gcc", "CXX=g++", *settings, *targets]
        with open(self.folder + ".log", "wb") as log:
            return subprocess.run(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                  check=False).returncode == 0

    def make_all(self, settings, targets):
        if not self.make(settings, targets):
            sys.exit(f"mutation: {self.folder}.log says what cannot be built")

    def run(self, program, limit):
        """The exit status, or None after so many seconds. What the program leaves behind is ended."""
        more = {"ASAN_OPTIONS": "hard_rss_limit_mb=4000"}
        command = ["prlimit", "--core=0", f"--fsize={1 << 30}", os.path.join(os.path.abspath(self.folder), program)]
        with subprocess.Popen(command, cwd=self.folder, env={"WH_TEST_SECONDS": "3", **os.environ, **more}, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True) as process:
            RUNNING.add(process.pid)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(limit)
            status = process.poll()
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            RUNNING.remove(process.pid)
        return status


class Lines:
    """Which test runs which line, by gcov: measured once for each test, as long as that itself does not change. Of a source
    that has changed since every test counts that ran any line of it."""

    def __init__(self, folder, sources, tests, tools):
        self.folder, self.sources, self.tests, self.tools = folder, sources, tests, tools
        self.digests = {source: digest_of(bytes_of(source)) for source in sources}
        self.found = {}
        self.uncounted = []  # there was no time to

    def kept(self, test):
        return os.path.join(self.folder, "lines", test.replace("/", "_"))

    def stamp(self, test):
        return digest_of(bytes_of(next(name for name in (test, test + ".c", test + ".cpp") if os.path.exists(name))))

    def measure(self, jobs, seconds):
        """Counts for so many seconds. Tests that there is no time for are not used."""
        end = time.monotonic() + seconds
        os.makedirs(os.path.join(self.folder, "lines"), exist_ok=True)
        for test in self.tests:
            if os.path.exists(self.kept(test)):
                found = json.loads(bytes_of(self.kept(test)))
                if found["stamp"] == self.stamp(test):
                    self.found[test] = found
        missing = [test for test in self.tests if test not in self.found]
        if missing:
            tree = Tree(os.path.join(self.folder, "counted"), jobs)
            tree.make_all(COUNTED, ["all", *self.tools, *(f"build/{test}" for test in missing if not is_end_to_end(test))])
            for test in (test for test in missing if time.monotonic() < end):
                if is_end_to_end(test):  # the one before may have built the tree in its own way
                    tree.make_all(COUNTED, ["all", *self.tools])
                self.found[test] = self.count(tree, test)
                if self.found[test]["status"] not in (0, 77):  # it may pass another time
                    continue
                with open(self.kept(test), "w", encoding="utf-8") as file:
                    json.dump(self.found[test], file)
        self.uncounted = [test for test in self.tests if test not in self.found]
        for test in self.tests:
            status = self.found.get(test, {"status": "there was no time to count"})["status"]
            if status != 0:
                told = {None: f"it takes over {LONGEST_S:g} s", 77: "it is skipped"}
                print(f"not used: {test}: {told.get(status, status)}", flush=True)
        self.found = {test: found for test, found in self.found.items() if found["status"] == 0}

    def count(self, tree, test):
        counters = [tree.place(f"build/{kind}/{os.path.splitext(source)[0]}.gcda")
                    for source in self.sources for kind in ("obj", "pic")]
        for path in filter(os.path.exists, counters):
            os.remove(path)
        begin = time.monotonic()
        status = tree.run(test if is_end_to_end(test) else "build/" + test, LONGEST_S * patience())
        seconds = time.monotonic() - begin
        print(f"counted: {test}: {seconds:.1f} s", flush=True)
        counters = [os.path.relpath(path, tree.folder) for path in counters if os.path.exists(path)]
        lines = {}
        if status == 0 and counters:
            out = subprocess.run(["gcov", "--json-format", "--stdout", *counters], cwd=tree.folder, capture_output=True,
                                 check=True, text=True).stdout
            for file in (file for document in out.splitlines() for file in json.loads(document)["files"]):
                if file["file"] in self.digests:
                    found = lines.setdefault(file["file"], {"digest": self.digests[file["file"]], "run": [], "not": []})
                    for line in file["lines"]:
                        found["run" if line["count"] > 0 else "not"].append(line["line_number"])
        return {"stamp": self.stamp(test), "status": status, "seconds": seconds, "lines": lines}

    def has_code(self, source):
        """Whether any test's counters know of its lines."""
        return any(source in found["lines"] for found in self.found.values())

    def running(self, source, number):
        """The tests that run this line, the end-to-end ones last, the shortest first. Of a line without code, as of a table, and
        of one that no counter saw, as in a process that was killed, those that run its file; of a file without code those that
        run its room; of a file that is not counted those that are named after its room."""
        of_file = {test: found["lines"][source] for test, found in self.found.items()
                   if found["lines"].get(source, {}).get("run")}
        same = [lines for lines in of_file.values() if lines["digest"] == self.digests[source]]
        is_code = len(same) == len(of_file) and any(number in lines["run"] + lines["not"] for lines in same)
        tests = [test for test, lines in of_file.items() if not is_code or number in lines["run"]] or list(of_file)
        if not of_file and not self.has_code(source):
            room = os.path.dirname(source) + "/"
            tests = [test for test, found in self.found.items()
                     if any(path.startswith(room) and lines["run"] for path, lines in found["lines"].items())]
        if source.endswith(".cpp"):
            tests = [test for test in self.found if f"/{source.split('/')[1]}" in test]
        return sorted(tests, key=lambda test: (is_end_to_end(test), self.found[test]["seconds"]))


class NotBuilt(Exception):
    """A source that compiles, but with which nothing can be linked."""


class Lane:
    """A tree in which one source at a time is changed."""

    def __init__(self, folder, jobs, lines):
        self.tree, self.lines = Tree(folder, jobs), lines
        self.program = ["all", *lines.tools]
        self.tree.make_all(PLAIN, self.program)
        self.plain = {source: bytes_of(self.tree.place(source)) for source in lines.sources}  # edits in the meantime have no effect
        self.sound, self.originals = {}, {}

    def built(self, source):
        """What the source compiles to, without lines; None if it does not."""
        target = f"build/obj/{os.path.splitext(source)[0]}.o"
        if not self.tree.make(PLAIN, [target]):
            return None
        bare = self.tree.folder + ".o"
        subprocess.run(["strip", "--strip-debug", "-o", bare, self.tree.place(target)], check=True)
        return bytes_of(bare)

    def is_refused(self, source):
        """Does the compiler warn of the source as it is now?"""
        return not self.tree.make(STRICT, [f"build/strict/obj/{os.path.splitext(source)[0]}.o"])

    def status(self, test):
        """What the test ends with, the source being as it is now: None if it does not end in time."""
        program = test if is_end_to_end(test) else f"build/sanitize/{test}"
        if not (self.tree.make(PLAIN, self.program) if is_end_to_end(test) else self.tree.make(CHECKED, [program])):
            raise NotBuilt
        return self.tree.run(program, (20 + 5 * self.lines.found[test]["seconds"]) * patience())

    def is_sound(self, source, text, test, status):
        """Does the test pass without the change? Of one that takes too long, and of end-to-end tests, some of which ask for
        time, that is asked each time: they may fail because the machine is slow. Of others the first time."""
        if test not in self.sound or status is None or is_end_to_end(test):
            self.tree.write(source, self.plain[source])
            self.sound[test] = self.status(test) == 0
            self.tree.write(source, text)
        if not self.sound[test]:
            print(f"does not count: {test}: it fails without a change, too", flush=True)
        return self.sound[test]

    def killer_of(self, source, text, tests):
        """The first of the tests that fails, "" if none does, and which passed: fewer than all when its time was over."""
        if self.is_refused(source):
            return COMPILER, []
        end, passed = time.monotonic() + TESTS_S * patience(), []
        for test in tests:
            if time.monotonic() > end:
                break
            status = self.status(test) if self.sound.get(test, True) or is_end_to_end(test) else 0
            if status != 0 and self.is_sound(source, text, test, status):
                return test, passed
            if status is not None:  # else the machine was too slow: it is tested another time
                passed.append(test)
        return "", passed

    def judge(self, source, text, tests):
        """None if it makes no difference or cannot be built, else its killer or "", and the tests that passed."""
        if source not in self.originals:
            self.originals[source] = self.built(source)
        self.tree.write(source, text)
        try:
            mutated = self.built(source)
            return self.killer_of(source, text, tests) if mutated not in (None, self.originals[source]) else (None, [])
        except NotBuilt:
            return None, []
        finally:
            self.tree.write(source, self.plain[source])


class Sample:
    """Mutants in an order of chance, judged until there are enough or the time is over."""

    def __init__(self, folder, lines, wanted, seed, end):
        self.lines, self.wanted, self.end = lines, wanted, end
        drawn = [(source, mutant) for source in map(Source, lines.sources) for mutant in source.mutants()]
        random.Random(seed).shuffle(drawn)
        self.drawn, self.lock = iter(drawn), threading.Lock()
        self.results, self.list = Results(os.path.join(folder, "results")), Survivors(LIST)
        self.tests = digest_of(*(bytes_of(path) for path in tracked() if path.startswith(("tests/", "lua/"))))
        self.judged, self.killed, self.undecided = collections.Counter(), collections.Counter(), []

    def is_listed(self, mutant):
        return (mutant.line, mutant.text) in self.list.of(mutant.path) or self.list.part_of(mutant.line, mutant.text)

    def take(self):
        """The next one that is not listed, None when enough are judged."""
        with self.lock:
            if sum(self.judged.values()) + len(self.undecided) >= self.wanted or time.monotonic() > self.end:
                return None
            return next((drawn for drawn in self.drawn if not self.is_listed(drawn[1])), None)

    def verdict(self, lane, source, mutant):
        """As found before, as long as the same source is changed and, of a survivor, the tests are the same. One whose time was
        over goes on with the tests that are left. How many are left then comes with it."""
        key = source.digest("") + mutant.key
        tests = self.lines.running(mutant.path, mutant.number)
        entry = self.results.get(key)
        known = entry if entry.get("tests") == self.tests else {}
        left = [test for test in tests if test not in known.get("passed", [])]
        if "killer" not in entry or (entry["killer"] == "" and (known is not entry or left)):
            killer, passed = lane.judge(mutant.path, source.changed(mutant).encode(), left)
            entry = {"killer": killer, "tests": self.tests, "passed": known.get("passed", []) + passed}
            self.results.put(key, entry)
            left = [test for test in left if test not in passed]
        return entry["killer"], len(left) + len(self.lines.uncounted), len(tests) + len(self.lines.uncounted)

    def count(self, mutant, killer, left, of):
        room = mutant.path.split("/")[1]
        told = f"killed by {killer}" if killer else f"survives (all {of} tests that run it pass)"
        if killer == "" and left > 0:
            self.undecided.append(mutant)
            told = f"undecided: its time was over ({left} of {of} tests that may run it are left)"
        else:
            self.judged[room] += 1
            self.killed[room] += killer != ""
        print(f"{told}: {mutant.show()}", flush=True)

    def work(self, lane):
        while drawn := self.take():
            source, mutant = drawn
            killer, left, of = self.verdict(lane, source, mutant)
            if killer is not None:
                with self.lock:
                    self.count(mutant, killer, left, of)


def interval(killed, judged):
    """Wilson's, of 95 %."""
    z, rate = 1.96, killed / judged
    middle, half = rate + z * z / (2 * judged), z * math.sqrt(rate * (1 - rate) / judged + z * z / (4 * judged * judged))
    return [100 * (middle + side * half) / (1 + z * z / judged) for side in (-1, 1)]


def conclude(sample):
    """Those that are undecided are neither killed nor survivors; the rate is at least this if it is so with all of them."""
    for room in sorted(sample.judged):
        print(f"{room:10} {sample.killed[room]:4} of {sample.judged[room]}")
    judged, killed, undecided = sum(sample.judged.values()), sum(sample.killed.values()), len(sample.undecided)
    if judged == 0:
        sys.exit("mutation: no mutant was judged")
    low, high = interval(killed, judged)
    print(f"{killed} of {judged} killed: {100 * killed / judged:.1f} % (95 %: {low:.1f} to {high:.1f} %); {undecided} undecided")
    if killed < LEAST_RATE * judged:
        sys.exit(f"mutation: less than {100 * LEAST_RATE:.0f} % are killed")
    if killed < LEAST_RATE * (judged + undecided):
        sys.exit("mutation: too many are undecided (the same command goes on with them)")


def main():
    folder, of = sys.argv[1], {name: os.environ["WH_" + name].split() for name in ("SOURCES", "TESTS", "TOOLS")}
    wanted, seed = int(os.environ.get("SAMPLE", "60")), os.environ.get("SEED", "20240229")
    seconds, jobs = float(os.environ.get("MUTATION_SECONDS", "inf")), int(os.environ.get("JOBS", os.cpu_count()))
    chosen = os.environ.get("FILES", "").split() or of["SOURCES"]
    if set(chosen) - set(of["SOURCES"]):
        sys.exit(f"mutation: no source of the host rooms: {' '.join(sorted(set(chosen) - set(of['SOURCES'])))}")
    lines = Lines(folder, of["SOURCES"], of["TESTS"], of["TOOLS"])
    begin = time.monotonic()
    lines.measure(jobs, COUNTING_SHARE * seconds)
    lines.sources = chosen
    lanes = [Lane(os.path.join(folder, f"lane{number}"), jobs, lines) for number in range(jobs)]
    print(f"SAMPLE={wanted} SEED={seed}", flush=True)
    sample = Sample(folder, lines, wanted, seed, begin + seconds)
    workers = [threading.Thread(target=sample.work, args=(lane,), daemon=True) for lane in lanes]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    conclude(sample)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    main()
