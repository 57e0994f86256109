# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Displays of results: HTML checked by Python's parser, thumbnails by Pillow, the page of `show` by its own data."""

import base64
import dataclasses
import html.parser
import io
import json
import pickle
import re
import sys
import webbrowser
import zlib

import meshio
import meshorder
import numpy as np
import pytest

from conftest import lattice

pillow = pytest.importorskip("PIL.Image")
EVIL = '<script>alert("x")</script> & \'so\''
VOID = {"img", "br", "meta", "link", "input"}


class Parsed(html.parser.HTMLParser):
    """Tags, attributes and text of HTML whose elements must all be closed in turn."""

    def __init__(self, text):
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.text = ""
        self.feed(text)
        self.close()
        assert not self.open, f"never closed: {self.open}"

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"</{tag}> without its start"

    def handle_data(self, data):
        self.text += data

    def values(self, name):
        return [value for key, value in self.attributes if key == name]


def image(source):
    assert source.startswith("data:image/png;base64,")
    picture = pillow.open(io.BytesIO(base64.b64decode(source.partition(",")[2])))
    picture.verify()
    return np.asarray(pillow.open(io.BytesIO(base64.b64decode(source.partition(",")[2]))).convert("L")) / 255.0


def by_distance(picture):
    """The mean brightness of a square picture by distance from the main diagonal."""
    rows, columns = np.indices(picture.shape)
    away = np.abs(rows - columns)
    return np.array([picture[away == k].mean() for k in range(picture.shape[0])])


@pytest.fixture(scope="module")
def made(mesh):
    return meshorder.make_mesh(*mesh)


@pytest.fixture(scope="module")
def comparison(made):
    return meshorder.compare(made, ["rcm", "scrambled"])


def test_a_comparison_shows_each_order_with_its_pattern_and_bars(comparison):
    page = Parsed(comparison._repr_html_())
    assert page.tags.count("tr") == 1 + len(comparison) and page.tags.count("img") == len(comparison)
    for candidate in comparison:
        assert candidate.vertices in page.text and f"{candidate.milliseconds['assembly']:.3g} ms" in page.text
    assert "predicted" in page.text
    shares = [float(one) for one in re.findall(r"left/(\d+)% ", comparison._repr_html_())]
    assert len(shares) == 4 * len(comparison) and max(shares) == 100
    times = [candidate.milliseconds["assembly"] for candidate in comparison]
    np.testing.assert_allclose(shares[2::4], 100 * np.array(times) / max(times), atol=0.51)


def test_thumbnails_are_dark_along_the_diagonal_of_a_banded_order_only(comparison):
    sources = Parsed(comparison._repr_html_()).values("src")
    pictures = dict(zip([one.vertices for one in comparison], map(image, sources)))
    assert all(picture.shape == (64, 64) for picture in pictures.values())
    banded, scrambled = by_distance(pictures["rcm"]), by_distance(pictures["scrambled"])
    assert banded[:3].mean() < 0.6 and banded[25:].min() == 1.0
    assert np.ptp(scrambled[1:50]) < 0.25 and abs(scrambled[1:5].mean() - scrambled[30:50].mean()) < 0.1


def test_the_pattern_of_a_candidate_counts_every_entry(mesh, comparison):
    points, cells = mesh
    n = len(points)
    dense = np.eye(n, dtype=int)
    for i in range(4):
        for j in range(4):
            dense[cells[:, i], cells[:, j]] = 1
    tile = 64 * np.arange(n) // n
    expected = np.zeros((64, 64), dtype=int)
    rows, columns = np.nonzero(dense)
    np.add.at(expected, (tile[rows], tile[columns]), 1)
    np.testing.assert_array_equal(comparison[0].pattern, expected)
    p = meshorder.order_mesh(points, cells, vertices="rcm").vertices.old_to_new
    expected[:] = 0
    np.add.at(expected, (tile[p[rows]], tile[p[columns]]), 1)
    np.testing.assert_array_equal(comparison[1].pattern, expected)


