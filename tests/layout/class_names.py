#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that no two headers define classes of the same name in the namespace tetwright: the linker would take the
members of one for those of the other, without a word. Status 1 if two do."""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("common", "mesher", "simplify", "tools")
# Formatted sources do not indent namespaces, so classes within classes do not begin a line.
DEFINITION = re.compile(r"^(?:class|struct|union|enum class) (?:\w+\([^)]*\) )?(\w+)(?: final)?(?: :[^;]*)?(?: \{|$)")
NAMESPACE = re.compile(r"^namespace ([\w:]+) \{")


def definitions(path):
    namespace = ""
    for line in path.read_text(encoding="utf-8").splitlines():
        if opened := NAMESPACE.match(line):
            namespace = opened[1]
        elif defined := DEFINITION.match(line):
            yield f"{namespace}::{defined[1]}"


def main():
    headers = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.h"))]
    known = collections.defaultdict(set)
    for path in headers:
        for name in definitions(path):
            known[name].add(str(path.relative_to(ROOT)))
    repeated = {name: paths for name, paths in known.items() if len(paths) > 1}
    for name, paths in sorted(repeated.items()):
        print(f"{name} is defined in {' and '.join(sorted(paths))}; rename one")
    if not repeated:
        print(f"{len(known)} classes of {len(headers)} headers have different names")
    return 1 if repeated else 0


if __name__ == "__main__":
    sys.exit(main())
