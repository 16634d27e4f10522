#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every source file begins with the SPDX line of its licence, in scripts after "#!". Status 1 if one does
not."""
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINE = "SPDX-License-Identifier: Apache-2.0"
SUFFIXES = (".h", ".cpp", ".py", ".js", ".css", ".cmake", ".in")
NOT_OURS = ("build", "data", "shared", "seeds", "__pycache__")


def sources():
    for folder, folders, names in os.walk(ROOT):
        here = pathlib.Path(folder).relative_to(ROOT)
        folders[:] = sorted(f for f in folders if f not in NOT_OURS and (not f.startswith(".") or f == ".ci"))
        for name in sorted(names):
            path = here / name
            if (path.suffix in SUFFIXES and not name.endswith(".md.in")) or name == "CMakeLists.txt":
                yield path
            elif path.suffix in ("", ".sh") and not name.startswith("."):
                with open(ROOT / path, "rb") as f:
                    if f.read(2) == b"#!":
                        yield path


def main():
    without, count = [], 0
    for path in sources():
        count += 1
        with open(ROOT / path, encoding="utf-8") as f:
            first, second = f.readline(), f.readline()
        if LINE not in (second if first.startswith("#!") else first):
            without.append(f"{path}: does not begin with \"{LINE}\"")
    if count < 100:
        without.append(f"only {count} files found in {ROOT}")
    print("\n".join(without) if without else f"{count} files name their licence")
    return 1 if without else 0


sys.exit(main())
