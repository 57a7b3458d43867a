"""The mutants of one source file: universalmutator's rules, one line changed in each."""

import contextlib
import hashlib
import io
import os
import re
from dataclasses import dataclass

from universalmutator import mutator

RULES = ["universal.rules", "c_like.rules", "c.rules"]
COMMENT_OR_STRING = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\])*"', re.S)
INCLUDED = re.compile(r'^#include "(.*)"', re.M)
INLINE_FUNCTION = re.compile(r"^static inline .*?^}$", re.S | re.M)


@dataclass(frozen=True)
class Mutant:
    path: str
    number: int  # of the line, from 1
    line: str  # without its indentation
    text: str  # likewise, in one line
    occurrence: int  # among the same changes of equal lines

    @property
    def key(self):
        return hashlib.sha256(f"{self.line}\n{self.text}\n{self.occurrence}".encode()).hexdigest()[:16]

    def show(self):
        return f"{self.path}:{self.number}\n- {self.line}\n+ {self.text}"


def strip_comments(text):
    """Blanks in the place of comments, so that lines stay where they are."""

    def blank(match):
        return match.group() if match.group()[0] == '"' else re.sub(r"[^\n]", " ", match.group())

    return COMMENT_OR_STRING.sub(blank, text)


def goes_on_anyway(lines, number):
    """Does nothing follow line `number` in its loop's body but closing braces, and branches not taken?"""
    while number < len(lines):
        line = lines[number]
        indent = line[:-len(line.lstrip())]
        if line.strip().startswith("} else"):
            number += 1
            while not re.match(indent + "}", lines[number]):
                number += 1
        elif line.strip() == "}":
            openers = [opener for opener in lines[:number] if re.match(indent + r"[^\s}]", opener)]
            if openers and re.match(r"\s*(for|while) ", openers[-1]):
                return True
            number += 1
        else:
            return False
    return False


def enclosing(lines, number):
    """The lines that open the blocks around line `number`, innermost first."""
    depth = len(lines[number - 1]) - len(lines[number - 1].lstrip())
    for line in reversed(lines[:number - 1]):
        indent = len(line) - len(line.lstrip())
        if line.strip() and indent < depth and not line.lstrip().startswith("#"):
            depth = indent
            yield line.strip()


def cannot_compile(lines, number, line, text):
    """The greater part of what does not, found without a compiler: numbers have no %, and only loops can be left."""
    if text.count("%") > line.count("%"):
        return True
    if text not in (line + " break;", line + " continue;"):
        return False
    kinds = ("for ", "while ") if text.endswith("continue;") else ("for ", "while ", "switch ")
    return line[-1] not in ";{}" or not any(opener.startswith(kinds) for opener in [line, *enclosing(lines, number)])


def changes_nothing(lines, number, line, text):
    """Mutants that need no compiler and no test: `continue` where the loop goes on anyway, and != for < in a loop that
    counts up to its end by one."""
    if text == line + " continue;":
        return goes_on_anyway(lines, number)
    counts_up = re.match(r"for \(size_t (\w+) = \w+; \1 < [^;]*; \+\+\1\)", line)
    return counts_up is not None and text == line.replace("<", "!=", 1)


def read(path):
    with open(path, encoding="utf-8") as file:
        return strip_comments(file.read())


def with_headers(path):
    """A file and all that it includes of the library."""
    found = [path]
    for name in found:
        headers = [os.path.normpath(os.path.join(os.path.dirname(name), header)) for header in INCLUDED.findall(read(name))]
        found += [header for header in headers if header not in found]
    return found


class Source:
    """A file without its comments, and what may be changed in it."""

    def __init__(self, path):
        self.path = path
        # The generator reads {- as the beginning of another language's comment.
        self.lines = [line.rstrip().replace("{-", "{ -") + "\n" for line in read(path).split("\n")]
        self.is_header = path.endswith(".h")

    def digest(self, compiler):
        """The same as long as only comments, blanks and empty lines change, here and in what it includes."""
        words = " ".join(" ".join(read(path).split()) for path in with_headers(self.path))
        return hashlib.sha256((compiler + words).encode()).hexdigest()[:24]

    def mutable(self):
        """The numbers of the lines to change: of a header only functions, as the tests are compiled with the
        declarations as they were."""
        if not self.is_header:
            return {number for number, line in enumerate(self.lines, 1) if not re.match(r"#(if|el|end)", line)}
        text = "".join(self.lines)
        numbers = set()
        for function in INLINE_FUNCTION.finditer(text):
            first = text.count("\n", 0, function.start()) + 1
            numbers.update(range(first, first + function.group().count("\n") + 1))
        return numbers

    def mutants(self):
        mutable = self.mutable()
        with contextlib.redirect_stdout(io.StringIO()):
            found = mutator.mutants_regexp(self.lines, RULES, ignorePatterns=[])
        seen = {}
        for number, text, *_ in found:
            if number not in mutable:
                continue
            line, text = self.lines[number - 1].strip(), " ".join(part.strip() for part in text.strip().split("\n"))
            where = (self.lines, number, line, text)
            if cannot_compile(*where) or changes_nothing(*where):
                continue
            occurrence = seen[line, text] = seen.get((line, text), 0) + 1
            yield Mutant(self.path, number, line, text, occurrence)

    def changed(self, mutant):
        lines = list(self.lines)
        lines[mutant.number - 1] = mutant.text + "\n"
        return "".join(lines)
