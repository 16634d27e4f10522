# SPDX-License-Identifier: Apache-2.0
"""Common parts of the fault tests."""
import shutil
import subprocess
from pathlib import Path

# Documented exit statuses: done, request not met, invalid call, invalid input, nothing to mesh, no output, interrupted.
# 70 is a bug in the program.
STATUSES = {0, 1, 2, 3, 4, 5, 130}
# Seconds; longer than any of these runs takes on a machine ten times slower.
TIMEOUT = 300


class Program:
    def __init__(self, path, folder, keep):
        self.path, self.folder, self.keep = path, folder, keep
        self.faults = []

    def start(self, arguments, prefix=(), **options):
        """Starts the program, through the command `prefix` if there is one."""
        return subprocess.Popen([*prefix, str(self.path), *map(str, arguments)], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", **options)

    def run(self, arguments, **options):
        """Runs the program; returns its status, or None if it hangs, and its output to stderr."""
        process = self.start(arguments, **options)
        try:
            error = process.communicate(timeout=TIMEOUT)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return None, ""
        return process.returncode, error

    def must(self, arguments):
        status, error = self.run(arguments)
        if status not in (0, 1):
            raise SystemExit(f"{' '.join(map(str, arguments))}: status {status}: {error}")

    def wrong(self, what, *files):
        """Records a fault, and keeps the files that reproduce it."""
        self.faults.append(what)
        for file in files:
            file = Path(file)
            if file.is_file():
                shutil.copy(file, self.keep / f"{len(self.faults):03}-{file.name}")


def temporaries(folder):
    return list(Path(folder).glob(".tetwright-*.tmp"))
