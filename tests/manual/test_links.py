# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The check of the manual's links finds broken ones."""

import links
import pytest

GOOD = '<h1 id="top">A page</h1><a href="other.html#here">other</a> <a href="https://example.org/x">elsewhere</a>'


def faults(tmp_path, text):
    (tmp_path / "index.html").write_text(GOOD + text)
    (tmp_path / "other.html").write_text('<p id="here">there</p><a href="index.html#top">back</a>')
    return links.faults(tmp_path)


def test_good_links_pass(tmp_path):
    assert faults(tmp_path, '<img src="data:image/png;base64,xx"><a href="#top">up</a>') == []


@pytest.mark.parametrize(
    "text, said",
    [
        ('<a href="nowhere.html">x</a>', "nowhere.html leads nowhere"),
        ('<a href="other.html#there">x</a>', "no such place"),
        ('<a href="#bottom">x</a>', "no such place"),
        ('<a href="https://example">x</a>', "is no address"),
        ('<img src="missing.png">', "missing.png leads nowhere"),
        ('<script src="https://cdn.example.org/x.js"></script>', "not part of the site"),
        ('<link rel="stylesheet" href="//fonts.example.org/css">', "not part of the site"),
    ],
)
def test_faults_are_named(tmp_path, text, said):
    (fault,) = faults(tmp_path, text)
    assert said in fault
