"""run.py FOLDER FLAGS TEST...: (TEST as in tests/unit/pose_test) mutates the library's sources, one change at a time, and counts which changes the tests
notice. See tests/verify/mutation for what is asked of the numbers and for the settings."""

import json
import os
import shutil
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from random import Random

from builder import Builder
from judge import Judge, Test
from mutants import Source
from survivors import Survivors

LEAST_RATE = 0.97
LIST = "tests/mutation/survivors"
DOES_NOT_COMPILE = "compiler"  # a header's mutant alone does, but not where it is included


class Results:
    """What earlier runs found, one line each; appended to at once, so that an interrupted run goes on."""

    def __init__(self, path):
        self.known = {}
        self.lock = threading.Lock()
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                for line in file:
                    if line.endswith("\n"):
                        entry = json.loads(line)
                        self.known.setdefault(entry.pop("key"), {}).update(entry)
        self.file = open(path, "a", encoding="utf-8")

    def get(self, key):
        return self.known.get(key, {})

    def put(self, key, entry):
        with self.lock:
            self.known.setdefault(key, {}).update(entry)
            self.file.write(json.dumps({"key": key, **entry}) + "\n")
            self.file.flush()


class Campaign:
    """All mutants of one file."""

    def __init__(self, path, tools, sample, seed):
        self.source = Source(path)
        self.builder, self.judge, self.results, self.pool, self.list = tools
        self.mutants = list(self.source.mutants())
        self.digest = self.source.digest()
        self.generated = len(self.mutants)
        self.sample = sample
        if sample is not None:
            Random(f"{seed} {path}").shuffle(self.mutants)
        self.folder = tempfile.TemporaryDirectory(prefix="mutation.", dir="/dev/shm" if os.path.isdir("/dev/shm") else None)
        self.compiled = self.unfit = self.killed = 0
        self.differing = []
        self.survivors = []
        self.listed = []
        self.stale = []

    def key(self, mutant):
        return self.digest[:24] + mutant.key

    def folder_of(self, mutant):
        return os.path.join(self.folder.name, mutant.key if mutant else "original")

    def compile(self, mutant, text=None):
        """Object's hash, or None."""
        entry = self.results.get(self.key(mutant)) if mutant else {}
        if "object" not in entry:
            folder = self.folder_of(mutant)
            os.makedirs(folder)
            entry = {"object": self.builder.build(self.source, text or self.source.changed(mutant), folder)}
            if entry["object"] is None:
                shutil.rmtree(folder)
            if mutant:
                self.results.put(self.key(mutant), entry)
        return entry["object"]

    def judge_one(self, mutant):
        entry = self.results.get(self.key(mutant))
        if entry.get("killer") == DOES_NOT_COMPILE or ("killer" in entry and self.judge.current(self.source.path, entry)):
            return entry["killer"]
        folder = self.folder_of(mutant)
        if not os.path.exists(folder):  # compiled by an earlier run
            os.makedirs(folder)
            self.builder.build(self.source, self.source.changed(mutant), folder)
        if self.builder.finish(self.source, folder):
            verdict = self.judge.verdict(self.source.path, folder, entry.get("killer"))
        else:
            verdict = {"killer": DOES_NOT_COMPILE, "tests": None}
        shutil.rmtree(folder)
        self.results.put(self.key(mutant), verdict)
        return verdict["killer"]

    def distinct(self):
        """Those that compile and differ from the original and from each other, as many as the sample asks for."""
        seen = {self.compile(None, "".join(self.source.lines))}
        for begin in range(0, len(self.mutants), 64):
            part = self.mutants[begin:begin + 64]
            for mutant, found in zip(part, self.pool.map(self.compile, part)):
                self.compiled += found is not None
                if found is not None and found not in seen:
                    seen.add(found)
                    self.differing.append(mutant)
                    if len(self.differing) == self.sample:
                        return
                elif found is not None:
                    shutil.rmtree(self.folder_of(mutant), ignore_errors=True)

    def run(self):
        self.distinct()
        wanted = self.list.of(self.source.path)
        listed = [mutant for mutant in self.mutants if (mutant.line, mutant.text) in wanted]
        excused = {self.compile(mutant): mutant for mutant in listed}
        missing = wanted - {(mutant.line, mutant.text) for mutant in listed}
        self.stale += [f"{self.source.path}\n- {line}\n+ {text}" for line, text in sorted(missing)]
        if self.sample is not None:  # only all of them are worth the time to see whether what is listed still survives
            self.listed = [mutant for mutant in self.differing if self.compile(mutant) in excused]
        to_judge = [mutant for mutant in self.differing if mutant not in self.listed]
        for mutant, killer in zip(to_judge, self.pool.map(self.judge_one, to_judge)):
            is_listed = self.compile(mutant) in excused
            if killer == DOES_NOT_COMPILE:
                self.unfit += 1
            elif killer is not None:
                self.killed += 1
                if is_listed:
                    self.stale.append(f"{mutant.show()}\n  killed by {killer}")
            elif is_listed or self.list.part_of(mutant.line, mutant.text):
                self.listed.append(mutant)
            else:
                self.survivors.append(mutant)
        self.folder.cleanup()

    def numbers(self):
        return (self.generated, self.compiled - self.unfit, len(self.differing) - self.unfit, self.killed,
                len(self.listed))


