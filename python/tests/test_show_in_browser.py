# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The page of `show` in Debian's Chromium, alone and in a notebook's frame. MESHORDER_PICTURES names a folder that gets
pictures of it."""

import os
import pathlib
import sys

import meshorder
import numpy as np
import pytest

pytest.importorskip("selenium")
sys.path.append(str(pathlib.Path(__file__).parents[2] / "tests" / "command"))
browser = pytest.importorskip("browser")

DESKTOP, PHONE = (1280, 900), (390, 844)
READY = "document.body.dataset.ready"


@pytest.fixture(scope="module")
def chromium(tmp_path_factory):
    driver = browser.open_chromium(tmp_path_factory.mktemp("profile"))
    yield browser.Browser(driver)
    driver.quit()


@pytest.fixture(scope="module")
def ring():
    """A twisted ring of hexahedra, its vertices and cells shuffled."""
    around, across = 96, 8
    corner = np.arange(around * (across + 1) ** 2).reshape(around, across + 1, across + 1)
    corner = np.concatenate([corner, corner[:1]])
    steps = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = np.stack([corner[i : i + around, j : j + across, k : k + across].ravel() for i, j, k in steps], axis=1)
    angle, a, b = np.meshgrid(
        2 * np.pi * np.arange(around) / around, *[np.linspace(-1, 1, across + 1)] * 2, indexing="ij"
    )
    outward, upward = np.cos(angle) * a - np.sin(angle) * b, np.sin(angle) * a + np.cos(angle) * b
    radius = 3 + outward
    points = np.stack([radius * np.cos(angle), upward, radius * np.sin(angle)], axis=-1).reshape(-1, 3)
    random = np.random.default_rng(1)
    places = random.permutation(len(points))
    return points[places], {"hexahedron": random.permutation(np.argsort(places)[cells])}


@pytest.fixture(scope="module")
def path(ring, tmp_path_factory):
    path = tmp_path_factory.mktemp("show") / "page.html"
    try:
        page = meshorder.show(ring, ["fiedler"], path=path)
        assert page.triangles == 96 * 8 * 4 * 2
    except meshorder.Unavailable as missing:
        pytest.skip(str(missing))
    return path


def picture(chromium, name):
    if os.environ.get("MESHORDER_PICTURES"):
        chromium.picture(pathlib.Path(os.environ["MESHORDER_PICTURES"]) / f"{name}.png", whole=True)


def pictures(chromium):
    """The pixels of the canvases: two of the mesh, two patterns."""
    found = chromium.run("return [...document.querySelectorAll('canvas')]")
    assert len(found) == 4
    return [chromium.pixels(canvas) for canvas in found]


@pytest.mark.parametrize("size, name", [(DESKTOP, "show-desktop"), (PHONE, "show-phone")])
def test_the_page_shows_both_orders_and_asks_for_nothing(chromium, path, size, name):
    chromium.resize(*size, phone=size == PHONE)
    chromium.requests()
    chromium.open(path)
    chromium.wait(READY)
    before, after, *patterns = pictures(chromium)
    for shown in (before, after):
        assert len(np.unique(shown.reshape(-1, 4), axis=0)) > 100 and (shown[..., 3] > 0).mean() > 0.15
    assert (before != after).any(axis=-1).mean() > 0.1
    dark = [np.argwhere(shown[..., 0] < 250) for shown in patterns]
    spread = [np.abs(places[:, 0] - places[:, 1]).mean() for places in dark]
    assert spread[1] < 0.4 * spread[0]  # after the order, entries lie around the diagonal; before it, everywhere
    assert chromium.run("return document.documentElement.scrollWidth") <= size[0]
    assert chromium.requests() == [path.resolve().as_uri()]
    assert not chromium.complaints()
    picture(chromium, name)


def test_both_surfaces_turn_together(chromium, path):
    chromium.resize(*DESKTOP)
    chromium.open(path)
    chromium.wait(READY)
    still = pictures(chromium)
    chromium.run("document.querySelector('canvas').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft'}))")
    turned = pictures(chromium)
    changed = [(a != b).any() for a, b in zip(still, turned)]
    assert changed == [True, True, False, False]


def test_a_sandboxed_frame_shows_it_too(chromium, ring, path, tmp_path):
    page = meshorder.show(ring, ["fiedler"], path=tmp_path / "page.html")
    notebook = f"<!doctype html><meta charset=utf-8>{page._repr_html_()}"
    (tmp_path / "notebook.html").write_text(notebook, encoding="utf-8")
    chromium.resize(960, 900)
    chromium.open(tmp_path / "notebook.html")
    chromium.driver.switch_to.frame(0)
    try:
        chromium.wait(READY)
        assert all(len(np.unique(shown.reshape(-1, 4), axis=0)) > 3 for shown in pictures(chromium))
        with pytest.raises(Exception, match="sandbox|Blocked"):
            chromium.run("return window.parent.document.title")
    finally:
        chromium.driver.switch_to.default_content()
    assert not chromium.complaints()
    picture(chromium, "show-frame")
