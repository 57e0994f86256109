# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The page of browser/build, which orders meshes in the browser, compared with the command.

BROWSER_PAGE names the page; the default is build-browser/meshorder.html. MESHORDER names the command."""

import gzip
import os
import pathlib
import re
import subprocess
import time

import pytest
from browser import Browser, open_chromium

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = pathlib.Path(os.environ.get("BROWSER_PAGE", ROOT / "build-browser" / "meshorder.html"))
COMMAND = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
PICTURES = PAGE.with_name("pictures")
WIDTHS = {"desktop": (1400, 1000), "phone": (390, 844)}
VOLUMES = ["msh", "mesh", "vtk", "vtu", "inp", "ucd", "bdf", "su2", "unv", "node", "veg"]
SURFACES = ["off", "ply", "obj", "stl"]
METHODS = ["hilbert-fronts", "hilbert", "rcm", "bfs", "original"]


def command(*arguments, cwd):
    return subprocess.run([COMMAND, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)


def box(side):
    """A Medit file of cubes cut into tetrahedra, without the boundary."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1)]
    parts = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]
    steps = range(side + 1)
    points = [f"{x} {y} {z + 0.1 * x * y / side} 0" for z in steps for y in steps for x in steps]
    number = lambda x, y, z: 1 + x + (side + 1) * (y + (side + 1) * z)  # noqa: E731
    cells = [
        " ".join(str(number(x + corners[c][0], y + corners[c][1], z + corners[c][2])) for c in part) + " 1"
        for z in range(side) for y in range(side) for x in range(side) for part in parts
    ]  # fmt: skip
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points)), *points]
    return "\n".join([*lines, "Tetrahedra", str(len(cells)), *cells, "End", ""])


def sheet(side):
    """An OFF file of a bent square of triangles."""
    points = [f"{x} {y} {0.05 * x * y}" for y in range(side + 1) for x in range(side + 1)]
    squares = [(x + (side + 1) * y) for y in range(side) for x in range(side)]
    halves = [((v, v + 1, v + side + 2), (v, v + side + 2, v + side + 1)) for v in squares]
    cells = [f"3 {a} {b} {c}" for half in halves for a, b, c in half]
    return "\n".join(["OFF", f"{len(points)} {len(cells)} 0", *points, *cells, ""])


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """A folder with a scrambled mesh in each format."""
    folder = tmp_path_factory.mktemp("meshes")
    (folder / "first.mesh").write_text(box(6))
    (folder / "first.off").write_text(sheet(12))
    for source, extensions in (("first.mesh", VOLUMES), ("first.off", SURFACES)):
        for extension in extensions:
            made = command("order", source, "-o", f"part.{extension}", "--vertices", "scrambled", "-q", cwd=folder)
            assert made.returncode == 0, made.stderr
    rows = "\n".join(f"{i} {(7 * i) % 50 + 1} 1.5" for i in range(1, 51))
    (folder / "part.mtx").write_text(f"%%MatrixMarket matrix coordinate real general\n50 50 50\n{rows}\n")
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    if not PAGE.is_file():
        pytest.skip(f"no page {PAGE}; browser/build makes it")
    driver = open_chromium(tmp_path_factory.mktemp("profile"))
    opened = Browser(driver)
    opened.is_as_new = False
    opened.downloads = tmp_path_factory.mktemp("downloads")
    driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(opened.downloads)})
    PICTURES.mkdir(exist_ok=True)
    opened.resize(*WIDTHS["desktop"])
    driver.get("about:blank")
    opened.requests()  # drops those of the browser's own first page
    yield opened
    driver.quit()


@pytest.fixture
def page(browser):
    """The page; opened again only if an earlier test has changed more than the page's files."""
    if not browser.is_as_new:
        open_page(browser)
    browser.is_as_new = True
    yield browser
    assert browser.complaints() == []
    assert [url for url in browser.requests() if not url.startswith("file://")] == []