def test_candidates_are_compared_and_pickled_with_their_patterns(comparison):
    again = pickle.loads(pickle.dumps(comparison[1]))
    assert again == comparison[1] and again != comparison[2] and "pattern" not in repr(again)
    np.testing.assert_array_equal(again.pattern, comparison[1].pattern)


def test_a_mesh_of_few_vertices_has_a_tile_for_each():
    few = meshorder.compare((np.eye(4, 3), np.arange(4)[np.newaxis]), ["rcm"])
    np.testing.assert_array_equal(few[0].pattern, np.ones((4, 4)))
    assert image(Parsed(few._repr_html_()).values("src")[0]).shape == (4, 4)


def test_names_are_escaped(made, graph, comparison):
    evil = dataclasses.replace(comparison[1], vertices=EVIL, elements=EVIL)
    order = dataclasses.replace(meshorder.order(graph, "rcm"), method=EVIL, reason=EVIL, notes=[EVIL])
    for result in (
        meshorder.Comparison([evil]), meshorder.Advice(EVIL, evil, [evil], {}), order,
        meshorder.MeshOrder(order, order), dataclasses.replace(meshorder.fiedler(graph), notes=[EVIL]),
    ):  # fmt: skip
        page = Parsed(result._repr_html_())
        assert EVIL in page.text and "script" not in page.tags


def test_names_of_arrays_and_sets_are_escaped(mesh, tmp_path):
    points, cells = mesh
    data = meshio.Mesh(points, [("tetra", cells)], point_data={"<b>p</b>": points[:, 0]})
    data.write(tmp_path / "mesh.msh", file_format="gmsh22")
    read = meshorder.read(tmp_path / "mesh.msh")
    read.notes.append(EVIL)
    page = Parsed(read._repr_html_())
    assert "<b>p</b>" in page.text and EVIL in page.text and "b" not in page.tags and "script" not in page.tags
    assert "3,072 × tetrahedron of 4" in page.text and "729" in page.text


def test_every_result_has_html(graph, made):
    order = meshorder.order(graph, "fiedler")
    parts = lattice(4, 3)
    two = meshorder.fiedler((np.concatenate([parts.indptr, parts.indptr[-1] + parts.indptr[1:]]),
                             np.concatenate([parts.indices, parts.indices + 12])))  # fmt: skip
    empty = meshorder.Permutation.identity(0)
    for result in (
        order, order.permutation, empty, meshorder.quality(graph, order), two, meshorder.fiedler(graph),
        meshorder.reorder(made)[1], made, meshorder.advise(made), meshorder.quality(([0, 0], [])),
        meshorder.fiedler(([0], [])), meshorder.make_mesh(np.zeros((0, 3)), {}),
    ):  # fmt: skip
        page = Parsed(result._repr_html_())
        assert page.text.strip()
        assert len(result._repr_html_()) < 40_000
    assert "2 components" in Parsed(two._repr_html_()).text
    assert f"{meshorder.quality(graph, order).profile:,}" in Parsed(meshorder.quality(graph, order)._repr_html_()).text


def test_a_permutation_shows_where_things_went():
    same = image(Parsed(meshorder.Permutation.identity(1000)._repr_html_()).values("src")[0])
    back = image(Parsed(meshorder.Permutation(old_to_new=np.arange(999, -1, -1))._repr_html_()).values("src")[0])
    assert (same.diagonal() < 0.2).all() and same[~np.eye(64, dtype=bool)].min() == 1.0
    np.testing.assert_array_less(back[::-1].diagonal(), 0.8)
    # the first hundred go to the end; old places run from left to right, new ones from top to bottom
    turned = meshorder.Permutation(old_to_new=np.roll(np.arange(1000), 100))
    picture = image(Parsed(turned._repr_html_()).values("src")[0])
    assert picture[57, 0] < 0.9 and picture[0, 6] < 0.9 and picture[6, 0] == 1.0


# ---- plots


@pytest.fixture
def axes():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot

    yield pyplot
    pyplot.close("all")


