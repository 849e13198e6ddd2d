# SPDX-License-Identifier: MIT
"""Sphinx's configuration. scripts/docs.sh calls it with the sources that scripts/site_sources.py has put together."""

import pathlib

project = "Myriad"
author = "The Myriad developers"
copyright = author  # noqa: A001, Sphinx's name for it
_root = pathlib.Path(__file__).resolve().parent
release = (_root / "version.txt").read_text(encoding="utf-8").strip()

extensions = ["myst_parser", "sphinx_design"]
exclude_patterns = ["requirements.txt"]
myst_enable_extensions = ["colon_fence", "substitution"]
myst_heading_anchors = 4
highlight_language = "text"
nitpicky = True

html_theme = "furo"
html_title = f"Myriad {release}"
html_copy_source = False
html_show_sphinx = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_theme_options = {"navigation_with_keys": True}
# What cannot be seen from here, and is not asked for by scripts/docs.sh without --external.
linkcheck_timeout = 20
linkcheck_anchors = False
linkcheck_allowed_redirects = {r".*": r".*"}