def rate_of(numbers):
    """Of those that something can notice: killed."""
    _, _, differ, killed, listed = numbers
    return killed / (differ - listed) if differ > listed else 1


def row(name, numbers, file=sys.stdout):
    generated, compiled, differ, killed, listed = numbers
    rate = f"{100 * rate_of(numbers):6.2f} %"
    print(f"{name:28}{generated:8}{compiled:9}{differ:8}{killed:8}{listed:8}  {rate}", file=file, flush=True)


def sources(builder):
    headers = sorted({os.path.join(os.path.dirname(path), name) for path in builder.sources
                      for name in os.listdir(os.path.dirname(path)) if name.endswith(".h")})
    wanted = os.environ.get("FILES", "").split()
    return [path for path in builder.sources + headers if not wanted or path in wanted]


def report(campaign):
    row(campaign.source.path, campaign.numbers())
    for mutant in campaign.survivors:
        print("survives: " + mutant.show(), flush=True)
    for entry in campaign.stale:
        print(f"{LIST}: not needed: {entry}", flush=True)


def load_test(builder, folder, name):
    reached = builder.reached_from(os.path.join(folder, "obj", name + ".o"))
    test = Test(os.path.join(folder, "run", os.path.basename(name)), reached)
    test.measure(builder.originals)
    return test


def main():
    folder, flags, *names = sys.argv[1:]
    wanted = os.environ.get("SAMPLE", "60")
    sample = None if wanted == "all" else int(wanted)
    seed = os.environ.get("SEED", "20240229")
    builder = Builder(folder, os.environ.get("CC", "cc"), flags)
    survivors = Survivors(LIST)
    campaigns = []
    row_names = ("mutants", "compile", "differ", "killed", "listed")
    with ThreadPoolExecutor(int(os.environ.get("JOBS", os.cpu_count()))) as pool:
        judge = Judge([load_test(builder, folder, name) for name in names])
        results = Results(os.path.join(folder, "results"))
        print(f"SAMPLE={wanted} SEED={seed}")
        print(f"{'':28}{row_names[0]:>8}{row_names[1]:>9}" + "".join(f"{name:>8}" for name in row_names[2:]) + "      rate")
        for path in sources(builder):
            campaign = Campaign(path, (builder, judge, results, pool, survivors), sample, seed)
            campaign.run()
            if campaign.differing:
                campaigns.append(campaign)
                report(campaign)
    totals = [sum(column) for column in zip(*(campaign.numbers() for campaign in campaigns))]
    row("all", totals)
    if rate_of(totals) < LEAST_RATE:
        sys.exit(f"mutation: less than {100 * LEAST_RATE:.0f} % are killed")
    if any(campaign.stale for campaign in campaigns):
        sys.exit(f"mutation: {LIST} lists what is not needed")


if __name__ == "__main__":
    main()
