# SPDX-License-Identifier: Apache-2.0
"""Runs the code blocks of Markdown pages in order, as a reader would who copies them.

    run_blocks.py --program TETWRIGHT [--python-path FOLDER] [--prefix FOLDER] PAGE...

Each page has a separate folder, initially empty, which its blocks share. Blocks of `sh` and `python` are run
separately: in a shell that stops at the first command that fails, or as a script. Blocks of other languages are text,
unless they are a file. Attributes may follow the language of a block:

    no-run        the block is only shown: an installation, or a window that opens
    needs=NAME    the block is run if the program NAME is installed, or with python:NAME the Python module
    status=N      the expected exit status, instead of 0
    file=NAME     the block is written to this file and not run; a script or an input for later blocks

--python-path is the folder of the Python package, --prefix that of the installed library, which blocks find as
~/tetwright-installed. Without them the blocks that need them (`import tetwright`, and `sh` that calls CMake) are left
out. Status 1 if a block fails, or if a package is missing that must not be; blocks that are left out are listed.
"""
import argparse
import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import pages

PYTHON = "/usr/bin/python3"  # another Python on the path may not have Debian's modules
# Packages listed in tools/optional, and those that Debian does not have. Others are installed by tools/setup test.
MAY_BE_MISSING = ("ccx", "python:dolfinx", "python:pyvista")
SECONDS = 500  # for a block, on a busy machine


def is_there(need):
    """Returns whether a program, or with python: a Python module, is installed."""
    kind, colon, name = need.partition(":")
    if not colon:
        return shutil.which(need) is not None
    if kind != "python":
        raise ValueError(f"needs={need} is neither a program nor python:MODULE")
    return importlib.util.find_spec(name) is not None


class Runner:
    """Runs the blocks of one page in a folder."""

    def __init__(self, options, folder):
        self._options = options
        self._folder = folder
        tools = os.path.join(folder, ".bin")
        os.mkdir(tools)
        os.symlink(os.path.abspath(options.program), os.path.join(tools, "tetwright"))
        os.symlink(PYTHON, os.path.join(tools, "python3"))
        self._environment = {**os.environ, "PATH": tools + os.pathsep + os.environ["PATH"],
                             "PYTHONDONTWRITEBYTECODE": "1", "OMP_NUM_THREADS": "1",
                             "PYTHONPATH": options.python_path or ""}
        if options.prefix:
            # The pages install the library into ~/tetwright-installed.
            home = os.path.join(folder, ".home")
            os.mkdir(home)
            os.symlink(os.path.abspath(options.prefix), os.path.join(home, "tetwright-installed"))
            self._environment["HOME"] = home

    def why_not(self, block):
        """Returns why a block is not run, or an empty text."""
        if block.attributes.get("no-run"):
            return "no-run"
        need = block.attributes.get("needs")
        if need and not is_there(need):
            return f"{need} is not installed"
        if not self._options.python_path and "import tetwright" in block.text:
            return "the Python package is not built"
        if not self._options.prefix and block.language == "sh" and "cmake " in block.text:
            return "the library is not installed"
        return ""

    def run(self, block):
        """Runs a block; returns the error, or an empty text."""
        if "file" in block.attributes:
            with open(os.path.join(self._folder, block.attributes["file"]), "w", encoding="utf-8") as file:
                file.write(block.text)
            return ""
        command = {"sh": ["bash", "-euo", "pipefail", "-c", block.text], "python": [PYTHON, "-c", block.text]}.get(block.language)
        if command is None:
            return ""
        # A separate process group, so that no process started by a block outlives it.
        with subprocess.Popen(command, cwd=self._folder, env=self._environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, start_new_session=True) as process:
            try:
                output, _ = process.communicate(timeout=SECONDS)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return f"it took more than {SECONDS} s"
        right = int(block.attributes.get("status", 0))
        if process.returncode == right:
            return ""
        return f"status {process.returncode} instead of {right}\n{block.text}\n{output[-4000:]}"


def run_page(path, options):
    """Runs a page's blocks; returns the number of failures."""
    name = os.path.relpath(path, pages.SOURCE)
    with tempfile.TemporaryDirectory(prefix="tetwright-docs-") as folder:
        runner = Runner(options, folder)
        ran = 0
        for block in pages.blocks(pages.read(path)):
            runs = block.language in ("sh", "python") or "file" in block.attributes
            why_not = runner.why_not(block) if runs else ""
            if why_not and why_not != "no-run":
                print(f"left out: {name}:{block.line}: {why_not}")
                need = block.attributes.get("needs")
                if need and not is_there(need) and need not in MAY_BE_MISSING:
                    print(f"FAILED: {name}:{block.line}: tools/setup test installs {need}")
                    return 1
            if why_not or not runs:
                continue
            begin = time.monotonic()
            wrong = runner.run(block)
            if options.times:
                print(f"{time.monotonic() - begin:6.2f} s  {name}:{block.line}")
            if wrong:
                # The following blocks build upon it.
                print(f"FAILED: {name}:{block.line}: {wrong}")
                return 1
            ran += 1
    print(f"{name}: {ran} blocks as written")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--python-path", default="")
    parser.add_argument("--prefix", default="")
    parser.add_argument("--times", action="store_true", help="print how long each block takes")
    parser.add_argument("pages", nargs="*")
    options = parser.parse_args()
    sys.exit(1 if sum(run_page(path, options) for path in options.pages or pages.guide_pages()) else 0)


if __name__ == "__main__":
    main()
