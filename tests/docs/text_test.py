# SPDX-License-Identifier: Apache-2.0
"""Checks that what README and guide mention exists: options, commands, links, anchors, pictures and files.

    text_test.py TETWRIGHT
"""
import os
import re
import subprocess
import sys
import unittest

import pages

PROGRAM = ""
MAX_README_LINES = 150
MAX_PICTURE_BYTES = 200_000

# Options of other programs that the text mentions.
OTHERS = {"--bind-to", "--build", "--install", "--map-by", "--mca", "--ml", "--no-build-isolation", "--no-deps", "--prefix", "--suite", "--system-site-packages",
          "--target"}


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout


def commands():
    """Returns the names of the program's commands."""
    listed = run("--help").split("Subcommands:")[1]
    return re.findall(r"^  ([a-z]+) ", listed, re.M)


def options_of(command):
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", run(command, "--help")))


def name_of(path):
    return os.path.relpath(path, pages.SOURCE)


class TextTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pages = {path: pages.read(path) for path in pages.guide_pages()}
        cls.options = {command: options_of(command) for command in commands()}
        cls.all_options = set().union(*cls.options.values()) | {"--help", "--version"}

    def test_options_in_the_text_exist(self):
        for path, text in self.pages.items():
            for number, line in enumerate(text.splitlines(), 1):
                for option in re.findall(r"(?<![\w-])--[a-z][a-z-]*", line):
                    self.assertIn(option, self.all_options | OTHERS, f"{name_of(path)}:{number}")

    def test_a_command_has_the_options_that_it_is_shown_with(self):
        call = re.compile(r"tetwright (" + "|".join(self.options) + r")\b([^`|;&\n]*)")
        for path, text in self.pages.items():
            for found in call.finditer(text.replace("\\\n", " ")):
                if os.path.basename(path) == "messages.md":
                    continue  # quotes messages, which name two commands
                for option in re.findall(r"(?<![\w-])--[a-z][a-z-]*", found[2]):
                    self.assertIn(option, self.options[found[1]] | {"--help"}, f"{name_of(path)}: {found[0]}")

    def test_every_option_is_in_the_table(self):
        table = pages.read(os.path.join(pages.SOURCE, "data", "guide", "options.md"))
        for command, options in self.options.items():
            for option in options - {"--help"}:
                self.assertIn(f"`{option}`", table, command)

    def test_links_and_pictures_resolve(self):
        for path in pages.all_pages():
            for target, line in pages.links(pages.read(path)):
                if re.match(r"[a-z]+:", target):
                    continue
                file, _, anchor = target.partition("#")
                at = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
                self.assertTrue(os.path.exists(at), f"{name_of(path)}:{line}: {target}")
                if anchor and at.endswith(".md"):
                    self.assertIn(anchor, pages.anchors(pages.read(at)), f"{name_of(path)}:{line}: {target}")

    def test_every_page_is_in_the_index(self):
        guide = os.path.join(pages.SOURCE, "data", "guide")
        listed = {target for target, _ in pages.links(pages.read(os.path.join(guide, "README.md")))}
        for path in self.pages:
            if os.path.dirname(path) == guide and os.path.basename(path) != "README.md":
                self.assertIn(os.path.basename(path), listed)

    def test_pictures_are_used_and_small(self):
        folder = os.path.join(pages.SOURCE, "data", "guide", "pictures")
        used = {os.path.basename(target) for text in self.pages.values() for target, _ in pages.links(text)}
        for name in os.listdir(folder):
            self.assertIn(name, used)
            self.assertLess(os.path.getsize(os.path.join(folder, name)), MAX_PICTURE_BYTES, name)

    def test_scripts_in_the_text_exist(self):
        for path, text in self.pages.items():
            for script in re.findall(r"(?<![\w/])(?:tools|tests|benchmarks|\.ci)/[\w/.-]*\w", text):
                self.assertTrue(os.path.exists(os.path.join(pages.SOURCE, script)), f"{name_of(path)}: {script}")

    def test_the_readme_is_short(self):
        text = self.pages[os.path.join(pages.SOURCE, "README.md")]
        self.assertLessEqual(len(text.splitlines()), MAX_README_LINES)

    def test_the_readme_shows_the_program_that_the_guide_compiles(self):
        programs = [block.text for name in ("README.md", "data/guide/cpp.md")
                    for block in pages.blocks(self.pages[os.path.join(pages.SOURCE, name)]) if block.attributes.get("file") == "main.cpp"]
        self.assertEqual(len(programs), 2)
        self.assertEqual(*programs)

    def test_codes_of_messages_are_listed_once(self):
        text = pages.read(os.path.join(pages.SOURCE, "data", "guide", "messages.md"))
        codes = re.findall(r"^\| `([a-z-]+)` \| (?:note|shortfall|error|warning)", text, re.M)
        self.assertGreater(len(codes), 50)
        self.assertEqual(len(codes), len(set(codes)))


def main():
    global PROGRAM
    PROGRAM = sys.argv[1]
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])


if __name__ == "__main__":
    main()
