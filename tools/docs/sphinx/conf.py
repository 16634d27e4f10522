# SPDX-License-Identifier: Apache-2.0
"""Sphinx makes the reference of the Python API of the docstrings of the built package."""
import tetwright

project = "Tetwright"
version = release = tetwright.__version__
extensions = ["sphinx.ext.autodoc", "sphinx.ext.napoleon"]
html_theme = "alabaster"
html_show_copyright = False
autodoc_member_order = "bysource"
