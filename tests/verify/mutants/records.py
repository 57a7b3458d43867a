"""What is kept in files: what earlier runs found, and the list of mutants that no test can kill."""

import json
import os
import threading


class Results:
    """A line for each finding, appended at once."""

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


class Survivors:
    """The list of mutants that no test can kill, each under the reason why.

        because: a reason, which holds for all that follow up to the next
        lib/math/pose.c
        - the line as it is
        + the line as the mutant has it

    Under `everywhere` instead of a file's name it is not lines, but parts of them, in every file.
    """

    def __init__(self, path):
        self.path = path
        self.reasons = {}  # by file, line and mutant
        self.parts = {}  # by part of a line and of its mutant
        reason = source = line = None
        with open(path, encoding="utf-8") as file:
            for number, text in enumerate(file, 1):
                text = text.rstrip("\n")
                if text.startswith("because: "):
                    reason, source, line = text[9:], None, None
                elif text.startswith("- ") and source:
                    line = text[2:]
                elif text.startswith("+ ") and line is not None and reason:
                    self.add(source, line, text[2:], reason)
                elif text == "+" and line is not None and reason:
                    self.add(source, line, "", reason)
                elif text.startswith("lib/") or text == "everywhere":
                    if text != "everywhere" and not os.path.isfile(text):
                        raise SystemExit(f"{path}:{number}: there is no file {text}")
                    source, line = text, None
                elif text and not text.startswith("#"):
                    raise SystemExit(f"{path}:{number}: what is this?")

    def add(self, source, line, text, reason):
        if source == "everywhere":
            self.parts[line, text] = reason
        else:
            self.reasons[source, line, text] = reason

    def part_of(self, line, text):
        """The listed parts, if any, by which a mutant differs from its line."""
        for part, mutated in self.parts:
            begin = line.find(part)
            while begin >= 0:
                if text == line[:begin] + mutated + line[begin + len(part):]:
                    return part, mutated
                begin = line.find(part, begin + 1)
        return None

    def of(self, path):
        return {(line, text) for source, line, text in self.reasons if source == path}
