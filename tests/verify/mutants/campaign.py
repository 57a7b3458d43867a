"""All mutants of one file: compiled, sorted out, judged by the tests, of which the likeliest to fail is run first."""

import hashlib
import os
import re
import resource
import shutil
import subprocess
import tempfile
import threading
from random import Random

from mutants import Source

HEADER_SHARE = 3  # a header's mutants take the whole library to compile: a third of them is sampled
MEMORY = "/dev/shm"
GIGABYTE = 1 << 30
UNFIT = "nobody"  # a header's mutant that alone compiles and differs, but not where the library includes it


class Test:
    def __init__(self, program, reached):
        self.program = program
        self.name = os.path.basename(program)
        self.reached = reached  # sources
        with open(program, "rb") as file:
            self.digest = hashlib.sha256(file.read()).hexdigest()[:16]
        self.seconds = 0.0  # of processor time, with the library as it is

    def passes(self, folder, limit):
        """With the library in the folder, within so many seconds of processor time: an endless loop fails."""
        command = ["prlimit", f"--cpu={limit}", f"--as={4 * GIGABYTE}", "--core=0", f"--fsize={GIGABYTE}", self.program]
        try:
            return subprocess.run(command, env={**os.environ, "LD_LIBRARY_PATH": folder}, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60 * limit,
                                  check=False).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def measure(self, folder):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        if not self.passes(folder, 600):
            raise SystemExit(f"mutation: {self.name} fails with the library as it is")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.seconds = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def digest_of(tests):
    return hashlib.sha256("".join(test.digest for test in tests).encode()).hexdigest()[:16]


class Judge:
    def __init__(self, tests):
        self.tests = tests
        self.kills = {}
        self.lock = threading.Lock()

    def relevant(self, path):
        return [test for test in self.tests if path in test.reached or path.endswith(".h")]

    def current(self, path, verdict):
        """Does a verdict from an earlier run still hold with these tests?"""
        if verdict["killer"] == UNFIT:
            return True
        if verdict["killer"] is None:
            return verdict["tests"] == digest_of(self.relevant(path))
        return any(test.name == verdict["killer"] and test.digest == verdict["tests"] for test in self.tests)

    def ordered(self, path, killer):
        """The killer of an earlier run, then by kills in this file for the time they take; before there are any, the
        test of the file's name."""
        stem = re.sub(r".*/|\.[ch]$|_.*", "", path)

        def merit(test):
            kills = self.kills.get((path, test.name), 0) + (5 if f"_{stem}" in test.name else 0.1)
            return (test.name == killer, kills / (test.seconds + 0.01))

        return sorted(self.relevant(path), key=merit, reverse=True)

    def verdict(self, path, folder, killer):
        with self.lock:
            tests = self.ordered(path, killer)
        for test in tests:
            if not test.passes(folder, int(3 + 5 * test.seconds)):
                with self.lock:
                    self.kills[path, test.name] = self.kills.get((path, test.name), 0) + 1
                return {"killer": test.name, "tests": test.digest}
        return {"killer": None, "tests": digest_of(self.relevant(path))}


class Campaign:
    """All mutants of one file."""

    def __init__(self, path, tools, sample, seed):
        self.source = Source(path)
        self.builder, self.judge, self.results, self.list, self.pool = tools
        self.mutants = list(self.source.mutants())
        self.digest = self.source.digest(self.builder.identity)
        self.generated = len(self.mutants)
        self.sample = sample
        if sample is not None and self.source.is_header:
            self.sample = -(-sample // HEADER_SHARE)
        if sample is not None:
            Random(f"{seed} {path}").shuffle(self.mutants)
        self.folder = tempfile.TemporaryDirectory(prefix="mutation.", dir=MEMORY if os.path.isdir(MEMORY) else None)
        self.compiled = self.unfit = self.killed = 0
        self.differing = []
        self.survivors = []
        self.listed = []
        self.stale = []  # list entries that are not needed

    def key(self, mutant):
        return self.digest + mutant.key

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

    def killer_of(self, mutant):
        """The test's name, or None."""
        entry = self.results.get(self.key(mutant))
        if "killer" in entry and self.judge.current(self.source.path, entry):
            return entry["killer"]
        folder = self.folder_of(mutant)
        if not os.path.exists(folder):  # compiled by an earlier run
            os.makedirs(folder)
            self.builder.build(self.source, self.source.changed(mutant), folder)
        if self.builder.finish(self.source, folder):
            verdict = self.judge.verdict(self.source.path, folder, entry.get("killer"))
        else:
            verdict = {"killer": UNFIT, "tests": None}
        shutil.rmtree(folder)
        self.results.put(self.key(mutant), verdict)
        return verdict["killer"]

    def distinct(self):
        """Those that compile and differ from the original and from each other, as many as the sample asks for."""
        seen = {self.compile(None, "".join(self.source.lines))}
        if None in seen:
            raise SystemExit(f"mutation: {self.source.path} does not compile as it is")
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

    def judge_all(self, mutants, excused):
        for mutant, killer in zip(mutants, self.pool.map(self.killer_of, mutants)):
            if killer == UNFIT:
                self.unfit += 1
            elif killer is not None:
                self.killed += 1
            elif self.compile(mutant) in excused or self.list.part_of(mutant.line, mutant.text):
                self.listed.append(mutant)
            else:
                self.survivors.append(mutant)

    def run(self):
        self.distinct()
        wanted = self.list.of(self.source.path)
        listed = [mutant for mutant in self.mutants if (mutant.line, mutant.text) in wanted]
        excused = {self.compile(mutant) for mutant in listed}
        missing = wanted - {(mutant.line, mutant.text) for mutant in listed}
        self.stale = [f"{self.source.path}\n- {line}\n+ {text}" for line, text in sorted(missing)]
        if self.sample is not None:
            # Only a run of all mutants justifies the time to see whether the listed ones still survive.
            self.listed = [mutant for mutant in self.differing if self.compile(mutant) in excused]
        self.judge_all([mutant for mutant in self.differing if mutant not in self.listed], excused)
        if self.sample is None:
            surviving = {self.compile(mutant) for mutant in self.listed}
            self.stale += [mutant.show() for mutant in listed if self.compile(mutant) not in surviving]
        self.folder.cleanup()

    def numbers(self):
        return (self.generated, self.compiled - self.unfit, len(self.differing) - self.unfit, self.killed,
                len(self.listed))
