"""host.py FOLDER: mutants of the host rooms and of collision, drawn from all their sources together. See
tests/verify/host_mutation for what is asked, and the settings."""

import glob
import hashlib
import os
import queue
import re
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from random import Random

from lanes import Commands, Lane
from lines import Lines
from mutants import Source
from results import Results
from survivors import Survivors

LEAST_RATE = 0.9
LIST = "tests/verify/mutants/survivors"
MEMORY = "/dev/shm"


def host_sources():
    with open("lib/build/rooms.mk", encoding="utf-8") as file:
        rooms = " ".join(re.findall(r"^(?:COLLISION_ROOM|HOST_ROOMS) := (.*)$", file.read(), re.M)).split()
    found = [path for room in rooms for path in glob.glob(f"lib/{room}/**/*.c", recursive=True)]
    wanted = os.environ.get("FILES", "").split()
    if set(wanted) - set(found):
        sys.exit(f"mutation: no source of a host room: {' '.join(sorted(set(wanted) - set(found)))}")
    return sorted(wanted or found)


def draw(paths, seed):
    """All mutants in an order of chance, each with its source."""
    drawn = [(source, mutant) for source in map(Source, paths) for mutant in source.mutants()]
    Random(seed).shuffle(drawn)
    return drawn


def builds_itself(test):
    """True of a test that looks at other builds, or makes them: it does not see the changed program."""
    with open(test, encoding="utf-8") as file:
        return re.search(r"build/(sanitize|float|check|clang)|\bmake\b -|\bmake\b [a-z]|fresh", file.read()) is not None


class Run:
    def __init__(self, folder):
        self.folder = folder
        self.sources = host_sources()
        self.unit = os.environ["WH_MUTATION_TESTS"].split()
        programs = os.environ["WH_MUTATION_PROGRAMS"].split()
        self.end_to_end = [test for test in programs if not builds_itself(test)]
        for test in sorted(set(programs) - set(self.end_to_end)):
            print(f"not used: {test}: builds something itself")
        self.memory = tempfile.TemporaryDirectory(prefix="mutation.", dir=MEMORY if os.path.isdir(MEMORY) else None)
        self.results = Results(os.path.join(folder, "results"))
        self.list = Survivors(LIST)
        self.kills = {}
        self.sound = {}

    def measure(self):
        build = os.path.join(self.folder, "counted")
        lane = Lane(os.path.join(self.memory.name, "counted"), None, build)
        self.lines = Lines(os.path.join(self.folder, "lines"), lane, glob.glob("lib/**/*.[ch]", recursive=True))
        for test in self.unit + self.end_to_end:
            self.lines.measure(test)

    def open_lanes(self, count):
        build = os.path.join(self.folder, "sanitized")
        commands = Commands(os.path.join(self.folder, "commands"), build)
        self.lanes = queue.Queue()
        for number in range(count):
            lane = Lane(os.path.join(self.memory.name, str(number)), commands, build)
            lane.finish(self.unit)
            self.lanes.put(lane)

    def limit(self, test):
        return 10 + 6 * self.lines.seconds[test]

    def is_sound(self, lane, test):
        """Does the test pass under sanitizers with nothing changed?"""
        if test not in self.sound:
            self.sound[test] = lane.run(test, self.limit(test)) == 0
            if not self.sound[test]:
                print(f"not used: {test}: fails under sanitizers", flush=True)
        return self.sound[test]

    def ordered(self, source, mutant):
        def merit(test):
            return (1 + self.kills.get(test, 0)) / (0.2 + self.lines.seconds[test])

        return sorted(self.lines.running(source.path, mutant.number), key=merit, reverse=True)

    def killer_of(self, lane, source, mutant):
        tests = [test for test in self.ordered(source, mutant) if self.is_sound(lane, test)]
        if not lane.change(source.path, source.changed(mutant)):
            lane.undo(source.path)
            return "the linker"
        for test in tests:
            if lane.run(test, self.limit(test)) != 0:
                self.kills[test] = self.kills.get(test, 0) + 1
                lane.undo(source.path)
                return test
        lane.undo(source.path)
        return None

    def key(self, source, mutant):
        tests = "".join(self.lines.stamp(test) for test in sorted(self.lines.running(source.path, mutant.number)))
        words = source.digest("") + mutant.key + str(mutant.number)
        return hashlib.sha256(words.encode()).hexdigest()[:24], hashlib.sha256(tests.encode()).hexdigest()[:16]

    def judge(self, drawn):
        """The verdict on one mutant: None if it changes nothing, else its killer or "" and itself."""
        source, mutant = drawn
        key, tests = self.key(source, mutant)
        entry = self.results.get(key)
        if "killer" not in entry or (entry["killer"] == "" and entry["tests"] != tests):
            lane = self.lanes.get()
            try:
                killer = (self.killer_of(lane, source, mutant) or "") if lane.differs(source.path, source.changed(mutant)) else None
            finally:
                self.lanes.put(lane)
            entry = {"killer": killer, "tests": tests}
            self.results.put(key, entry)
        return entry["killer"], mutant

    def is_listed(self, mutant):
        listed = (mutant.line, mutant.text) in self.list.of(mutant.path)
        return listed or self.list.part_of(mutant.line, mutant.text) is not None

    def sample(self, drawn, wanted, jobs):
        """Judges mutants in the order drawn until so many differ."""
        differing = listed = killed = 0
        with ThreadPoolExecutor(jobs) as pool:
            begin = 0
            while begin < len(drawn) and differing - listed < wanted:
                part = drawn[begin:begin + max(jobs, wanted - differing + listed)]
                begin += len(part)
                for killer, mutant in pool.map(self.judge, part):
                    if killer is None or differing - listed == wanted:
                        continue
                    differing += 1
                    killed += killer != ""
                    if killer == "" and self.is_listed(mutant):
                        listed += 1
                    elif killer == "":
                        print("survives: " + mutant.show(), flush=True)
                    else:
                        print(f"killed by {killer}: {mutant.path}:{mutant.number}", flush=True)
        return differing, listed, killed


def main():
    wanted, seed = int(os.environ.get("SAMPLE", "60")), os.environ.get("SEED", "20240229")
    jobs = int(os.environ.get("JOBS", os.cpu_count()))
    run = Run(sys.argv[1])
    print(f"SAMPLE={wanted} SEED={seed}", flush=True)
    run.measure()
    run.open_lanes(jobs)
    differing, listed, killed = run.sample(draw(run.sources, seed), wanted, jobs)
    rate = killed / (differing - listed) if differing > listed else 1
    print(f"{differing} differ, {listed} of them listed, {killed} killed: {100 * rate:.1f} %")
    if rate < LEAST_RATE:
        sys.exit(f"mutation: less than {100 * LEAST_RATE:.0f} % are killed")


if __name__ == "__main__":
    main()
