#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks sources for comments with openings and words that have to be read twice, names that use unusual words instead
of the terms of the field, and skipped tests. Status 1 if one is found."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("common", "mesher", "simplify", "tools", "tests", "benchmarks")
RULES = (
    (re.compile(r"^\s*(?:///?<?|#) ?(What|Of|The same|Those)\b"), "a comment opens with '{}'; begin with the verb or the subject"),
    (re.compile(r"\b((?:most|least|fewest|poorest)_[a-z]+)"), "'{}' is a word of our own; the field says min, max or worst"),
    (re.compile(r"\b(GTEST_SKIP|DISABLED_)"), "{}: a test that does not run shows nothing"),
)
# Uses of "place" that are no position: code, parameters, and the verb.
CODE = re.compile(r"`[^`]*`|\\param \w+|\w+\([^)]*\)|\b(?:in|can|by) place")


def vague_word(line):
    """Returns the word "place" in a comment, which may be a point, a position or a location."""
    comment = re.search(r"//.*", line)
    found = comment and re.search(r"\bplaces?\b", CODE.sub("", comment[0]))
    return found[0] if found else None


def opens_sentence(lines, number):
    """Returns whether a line of a comment begins a sentence, rather than continuing that of the previous line."""
    before = lines[number - 1].strip() if number > 0 else ""
    return not before.startswith(("//", "#")) or before.rstrip().endswith((".", ":", ";", "//", "///", "#", "?", "!"))


def findings(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines):
        for rule, text in RULES:
            found = rule.search(line)
            if found and (rule is not RULES[0][0] or opens_sentence(lines, number)):
                yield f"{path.relative_to(ROOT)}:{number + 1}: " + text.format(found.group(1))
        if path.suffix != ".py" and (word := vague_word(line)):
            yield f"{path.relative_to(ROOT)}:{number + 1}: a comment speaks of a '{word}'; say point, position or location"


def main():
    files = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".h", ".cpp", ".js", ".py") and path != pathlib.Path(__file__).resolve()]
    wrong = [line for path in files for line in findings(path)]
    if len(files) < 100:
        wrong.append(f"only {len(files)} files found in {ROOT}")
    print("\n".join(wrong) if wrong else f"{len(files)} files are worded well")
    return 1 if wrong else 0


sys.exit(main())
