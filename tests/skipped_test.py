# SPDX-License-Identifier: Apache-2.0
"""Tests skipped.py with results of CTest: permitted and forbidden skips."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).with_name("skipped.py")
OPTIONAL = "# packages\nno-such-package solvers.one a solver\nbash shells.one a shell\n"
RESULTS = """<testsuite><testcase name="good" status="run"/><testcase name="bad" status="fail"/>
<testcase name="solvers.one" status="run"/><testcase name="shells.one" status="run"/>
<testcase name="{}" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/></testcase></testsuite>"""


def listed(skipped, optional_packages=OPTIONAL):
    with tempfile.TemporaryDirectory() as folder:
        results, optional = pathlib.Path(folder, "tests.xml"), pathlib.Path(folder, "optional")
        results.write_text(RESULTS.format(skipped))
        optional.write_text(optional_packages)
        done = subprocess.run([sys.executable, SCRIPT, results, optional], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


class Skipped(unittest.TestCase):
    def test_without_its_optional_package(self):
        self.assertEqual(listed("solvers.one"), (0, "skipped: solvers.one: a solver; no-such-package is not installed\n"))

    def test_although_its_package_is_installed(self):
        status, text = listed("shells.one")
        self.assertEqual(status, 1)
        self.assertIn("although bash is installed", text)

    def test_of_no_test(self):
        status, text = listed("solvers.one", OPTIONAL + "bash shells.two another shell\n")
        self.assertEqual(status, 1)
        self.assertIn("shells.two, which is no test", text)

    def test_without_leave(self):
        status, text = listed("python")
        self.assertEqual(status, 1)
        self.assertIn("FAILED: python was skipped", text)


unittest.main()
