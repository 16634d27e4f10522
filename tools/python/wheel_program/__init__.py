# SPDX-License-Identifier: Apache-2.0
"""Runs the wheel's program `tetwright`, which is next to this file; pip puts a script that calls `main` on the PATH."""
import os
import signal
import sys


def main():
    # Python ignores these signals, and the program would inherit this setting.
    for number in (signal.SIGPIPE, signal.SIGXFSZ):
        signal.signal(number, signal.SIG_DFL)
    os.execv(os.path.join(os.path.dirname(__file__), "tetwright"), ["tetwright", *sys.argv[1:]])
