#!/usr/bin/env python3
"""stack.py ROOT[-CUT...] ... < LIST: the deepest stack of calls below each ROOT, in bytes.

LIST names the files that gcc -fcallgraph-info=su wrote, one a line. `wh_grasp_step-pick_swept` leaves out what is
called through pick_swept. Fails on recursion, on frames whose size is not known when compiling, on calls through
pointers, and on functions that are neither in the files nor in LEAVES.
"""

import re
import sys

# Functions that a compiler calls on its own account, and the stack that newlib's versions take.
LEAVES = {"memcpy": 16, "memset": 16,
          # conversions of 64-bit integers in libgcc: pushes from its code, the larger of the Cortex-M7's and the M4F's
          "__aeabi_d2lz": 48, "__aeabi_f2lz": 40, "__aeabi_l2d": 16, "__aeabi_l2f": 16}

# WH_SYMBOL's end of a name, which the functions are not asked by
SYMBOL = re.compile(r'"((?:[^":]*:)?)\*(wh_\w+?)_\d[df](?:_\w*)?(?=[".])')
EDGE = re.compile(r'edge: { sourcename: "([^"]+)" targetname: "([^"]+)"')


def read(paths):
    """Frames by function, and the functions that each calls. Static ones are named file:function."""
    frames, calls = {}, {}
    for path in paths:
        with open(path, encoding="utf-8") as file:
            text = SYMBOL.sub(r'"\1\2', file.read())
        for name, size, kind in re.findall(r'title: "([^"]+)" label: "[^"]*\\n(\d+) bytes \((\w+)', text):
            if kind != "static":
                sys.exit(f"{name}: its frame is {kind}, not known when compiling")
            frames[name] = int(size)
        for caller, callee in EDGE.findall(text):
            calls.setdefault(caller, set()).add(callee)
    return frames, calls


def short(name):
    """gcc writes file.c:function for static functions, and appends what it did to a clone."""
    return name.rsplit(":", 1)[-1].split(".")[0]


def deepest(name, frames, calls, cuts, above):
    """The bytes from `name` down, and the calls that take them."""
    if name in above:
        sys.exit("recursion: " + " > ".join(map(short, above[above.index(name):] + [name])))
    if name not in frames:
        if name in LEAVES:
            return LEAVES[name], [name]
        sys.exit(f"{short(above[-1])} calls {name}, whose stack is not known")
    below = [deepest(callee, frames, calls, cuts, above + [name])
             for callee in sorted(calls.get(name, ())) if short(callee) not in cuts]
    size, path = max(below, default=(0, []))
    return frames[name] + size, [name] + path


def main():
    frames, calls = read(sys.stdin.read().split())
    for argument in sys.argv[1:]:
        root, *cuts = argument.split("-")
        size, path = deepest(root, frames, calls, cuts, [])
        steps = " > ".join(f"{short(name)} {frames.get(name, LEAVES.get(name))}" for name in path)
        print(f"{argument}\t{size}\t{steps}")


if __name__ == "__main__":
    main()