def test_plots(axes, graph, comparison):
    bars = comparison.plot()
    heights = [[bar.get_height() for bar in group] for group in bars.containers]
    expected = [[one.milliseconds[kernel] / comparison[0].milliseconds[kernel] for one in comparison]
                for kernel in ("spmv", "element", "assembly", "springs")]  # fmt: skip
    np.testing.assert_allclose(heights, expected)
    assert [label.get_text().split("\n")[0] for label in bars.get_xticklabels()] == [one.vertices for one in comparison]

    order = meshorder.order(graph, "rcm")
    before, after = order.plot(graph, side=64)
    shown = np.asarray(after.images[0].get_array())
    assert shown.shape == (64, 64) and after.get_title() == "rcm"
    rows, columns = np.nonzero(shown)
    assert np.abs(rows - columns).max() <= 64 * meshorder.quality(graph, order).bandwidth // len(order.permutation) + 1
    assert np.count_nonzero(np.asarray(before.images[0].get_array())) > 2 * len(rows)

    quality = meshorder.quality(graph, order)
    own = axes.subplots()[1]
    assert quality.plot(own) is own
    assert [bar.get_height() for bar in own.patches] == quality.histogram_log2
    own.figure.canvas.draw()


@pytest.mark.parametrize("module, extra", [("matplotlib", "plot"), ("pandas", "pandas")])
def test_what_is_not_installed_is_named_with_its_extra(monkeypatch, comparison, module, extra):
    for name in [name for name in sys.modules if name.partition(".")[0] == module]:
        monkeypatch.delitem(sys.modules, name)

    class Missing:
        @staticmethod
        def find_spec(name, path=None, target=None):
            if name.partition(".")[0] == module:
                raise ModuleNotFoundError(f"No module named {name!r}", name=name)

    monkeypatch.setattr(sys, "meta_path", [Missing, *sys.meta_path])
    with pytest.raises(ImportError, match=rf"meshorder\[{extra}\]"):
        comparison.plot() if module == "matplotlib" else comparison.to_pandas()


def test_a_comparison_becomes_a_table_of_pandas(comparison):
    pytest.importorskip("pandas")
    frame = comparison.to_pandas()
    assert list(frame["vertices"]) == [one.vertices for one in comparison]
    assert frame["mean span"][1] == comparison[1].spans.mean_span


# ---- show


class Shown:
    """The data of a page, unpacked by the description in viewer/README.md."""

    def __init__(self, page):
        self.page = page
        self.elements = dict(re.findall(r'<script type="[a-z/]+" id="([^"]+)">(.*?)</script>', page.html, re.DOTALL))
        self.manifest = json.loads(self.elements["manifest"])
        self.mesh = self.manifest["meshes"][0]

    def array(self, described):
        packed = zlib.decompress(base64.b64decode(self.elements[described["blob"]]))
        return np.frombuffer(packed, dtype="<" + np.dtype(described["type"]).str[1:]).reshape(described["shape"])

    def points(self):
        described = self.mesh["positions"]
        return described["offset"] + np.array(described["scale"]) * self.array(described)


@pytest.fixture
def show(tmp_path):
    def call(*arguments):
        try:
            return meshorder.show(*arguments, path=tmp_path / "page.html")
        except meshorder.Unavailable as missing:
            pytest.skip(str(missing))

    return call


def test_the_page_has_the_surface_and_the_places_of_its_vertices(mesh, made, show, tmp_path):
    points, cells = mesh
    order = meshorder.order_mesh(points, cells, vertices="fiedler")
    page = show(made, order)
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.html and "768 triangles" in repr(page)
    shown = Shown(page)
    triangles = shown.array(shown.mesh["triangles"])
    assert len(triangles) == page.triangles == 6 * 8 * 8 * 2  # six sides of 8 × 8 squares

    faces = np.sort(cells[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3), axis=1)
    faces, counts = np.unique(faces, axis=0, return_counts=True)
    as_it_is, ordered = (shown.array(shown.mesh["ranks"][name]) for name in ("as it is", "fiedler"))
    np.testing.assert_array_equal(np.unique(np.sort(as_it_is[triangles], axis=1), axis=0), faces[counts == 1])
    np.testing.assert_array_equal(ordered, order.vertices.old_to_new[as_it_is])
    np.testing.assert_allclose(shown.points(), points[as_it_is], atol=1e-5)

    normals = np.cross(*(shown.points()[triangles[:, k]] - shown.points()[triangles[:, 0]] for k in (1, 2)))
    outward = shown.points()[triangles].mean(axis=1) - 0.5
    assert (np.einsum("ij,ij->i", normals, outward) > 0).all()

    patterns = {name: shown.array(one) for name, one in shown.mesh["sparsity"].items()}
    entries = {name: int(pattern.sum()) for name, pattern in patterns.items()}
    ends = cells[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2)
    edges = np.unique(np.sort(ends, axis=1), axis=0)
    assert entries == dict.fromkeys(("as it is", "fiedler"), 2 * len(edges) + len(points))


