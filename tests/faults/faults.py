#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that faults around the program leave complete files, no temporary files, and the right status.

    faults.py PROGRAM [--kills N] [--corruptions N] [--seed S] [--keep FOLDER]

Tests kills at any time, a disk that becomes full, a folder that becomes read-only, two processes with the same output,
limits on memory and open files, and damaged inputs of all formats. Prints the numbers of outcomes; status 1 if one is
wrong, with the files that reproduce it in FOLDER.
"""
import argparse
import collections
import sys
import tempfile
from pathlib import Path

import corruptions
import kills
import scarcity
from common import Program


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--corruptions", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for what shows a fault")
    options = parser.parse_args()
    keep = options.keep or Path(tempfile.mkdtemp(prefix="tetwright-faults-"))
    keep.mkdir(parents=True, exist_ok=True)

    wrong = 0
    for name, test in (
        ("kills", lambda p: kills.run(p, options.kills, options.seed)),
        ("scarcity", lambda p: scarcity.run(p)),
        ("damaged inputs", lambda p: corruptions.run(p, options.corruptions, options.seed)),
    ):
        with tempfile.TemporaryDirectory(prefix="tetwright-") as folder:
            program = Program(options.program.resolve(), Path(folder), keep)
            outcomes = test(program)
        print(f"{name}: {sum(outcomes.values())} cases")
        for outcome, count in sorted(outcomes.items(), key=lambda item: (-item[1], item[0])):
            print(f"  {count:6} {outcome}")
        for fault, count in collections.Counter(program.faults).items():
            print(f"  WRONG ({count} times): {fault}")
        wrong += len(program.faults)
        sys.stdout.flush()
    if wrong:
        print(f"{wrong} wrong; the files are in {keep}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
