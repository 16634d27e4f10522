# SPDX-License-Identifier: Apache-2.0
"""The program `tetwright` of a wheel, beside this file; pip puts a script that calls `main` on the PATH."""
import os
import signal
import sys


def main():
    for ignored in (signal.SIGPIPE, signal.SIGXFSZ):  # by Python, and so by the program, if they were left so
        signal.signal(ignored, signal.SIG_DFL)
    os.execv(os.path.join(os.path.dirname(__file__), "tetwright"), ["tetwright", *sys.argv[1:]])