def open_page(browser):
    browser.open(PAGE)
    settled(browser)


def settled(browser, state="done"):
    browser.wait("['done', 'failed'].includes(document.body.dataset.state)")
    assert browser.run("return [document.body.dataset.state, document.getElementById('error').textContent]")[0] == state


def text(browser, name):
    return browser.run("return document.getElementById(arguments[0]).textContent", name)


def give(browser, *paths):
    browser.run("document.body.dataset.state = ''; document.getElementById('file').value = ''")
    browser.driver.find_element("id", "file").send_keys("\n".join(map(str, paths)))


def saved(browser, *names):
    """The bytes of files that the page saves."""
    for path in browser.downloads.iterdir():
        path.unlink()
    browser.run("document.getElementById('save').click()")
    until = time.monotonic() + 20
    while {path.name for path in browser.downloads.iterdir()} != set(names):
        assert time.monotonic() < until, list(browser.downloads.iterdir())
        time.sleep(0.05)
    return [(browser.downloads / name).read_bytes() for name in names]


def choose(browser, method):
    browser.is_as_new = False
    browser.run(
        "document.body.dataset.state = ''; document.querySelector(`input[value='${arguments[0]}']`).click()", method
    )


def test_shows_a_ball_at_once(page):
    open_page(page)
    assert text(page, "name") == "ball.off"
    assert "times nearer in memory" in text(page, "gains")
    as_it_is, ordered = (page.pixels(f".orders figure:nth-child({k}) canvas") for k in (1, 2))
    assert len(set(map(bytes, ordered.reshape(-1, 4)))) > 100
    assert (as_it_is != ordered).mean() > 0.2
    (ball,) = saved(page, "ordered-ball.off")
    assert ball.startswith(b"OFF")


@pytest.mark.parametrize("extension", [*VOLUMES, *SURFACES, "mtx"])
def test_saves_the_bytes_that_the_command_writes(page, meshes, extension):
    names = [f"part.{extension}"] + (["part.ele"] if extension == "node" else [])
    give(page, *(meshes / name for name in names))
    settled(page)
    outputs = [f"ordered-{name}" for name in names]
    made = command("order", names[0], "-o", outputs[0], cwd=meshes)
    assert made.returncode == 0, made.stderr
    assert saved(page, *outputs) == [(meshes / name).read_bytes() for name in outputs]
    spans = next(line for line in made.stdout.splitlines() if line.startswith(("edge span", "distance")))
    assert spans in text(page, "lines")


@pytest.mark.parametrize("method", METHODS)
def test_orders_by_each_method(page, meshes, method):
    give(page, meshes / "part.msh")
    settled(page)
    choose(page, method)
    settled(page)
    command("order", "part.msh", "-o", "by-method.msh", "--vertices", method, "-q", cwd=meshes)
    assert saved(page, "ordered-part.msh") == [(meshes / "by-method.msh").read_bytes()]


@pytest.mark.parametrize("method", ["spectral", "spectral-fronts"])
def test_spectral_orders_are_as_good(page, meshes, method):
    """Spectral orders depend on rounding, which differs between processors."""
    give(page, meshes / "part.msh")
    settled(page)
    choose(page, method)
    settled(page)
    made = command("order", "part.msh", "-o", "by-method.msh", "--vertices", method, cwd=meshes)
    here, there = (re.search(r"edge span +mean .* → ([\d.]+), largest", said)[1] for said in (text(page, "lines"), made.stdout))
    assert float(here) == pytest.approx(float(there), rel=0.05)


def test_unpacks_gzip_files(page, meshes):
    (meshes / "part.msh.gz").write_bytes(gzip.compress((meshes / "part.msh").read_bytes()))
    give(page, meshes / "part.msh.gz")
    settled(page)
    command("order", "part.msh", "-o", "unpacked.msh", "-q", cwd=meshes)
    assert saved(page, "ordered-part.msh") == [(meshes / "unpacked.msh").read_bytes()]