def test_the_page_asks_for_nothing_and_works_in_a_frame(made, show):
    page = show(made, ["rcm", "hilbert"])
    assert [one["name"] for one in Shown(page).manifest["orderings"]] == ["as it is", "rcm", "hilbert"]
    assert not re.search(r'(src|href)="(?!data:)', page.html)
    assert "three.js authors" in page.html and "Permission is hereby granted" in page.html
    frame = Parsed(page._repr_html_())
    assert frame.tags == ["iframe"] and frame.values("srcdoc") == [page.html]
    assert frame.values("sandbox") == ["allow-scripts"]


def test_orders_come_by_name_by_result_and_by_permutation(mesh, made, show):
    order = meshorder.order_mesh(*mesh, vertices="rcm")
    for given, name in (
        ("rcm", "rcm"), (order, "rcm"), (order.vertices, "rcm"), (order.vertices.permutation, "given"),
        ({"mine": order}, "mine"),
    ):  # fmt: skip
        shown = Shown(show(made, given))
        ranks = shown.array(shown.mesh["ranks"][name])
        np.testing.assert_array_equal(ranks, order.vertices.old_to_new[shown.array(shown.mesh["ranks"]["as it is"])])
    assert len(Shown(show(made, [order, order])).mesh["ranks"]) == 3
    assert len(Shown(show(mesh)).mesh["ranks"]) == 2


def test_flat_and_mixed_meshes_are_shown(show):
    points = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [2, 0.5]])
    page = show(meshorder.make_mesh(points, {"quad": [[0, 1, 2, 3]], "triangle": [[1, 4, 2]]}))
    assert page.triangles == 3
    np.testing.assert_allclose(Shown(page).points()[:, 2], 0)


def test_a_text_within_the_page_stays_text(mesh, made, show):
    page = show(made, {EVIL: meshorder.order_mesh(*mesh)})
    assert EVIL not in page.html and EVIL in Shown(page).mesh["ranks"]


def test_what_show_refuses(mesh, made, show):
    with pytest.raises(ValueError, match="cells"):
        show((np.eye(3), {"line": [[0, 1]]}))
    with pytest.raises(meshorder.InvalidArgument, match="an order of 3 "):
        show(made, meshorder.Permutation.identity(3))
    with pytest.raises(meshorder.InvalidArgument, match="expected orders"):
        show(made, 7)
    with pytest.raises(meshorder.InvalidArgument):
        show(made, "no such method")


def test_without_three_js_show_says_how_to_get_it(made, tmp_path, monkeypatch):
    from meshorder import _page

    monkeypatch.setattr(_page, "_VIEWER", tmp_path)
    with pytest.raises(meshorder.Unavailable, match="libjs-three"):
        meshorder.show(made, path=tmp_path / "page.html")


def test_outside_a_notebook_the_browser_opens_the_page(made, show, monkeypatch, tmp_path):
    show(made)  # skips the test where there is no three.js
    opened = []

    def open_page(url):
        opened.append(url)
        return True

    monkeypatch.setattr(webbrowser, "open", open_page)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    page = meshorder.show(made)
    assert page.path and opened == [page.path.as_uri()] and page.path.parent == tmp_path
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    with pytest.warns(UserWarning, match="no browser"):
        meshorder.show(made)
