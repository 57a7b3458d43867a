"""Which test runs which lines of the host rooms, by gcov."""

import glob
import hashlib
import json
import os
import shutil
import subprocess
import time

LONGEST = 150  # s: what takes longer is not run for each mutant


def digest_of(paths):
    total = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            total.update(hashlib.sha256(file.read()).digest())
    return total.hexdigest()[:24]


class Lines:
    """Kept in a file for each test, with what it was measured with."""

    def __init__(self, folder, lane, sources):
        self.folder, self.lane = folder, lane
        self.sources = digest_of(sorted(sources))
        self.lines, self.seconds = {}, {}
        os.makedirs(folder, exist_ok=True)

    def stamp(self, test):
        built = os.path.join(self.lane.build, test)
        return digest_of([built if os.path.exists(built) else test]) + self.sources

    def measure(self, test):
        """Runs the test and keeps what it runs; says so if it is of no use: failed, skipped, or too long."""
        kept = os.path.join(self.folder, test.replace("/", "_") + ".json")
        stamp = self.stamp(test)
        if os.path.exists(kept):
            with open(kept, encoding="utf-8") as file:
                found = json.load(file)
            if found["stamp"] == stamp:
                return self.take(test, found)
        counts = os.path.abspath(os.path.join(self.folder, "counts"))
        shutil.rmtree(counts, ignore_errors=True)
        begin = time.monotonic()
        os.environ["GCOV_PREFIX"] = counts
        status = self.lane.run(test, 4 * LONGEST)
        del os.environ["GCOV_PREFIX"]
        found = {"stamp": stamp, "status": status, "seconds": time.monotonic() - begin, "lines": self.read(counts)}
        with open(kept, "w", encoding="utf-8") as file:
            json.dump(found, file)
        return self.take(test, found)

    def take(self, test, found):
        if found["status"] != 0:
            print(f"not used: {test}: " + ("too long" if found["status"] is None else f"exit status {found['status']}"))
        else:
            self.seconds[test] = found["seconds"]
            self.lines[test] = {source: set(lines) for source, lines in found["lines"].items()}

    def read(self, counts):
        """The lines that were run, by source."""
        found = {}
        for path in glob.glob(counts + "/**/obj/lib/**/*.gcda", recursive=True):
            notes = os.path.join(self.lane.build, path[path.index("/obj/lib/") + 1:-5] + ".gcno")
            os.symlink(os.path.abspath(notes), path[:-5] + ".gcno")
            out = subprocess.run(["gcov", "--json-format", "--stdout", path], capture_output=True, check=False, text=True)
            for document in out.stdout.splitlines():
                for file in json.loads(document)["files"]:
                    if file["file"].startswith("lib/"):
                        lines = found.setdefault(file["file"], set())
                        lines.update(line["line_number"] for line in file["lines"] if line["count"] > 0)
        return {source: sorted(lines) for source, lines in found.items()}

    def running(self, source, number):
        """The tests that run this line; of one that no code is of, as a declaration, those that run its file."""
        users = [test for test, lines in self.lines.items() if number in lines.get(source, ())]
        is_code = any(number in lines.get(source, ()) for lines in self.lines.values())
        return users if is_code else [test for test, lines in self.lines.items() if source in lines]
