# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Sphinx's settings for the manual. docs/site/build.py assembles the sources,
and sets MANUAL_DOXYGEN and MANUAL_VERSION."""

import dataclasses
import os
import pathlib
from typing import Any

project = "meshorder"
author = "the meshorder authors"
copyright = "the meshorder authors, MIT licence"
version = release = os.environ["MANUAL_VERSION"]
language = "en"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "breathe", "sphinx_copybutton"]
exclude_patterns = ["site", "requirements.txt"]
root_doc = "index"

# Markdown: a heading's anchor is the one that code hosts make of it
myst_heading_anchors = 4
myst_enable_extensions = ["attrs_inline", "colon_fence", "deflist"]
myst_links_external_new_tab = False

# Python: Google's docstrings; `name` refers to what is documented here
default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_default_options = {"members": True}
autodoc_type_aliases = {"ArrayLike": "ArrayLike", "NDArray": "NDArray"}  # as annotations are written
napoleon_numpy_docstring = False
napoleon_use_ivar = True
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 80
toc_object_entries_show_parents = "hide"

# C and C++: what Doxygen found in the headers
breathe_projects = {"meshorder": os.environ["MANUAL_DOXYGEN"]}
breathe_default_project = "meshorder"
breathe_default_members = ("members",)
breathe_domain_by_extension = {"hpp": "cpp", "h": "c"}
cpp_maximum_signature_line_length = 90
c_maximum_signature_line_length = 90
cpp_index_common_prefix = ["meshorder::"]

nitpicky = True
# Sphinx cannot tell constructors apart that differ in their `requires` alone; a namespace is declared on every page
suppress_warnings = ["duplicate_declaration.cpp"]
nitpick_ignore_regex = [
    # types of the standard library, which have no page here, and names of template parameters
    (r"cpp:identifier", r".*"),
    (r"c:identifier", r".*"),
    # types in annotations, of other packages and private ones; exceptions of Python
    (r"py:class", r".*"),
    (r"py:(?!obj|class).*", r"(?!meshorder\.[^_]).*"),
]

html_theme = "furo"
html_title = f"meshorder {version}"
html_static_path = ["site/static"]
html_css_files = ["manual.css"]
html_search_scorer = str(pathlib.Path(__file__).parent / "site" / "scorer.js")
html_copy_source = False
html_show_sphinx = False
html_show_search_summary = False  # excerpts are fetched, which browsers refuse for files on disk
html_theme_options = {"navigation_with_keys": True}
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = False
pygments_style = "friendly"
highlight_language = "none"


#: classes that functions make, beside dataclasses and named tuples: how to make one says nothing to users
MADE_BY_FUNCTIONS = ("meshorder.Mesh", "meshorder.Comparison")


def without_constructor(
    app: Any, what: str, name: str, value: Any, options: Any, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """Drops the signature of results, which nobody makes by hand."""
    if what == "class" and (dataclasses.is_dataclass(value) or issubclass(value, tuple) or name in MADE_BY_FUNCTIONS):
        return "", None
    return signature, returned


def without_aliases(app: Any, what: str, name: str, value: Any, options: Any, lines: list[str]) -> None:
    """Drops what Python itself says of the fields of a named tuple."""
    if lines and lines[0].startswith("Alias for field number"):
        lines.clear()


def setup(app: Any) -> None:
    app.connect("autodoc-process-signature", without_constructor)
    app.connect("autodoc-process-docstring", without_aliases)