def test_takes_a_dropped_file_and_shows_its_name_as_text(page, meshes):
    page.run(
        """document.body.dataset.state = '';
        const transfer = new DataTransfer();
        transfer.items.add(new File([arguments[0]], "<img src=x>.off"));
        document.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));""",
        (meshes / "part.off").read_text(),
    )
    settled(page)
    assert text(page, "name") == "<img src=x>.off"
    assert page.run("return document.images.length") == 0


@pytest.mark.parametrize("bad", ["cut.msh", "numbers.off", "only.node", "empty.vtk"])
def test_says_of_a_broken_file_what_the_command_says(page, meshes, bad):
    contents = {
        "cut.msh": (meshes / "part.msh").read_bytes()[:3000],
        "numbers.off": (meshes / "part.off").read_bytes().replace(b"\n3 ", b"\n3 <b>x</b> ", 1),
        "only.node": (meshes / "part.node").read_bytes(),
        "empty.vtk": b"",
    }
    (meshes / bad).write_bytes(contents[bad])
    give(page, meshes / bad)
    settled(page, "failed")
    made = command("order", bad, "-o", f"ordered-{bad}", cwd=meshes)
    assert made.returncode == 2
    assert text(page, "error") == made.stderr.removeprefix("meshorder: ").rstrip("\n")
    give(page, meshes / "part.msh")
    settled(page)
    assert page.run("return document.getElementById('error').hidden")


def test_refuses_an_order_that_a_matrix_cannot_have(page, meshes):
    give(page, meshes / "part.mtx")
    settled(page)
    choose(page, "hilbert")
    settled(page, "failed")
    made = command("order", "part.mtx", "-o", "x.mtx", "--vertices", "hilbert", cwd=meshes)
    fault = made.stderr.removeprefix("meshorder: ").partition(", or use an order")[0]  # the page lacks METIS's orders
    assert fault and text(page, "error").startswith(fault)


@pytest.mark.parametrize("name, said", [("part.xyz", "unknown extension '.xyz'"), ("part.exo", "lacks")])
def test_says_which_formats_it_does_not_read(page, tmp_path, name, said):
    (tmp_path / name).write_bytes(b"CDF")
    give(page, tmp_path / name)
    settled(page, "failed")
    assert text(page, "error").startswith(f"ordered-{name}: ") and said in text(page, "error")


def test_refuses_files_beyond_its_memory(page):
    page.run(
        """document.body.dataset.state = '';
        const huge = new File(["x"], "huge.msh");
        Object.defineProperty(huge, "size", { value: 5e9 });
        takeFiles([huge]);"""
    )
    settled(page, "failed")
    assert "huge.msh: has 4,768 MiB, more than the" in text(page, "error")


def test_says_that_a_module_fails(page):
    page.is_as_new = False
    page.run(
        """document.body.dataset.state = '';
        page.wasm = WebAssembly.compile(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]));
        orderNow().catch((failure) => showError(failure.message));"""
    )
    settled(page, "failed")
    assert text(page, "error").startswith("the ordering ended: ")


def test_has_no_way_to_the_network(page):
    """The browser reports the attempt, as this test expects."""
    refused = page.driver.execute_async_script(
        """const done = arguments[0];
        fetch("https://example.org/").then(() => done("sent"), () => done("refused"));"""
    )
    assert refused == "refused"
    assert any("Content Security Policy" in said for said in page.complaints())
    assert not any("example.org" in url for url in page.requests())


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("device", WIDTHS)
def test_fits(browser, device, dark):
    browser.resize(*WIDTHS[device], phone=device == "phone")
    browser.dark(dark)
    browser.is_as_new = False
    open_page(browser)
    too_wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
    browser.picture(PICTURES / f"{device}{'-dark' if dark else ''}.png", whole=True)
    browser.dark(False)
    browser.resize(*WIDTHS["desktop"])
    assert too_wide <= 0
