"""missing.py EXPORT SOURCE...: from llvm-cov's export, whether the tests have taken each branch both ways and shown
that each condition decides alone (MC/DC). Prints the numbers and what is missing; exit 1 if anything is that
tests/verify/covered/infeasible does not list, or if that lists too much."""

import json
import os
import sys

LIST = "tests/verify/covered/infeasible"
MCDC_BRANCH = 6


class Coverage:
    """One file. A header's function counts once, in however many files it is compiled: what one of them has seen is
    seen."""

    def __init__(self, path):
        self.path = path
        with open(path, encoding="utf-8") as file:
            self.lines = file.read().split("\n")
        self.functions = 0
        self.branches = {}  # by place: how often true, how often false
        self.decisions = {}  # by place: for each condition whether it was shown to decide

    def is_left_out(self):
        return self.functions == 0 and any(line.endswith(") {") for line in self.lines)

    def text(self, place):
        first, begin, last, end = place
        if first == last:
            return self.lines[first - 1][begin - 1:end - 1]
        parts = [self.lines[first - 1][begin - 1:], *self.lines[first:last - 1], self.lines[last - 1][:end - 1]]
        return " ".join(part.strip() for part in parts)

    def add(self, entry):
        for branch in entry["branches"]:
            place = tuple(branch[:4])
            true, false = self.branches.get(place, (0, 0))
            self.branches[place] = (true + branch[4], false + branch[5])
        for record in entry["mcdc_records"]:
            place, shown = tuple(record[:4]), record[-1]
            known = self.decisions.get(place, [False] * len(shown))
            self.decisions[place] = [a or b for a, b in zip(known, shown)]
        self.conditions = [tuple(branch[:4]) for branch in entry["branches"] if branch[8] == MCDC_BRANCH]

    def conditions_of(self, decision):
        inside = {place for place in self.conditions if decision[:2] <= place[:2] and place[2:] <= decision[2:]}
        return sorted(inside)

    def missing(self):
        """Where, the condition's text, and what of it was not seen."""
        for place, (true, false) in sorted(self.branches.items()):
            for count, outcome in ((true, "true"), (false, "false")):
                if count == 0:
                    yield place, self.text(place), f"is never {outcome}"
        for decision, shown in sorted(self.decisions.items()):
            conditions = self.conditions_of(decision)
            for index, is_shown in enumerate(shown):
                if not is_shown:
                    place = conditions[index] if len(conditions) == len(shown) else decision
                    yield place, self.text(place), "never decides alone"

    def numbers(self):
        taken = [count > 0 for counts in self.branches.values() for count in counts]
        shown = [is_shown for decision in self.decisions.values() for is_shown in decision]
        return sum(taken), len(taken), sum(shown), len(shown)


def read_list():
    listed, reason, path = {}, None, None
    with open(LIST, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            line = line.rstrip("\n")
            if line.startswith("because: "):
                reason, path = line[9:], None
            elif line.startswith("lib/") and reason:
                path = line
                if not os.path.isfile(path):
                    raise SystemExit(f"{LIST}:{number}: there is no file {path}")
            elif line.startswith("- ") and path:
                listed[path, line[2:]] = reason
            elif line and not line.startswith("#"):
                raise SystemExit(f"{LIST}:{number}: what is this?")
    return listed


def read_export(path, sources):
    with open(path, encoding="utf-8") as file:
        data = json.load(file)["data"][0]
    files = {source: Coverage(source) for source in sources}
    for entry in data["files"]:
        if entry["filename"] in files:
            files[entry["filename"]].add(entry)
    for function in data["functions"]:
        for path in set(function["filenames"]) & files.keys():
            files[path].functions += 1
    return files.values()


def main():
    listed = read_list()
    unused = set(listed)
    failed = False
    totals = [0, 0, 0, 0]
    for file in read_export(sys.argv[1], sys.argv[2:]):
        totals = [sum(pair) for pair in zip(totals, file.numbers())]
        if file.is_left_out():
            print(f"{file.path}: no test is linked with it")
            failed = True
        for place, text, what in file.missing():
            if (file.path, text) in listed:
                unused.discard((file.path, text))
            else:
                print(f"{file.path}:{place[0]}: `{text}` {what}")
                failed = True
    for path, text in sorted(unused):
        print(f"{LIST}: not needed: {path}: {text}")
    print("branches {} of {}, conditions (MC/DC) {} of {}, infeasible {}".format(*totals, len(listed)))
    sys.exit(failed or bool(unused))


if __name__ == "__main__":
    main()
