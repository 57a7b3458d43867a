"""Runs the tests against a mutated library until one fails, the likeliest to fail first."""

import hashlib
import os
import re
import resource
import subprocess
import threading

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
