# SPDX-License-Identifier: Apache-2.0
"""Sphinx makes the reference of the Python API of the docstrings of the built package."""
import re

import tetwright

project = "Tetwright"
version = release = tetwright.__version__
extensions = ["sphinx.ext.autodoc"]
html_theme = "alabaster"
html_show_copyright = False
smartquotes = False  # options keep their dashes
autodoc_member_order = "bysource"


def arguments_as_fields(_app, _what, _name, _object, _options, lines):
    """Makes a field of each `name -- description`, as docstrings here list arguments."""
    out = []
    for line in lines:
        argument = re.match(r"(\w+(?:, \w+)*) -- (.*)", line)
        if not argument:
            out.append(line)
            continue
        # Fields begin after an empty line, and several names share a description.
        if out and out[-1] and not out[-1].startswith((":param", "    ")):
            out.append("")
        names = argument[1].split(", ")
        out += [f":param {name}: see {names[-1]}" for name in names[:-1]] + [f":param {names[-1]}: {argument[2]}"]
    lines[:] = out


def setup(app):
    app.connect("autodoc-process-docstring", arguments_as_fields)
