# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The report page in a browser, as its reader sees it.

MESHORDER_PAGE names a page to test instead of the one made here; MESHORDER_PICTURES a folder that gets pictures of it.
"""
import base64
import json
import os
import pathlib
import re
import zlib

import numpy
import pytest

import browser
import conftest

DESKTOP = (1280, 900)
PHONE = (390, 844)
# what each part must show
PARTS = {
    "findings": ["#summary", ".findings p", "#hero canvas", "figure img", "#break-even"],
    "times": ["#table-2", "#table-3", "#table-4"],
    "meshes": ["#mesh-view canvas", "#mesh-view .legend"],
    "spans": ["#table-1", "figure img", "#pattern-view canvas"],
    "caches": ["figure img", "#misses-1"],
    "motion": ["canvas.film", "#motion-view input[type=range]", "#motions"],
    "by-phase": ["figure img", "#phases"],
    "prediction": ["figure img", "#prediction-error", "#kernels"],
    "measured-on": ["#machine", "#protocol"],
}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    if os.environ.get("MESHORDER_PAGE"):
        return pathlib.Path(os.environ["MESHORDER_PAGE"])
    command = conftest.Command(tmp_path_factory.mktemp("report"))
    command.ok("reproduce", "--quick", "--scenario", "falling", "--scenario", "bounce", "--mesh", "ball-10",
               "--budget", "1", "-o", "study")
    return command.folder / "study" / "report.html"


@pytest.fixture(scope="module")
def chromium(tmp_path_factory):
    driver = browser.open_chromium(tmp_path_factory.mktemp("profile"))
    yield browser.Browser(driver)
    driver.quit()


@pytest.fixture
def page(chromium, path):
    """The page, newly opened at a desktop's width."""
    chromium.media("")
    chromium.resize(*DESKTOP)
    chromium.complaints()
    chromium.requests()
    chromium.open(path)
    yield chromium
    complaints = chromium.complaints()
    assert not complaints, complaints


def shown(page, selector):
    """Whether an element of the selector is visible."""
    return page.run("return [...document.querySelectorAll(arguments[0])].some((one) => one.getClientRects().length > 0)",
                    selector)


def column(page, table, number):
    """The cells of a column of a table from the top, numbers as numbers."""
    cells = page.run("""return [...document.querySelector(arguments[0]).tBodies[0].rows].map(
        (row) => row.cells[arguments[1]].dataset.value ?? row.cells[arguments[1]].textContent)""", table, number)
    return [float(cell) if re.fullmatch(r"-?[0-9.e+-]+", cell) else cell for cell in cells]


def drag(page, selector, x, y):
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    canvas = page.driver.find_element(By.CSS_SELECTOR, selector)
    page.run("arguments[0].scrollIntoView({block: 'center'})", canvas)
    ActionChains(page.driver).drag_and_drop_by_offset(canvas, x, y).perform()


def is_blank(pixels, colours=20):
    return len(numpy.unique(pixels.reshape(-1, 4), axis=0)) < colours


def test_it_opens_from_disk_alone(page, path):
    for part in PARTS:
        page.tab(part)
    assert page.requests() == [path.resolve().as_uri()]


def test_it_can_send_nothing(page):
    refused = page.driver.execute_async_script("""
        document.addEventListener("securitypolicyviolation", (event) => arguments[0](event.effectiveDirective));
        fetch("http://127.0.0.1:9/").catch(() => {});""")
    assert refused == "connect-src"
    assert page.complaints()  # the browser reports the refusal


def test_each_tab_shows_what_it_says_and_nothing_else(page):
    for part, selectors in PARTS.items():
        page.tab(part)
        for selector in selectors:
            assert shown(page, f"#{part} {selector}"), (part, selector)
        assert [other for other in PARTS if shown(page, f"#{other}")] == [part]
        selected = page.run("return [...document.querySelectorAll('[aria-selected=true]')].map((one) => one.id)")
        assert selected == [f"tab-{part}"]
        assert page.run("return location.hash") == f"#{part}"


def test_the_address_names_the_tab(page, path):
    page.open(path, "spans")
    assert shown(page, "#spans") and not shown(page, "#findings")
    page.run("location.hash = '#times'")
    page.wait("document.getElementById('times').getClientRects().length > 0")


def test_arrow_keys_go_from_tab_to_tab(page):
    from selenium.webdriver.common.keys import Keys
    page.run("document.getElementById('tab-findings').focus()")
    page.driver.switch_to.active_element.send_keys(Keys.ARROW_RIGHT)
    assert shown(page, "#times") and page.run("return document.activeElement.id") == "tab-times"
    page.driver.switch_to.active_element.send_keys(Keys.END)
    assert shown(page, "#measured-on")
    page.driver.switch_to.active_element.send_keys(Keys.ARROW_RIGHT)
    assert shown(page, "#findings")


def test_a_heading_sorts_its_table_and_gives_the_rows_back(page):
    page.tab("times")
    before = column(page, "#table-2", 0)
    numbers = column(page, "#table-2", 1)
    heading = "document.querySelectorAll('#table-2 thead th')[1]"
    for state, wanted in (("ascending", sorted(numbers)), ("descending", sorted(numbers, reverse=True)), ("none", numbers)):
        page.run(f"{heading}.querySelector('button').click()")
        assert column(page, "#table-2", 1) == wanted
        assert page.run(f"return {heading}.getAttribute('aria-sort')") == state
    assert column(page, "#table-2", 0) == before


def test_sorting_is_by_number_and_leaves_what_is_missing_last(page):
    page.run("""
        const heads = ["name", "number", "word"].map((title) => make("th", {}, title));
        const table = make("table", {id: "made"}, make("thead", {}, make("tr", {}, ...heads)), make("tbody"));
        for (const [name, value, word] of [["p", 10, "b"], ["q", "", "c"], ["r", 9, ""], ["s", -2, "d"], ["t", 9, "a"]]) {
          const cell = make("td", {}, String(value));
          if (value !== "") cell.dataset.value = value;
          table.tBodies[0].append(make("tr", {}, make("th", {}, name), cell, make("td", {}, word)));
        }
        document.querySelector("main").append(table);
        makeSortable(table);""")
    for heading, up, down in ((1, "srtpq", "prtsq"), (2, "tpqsr", "sqptr")):
        for wanted in (up, down):
            page.run("document.querySelectorAll('#made thead button')[arguments[0]].click()", heading)
            assert "".join(column(page, "#made", 0)) == wanted


def test_a_long_table_is_filtered_by_words(page):
    page.tab("prediction")
    rows = column(page, "#kernels", 0)
    word = rows[0].split(", ")[-1]
    page.run("""const input = document.querySelector('#kernels input[type=search]');
        input.value = arguments[0].toUpperCase(); input.dispatchEvent(new Event('input'));""", word)
    left = page.run("return [...document.querySelectorAll('#kernels tbody tr')].filter((row) => row.getClientRects().length)"
                    ".map((row) => row.cells[0].textContent)")
    assert left == [row for row in rows if word in row] and 0 < len(left) < len(rows)


def test_tables_hold_what_the_results_say(page):
    results = json.loads(page.run("return document.getElementById('results').textContent"))
    cells = page.run("""const found = {};
        for (const table of document.querySelectorAll("table[id]"))
          found[table.id] = [...table.querySelectorAll("[data-value]")].map((cell) => Number(cell.dataset.value));
        return found;""")
    for mesh in results["meshes"]:
        for order in mesh["orders"]:
            assert order["span"]["mean"] in cells["table-1"]
    for scenario in results["scenarios"]:
        for order in scenario.get("orders", []):
            assert order["time"]["mean"] in cells["table-2"]


def summary_cells(page, table="summary"):
    """Texts, colours and edges of the cells with the savings of an order."""
    return page.run("""return [...document.querySelectorAll(`#${arguments[0]} td:has(.verdict)`)].map((cell) => {
        const style = getComputedStyle(cell);
        return {value: Number(cell.dataset.value), words: cell.querySelector(".verdict").textContent,
                interval: (cell.querySelector(".interval") || {}).textContent || "", back: style.backgroundColor,
                ink: style.color, edge: style.borderLeftStyle};
      })""", table)


def luminance(colour):
    channels = [int(number) / 255 for number in re.findall(r"\d+", colour)[:3]]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return numpy.dot([0.2126, 0.7152, 0.0722], linear)


def contrast(one, other):
    bright, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("dark", [False, True])
def test_the_first_table_says_what_orders_save_in_words_edges_and_colours(page, path, dark):
    results = json.loads(page.run("return document.getElementById('results').textContent"))
    page.dark(dark)
    try:
        page.open(path)
        first = page.run("""const all = [...document.querySelectorAll('#findings table, #findings .findings p')];
            return all[0].id""")
        assert first == "summary"
        cells = summary_cells(page)
    finally:
        page.dark(False)
    wanted = []
    for scenario in results["scenarios"]:
        for ordering in results["orderings"]:
            speedup = next(order["speedup"] for order in scenario["orders"] if order["ordering"] == ordering["name"])
            if ordering["name"] != results["reference"]:
                certain = "saves" if speedup["percent"] > 0 else "costs"
                wanted.append((speedup["percent"], certain if speedup["beyond_noise"] else "not told apart"))
    assert [(cell["value"], cell["words"]) for cell in cells] == wanted
    edges = {"saves": "solid", "costs": "double", "not told apart": "dotted"}
    for cell in cells:
        assert cell["edge"] == edges[cell["words"]]
        assert (cell["back"] == "rgba(0, 0, 0, 0)") == (cell["words"] == "not told apart")
        if cell["words"] != "not told apart":
            assert contrast(cell["back"], cell["ink"]) >= 7
    heads = page.run("return [...document.querySelectorAll('#summary th')].map((head) => head.scope)")
    assert set(heads) == {"row", "col"}


def test_saving_and_costing_look_different_in_grey_and_without_colour(page):
    """A table with cells of all three kinds, on the screen and on paper."""
    page.run("""const row = make("tr", {}, make("th", {}, "s"));
        for (const kind of ["saves", "open", "costs"])
          row.append(make("td", {className: `number ${kind}`}, "1", make("span", {className: "verdict"}, kind)));
        document.querySelector("#summary tbody").append(row);""")
    edges = {cell["words"]: cell["edge"] for cell in summary_cells(page) if cell["words"] in ("saves", "open", "costs")}
    assert len(set(edges.values())) == 3
    page.media("print")
    backs = {cell["back"] for cell in summary_cells(page)}
    assert backs == {"rgba(0, 0, 0, 0)"}


def test_the_first_table_fits_on_paper(page):
    """With the widest intervals, as on a noisy machine."""
    page.run("for (const interval of document.querySelectorAll('#summary .interval'))"
             " interval.textContent = '−100.0 … −100.0';")
    page.media("print")
    page.resize(718, 1000)  # A4 less margins of a centimetre
    assert page.run("return document.getElementById('summary').offsetWidth") <= 718


def test_arrays_are_unpacked_as_they_were_packed(page, path):
    text = path.read_text()
    manifest = json.loads(page.run("return document.getElementById('manifest').textContent"))

    def unpacked(array):
        packed = re.search(f'id="{array["blob"]}">([^<]*)<', text).group(1)
        numbers = numpy.frombuffer(zlib.decompress(base64.b64decode(packed)), dtype=array["type"]).reshape(array["shape"])
        return numpy.cumsum(numbers, axis=0, dtype=array["type"]) if array.get("delta") else numbers

    frames = manifest["motions"][0]["frames"]
    ranks = next(iter(manifest["meshes"][0]["ranks"].values()))
    for array in (frames, ranks):
        found = page.driver.execute_async_script(
            "const done = arguments[1]; loadNumbers(arguments[0]).then((numbers) => done([...numbers]));", array)
        assert (numpy.array(found) == unpacked(array).ravel()).all()

    middle = frames["shape"][0] // 2
    places = page.driver.execute_async_script("""
        const [frames, frame, done] = arguments;
        const vertices = frames.shape[1];
        loadNumbers(frames).then((numbers) => done([...placesOf(frames, numbers, frame * vertices, vertices)]));
        """, frames, middle)
    expected = frames["offset"] + numpy.array(frames["scale"]) * unpacked(frames)[middle]
    assert numpy.allclose(numpy.reshape(places, (-1, 3)), expected, atol=1e-6 * numpy.abs(expected).max())


def test_the_results_can_be_saved(page):
    saved = page.driver.execute_async_script("""
        const done = arguments[0];
        URL.createObjectURL = (blob) => { blob.text().then(done); return "#"; };
        document.getElementById("save-results").click();""")
    assert json.loads(saved) == json.loads(page.run("return document.getElementById('results').textContent"))


def test_meshes_are_drawn_and_turn_together(page):
    page.tab("meshes")
    canvases = [f"#mesh-view figure:nth-of-type({i + 1}) canvas"
                for i in range(page.run("return document.querySelectorAll('#mesh-view canvas').length"))]
    assert len(canvases) >= 2
    before = [page.pixels(canvas) for canvas in canvases]
    assert not any(is_blank(picture) for picture in before)
    assert (before[0] != before[1]).any(), "orders look the same"
    drag(page, canvases[0], 80, 10)
    turned = [page.pixels(canvas) for canvas in canvases]
    for a, b in zip(before, turned):
        assert (a != b).any(axis=2).mean() > 0.05


def test_the_first_tab_shows_the_roughest_and_the_smoothest_order(page):
    page.wait("document.querySelectorAll('#hero canvas').length === 2")
    titles = page.run("return [...document.querySelectorAll('#hero strong')].map((one) => one.textContent)")
    assert "Scrambled" in titles[0] and "Fiedler" in titles[1]
    for canvas in page.run("return [...document.querySelectorAll('#hero canvas')]"):
        assert not is_blank(page.pixels(canvas))


def test_keys_turn_a_mesh_and_home_turns_it_back(page):
    from selenium.webdriver.common.keys import Keys
    page.tab("meshes")
    canvas = "#mesh-view canvas"
    before = page.pixels(canvas)
    page.run("document.querySelector(arguments[0]).focus()", canvas)
    page.driver.switch_to.active_element.send_keys(Keys.ARROW_LEFT, Keys.ARROW_LEFT)
    assert (page.pixels(canvas) != before).any(axis=2).mean() > 0.02
    page.driver.switch_to.active_element.send_keys(Keys.HOME)
    assert (page.pixels(canvas) == before).all()


def test_the_slider_uncovers_the_order(page):
    """With half of the vertices, about half of the drawing of a scrambled order loses its colour."""
    page.tab("meshes")
    scrambled = page.run("return [...document.querySelectorAll('#mesh-view figure')]"
                         ".find((one) => one.textContent.startsWith('Scrambled')).querySelector('canvas')")

    def coloured():
        pixels = page.pixels(scrambled).astype(int)
        drawn = pixels[..., 3] > 250
        return (drawn & (numpy.ptp(pixels[..., :3], axis=2) > 12)).sum() / drawn.sum()

    assert coloured() > 0.8
    page.run("""const input = document.querySelector('#mesh-view input[type=range]');
        input.value = 500; input.dispatchEvent(new Event('input'));""")
    assert 0.15 < coloured() < 0.75
    words = page.run("return document.querySelector('#mesh-view output').textContent").replace(",", "")
    half, whole = map(int, words.split(" of "))
    assert abs(2 * half - whole) <= 1


def test_a_sweep_runs_to_the_last_vertex_and_ends(page):
    page.tab("meshes")
    page.run("""const input = document.querySelector('#mesh-view input[type=range]');
        input.value = 800; input.dispatchEvent(new Event('input'));
        [...document.querySelectorAll('#mesh-view button')].find((one) => one.textContent === 'Sweep').click();""")
    page.wait("document.querySelector('#mesh-view input[type=range]').value === '1000' && views.meshes.sweeping === false")
    share, whole = page.run("return document.querySelector('#mesh-view output').textContent").split(" of ")
    assert share == whole


def test_two_fingers_zoom(page):
    page.resize(*PHONE, phone=True)
    page.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
    page.tab("motion")
    page.run("document.querySelector('canvas.film').scrollIntoView({block: 'center'})")
    box = page.run("const box = document.querySelector('canvas.film').getBoundingClientRect(); return [box.x, box.y, box.width, box.height]")
    middle = (box[0] + box[2] / 2, box[1] + box[3] / 2)

    def touch(kind, apart):
        points = [{"x": middle[0] + side * apart, "y": middle[1], "id": i} for i, side in enumerate((-1, 1))]
        page.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points if apart else []})

    before = page.run("return views.motion.orbit.zoom")
    touch("touchStart", 30)
    for apart in (40, 50, 60):
        touch("touchMove", apart)
    touch("touchEnd", 0)
    page.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})
    assert 1.7 < page.run("return views.motion.orbit.zoom") / before < 2.3
    assert page.run("return views.motion.orbit.pointers.size") == 0


def test_contour_lines_have_no_colour(page):
    page.tab("meshes")
    page.run("document.querySelector('#mesh-view input[value=contours]').click()")
    pixels = page.pixels("#mesh-view canvas").astype(int)
    assert numpy.ptp(pixels[..., :3], axis=2).max() <= 2 and not is_blank(pixels)


def test_patterns_are_drawn(page):
    page.tab("spans")
    shares = []
    for canvas in page.run("return [...document.querySelectorAll('#pattern-view canvas')]"):
        pixels = page.pixels(canvas)
        side = len(pixels)
        inked = pixels[..., 0] < 250
        assert side >= 32 and inked[numpy.arange(side), numpy.arange(side)].all(), "the diagonal is empty"
        shares.append(inked.mean())
    assert min(shares) < 0.5 * max(shares), "no order is better than another"


def test_the_player_plays_and_stops(page):
    page.tab("motion")
    step = lambda: int(page.run("return document.querySelector('#motion-view output').textContent").split(" of ")[0])
    button = "document.querySelector('#motion-view .play')"
    before, first = step(), page.pixels("canvas.film")
    assert not is_blank(first)
    page.run(f"{button}.click()")
    page.wait("document.querySelector('#motion-view output').textContent.split(' ')[0] !== parameters[0]", str(before))
    page.wait("(window.seen = (window.seen || new Set())).add(document.querySelector('#motion-view output').textContent)"
              ".size > Math.min(views.motion.motion.lastStep, 4)")
    page.run(f"{button}.click()")
    assert (page.pixels("canvas.film") != first).any()
    held = step()
    page.settle()
    assert step() == held and page.run(f"return {button}.textContent") == "Play"


def test_every_motion_can_be_seen_and_turned(page):
    page.tab("motion")
    names = page.run("return [...document.querySelectorAll('#motion-view [type=radio]')].map((one) => one.value)")
    for name in names:
        title = page.run("return document.querySelector('#motion-view figcaption').textContent")
        page.run("document.querySelector(`#motion-view [value='${arguments[0]}']`).click()", name)
        page.wait("views.motion.wanted.scenario === parameters[0] && views.motion.motion.motion === views.motion.wanted", name)
        assert not is_blank(page.pixels("canvas.film")), (name, title)
        assert not is_blank(page.pixels("#motion-view .strip-of-frames button:nth-child(4) canvas")), name
    before = page.pixels("canvas.film")
    drag(page, "canvas.film", 120, 0)
    assert (page.pixels("canvas.film") != before).any(axis=2).mean() > 0.01


def test_a_still_leads_to_its_step(page):
    page.tab("motion")
    page.run("document.querySelectorAll('#motion-view .strip-of-frames button')[3].click()")
    words = page.run("return document.querySelectorAll('#motion-view .strip-of-frames button')[3].textContent")
    assert page.run("return document.querySelector('#motion-view output').textContent").split(" of ")[0] == words.split()[1]


@pytest.mark.parametrize("width", [360, 390, 768])
def test_a_narrow_screen_needs_no_scrolling_sideways(page, path, width):
    page.resize(width, 800, phone=width < 768)
    page.open(path)
    for part in PARTS:
        page.tab(part)
        wide = page.run("return document.documentElement.scrollWidth")
        assert wide <= width, part


def test_on_paper_everything_follows_one_after_another(page):
    page.wait("views.motion && views.meshes && views.spans")  # views that are built in idle time
    page.driver.execute_async_script("const done = arguments[0]; Promise.all(Object.values(views).map((v) => v.ready)).then(done)")
    printed = page.pdf()
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) >= 4
    page.media("print")
    assert all(shown(page, f"#{part} {selector}") for part, selectors in PARTS.items() for selector in selectors
               if "input" not in selector)
    assert not shown(page, ".tabs") and not shown(page, "button.play")
    for canvas in ("#mesh-view canvas", "canvas.film"):
        assert not is_blank(page.pixels(canvas)), canvas
    assert not is_blank(page.pixels("#pattern-view canvas"), colours=3)


def test_what_a_study_does_not_hold_has_no_tab(page, path, tmp_path):
    """A report of a mesh alone has neither scenarios nor motions."""
    of_a_mesh = tmp_path / "mesh.html"
    of_a_mesh.write_text(re.sub(r'data-has="[a-z ]*"', 'data-has="meshes"', path.read_text(), count=1))
    page.open(of_a_mesh)
    left = [part for part in PARTS if part not in ("times", "motion", "by-phase")]
    assert page.run("return [...document.querySelectorAll('.tabs a')].map((one) => one.hash.slice(1))") == left
    for part in left:
        page.tab(part)
        assert shown(page, f"#{part} h2")


def test_without_scripts_everything_follows_one_after_another(chromium, path):
    chromium.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        chromium.driver.get(path.resolve().as_uri())
        found = chromium.driver.execute_cdp_cmd("Runtime.evaluate", {"returnByValue": True, "expression":
            "[...document.querySelectorAll('main > section')].filter((one) => one.getClientRects().length).map((one) => one.id)"})
        assert found["result"]["value"] == list(PARTS)
    finally:
        chromium.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})


def test_without_webgl_it_says_so(page, path):
    hidden = page.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": """
        const real = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
          return /webgl/.test(kind) ? null : real.call(this, kind, ...more);
        };"""})
    try:
        page.open(path)
        page.run("document.getElementById('tab-meshes').click()")
        page.wait("/no WebGL/.test(document.getElementById('mesh-view').innerText)")
        page.run("document.getElementById('tab-motion').click()")
        page.wait("/no WebGL/.test(document.getElementById('motion-view').innerText)")
        page.tab("spans")
        assert shown(page, "#pattern-view canvas")
    finally:
        page.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", hidden)


@pytest.fixture(scope="module")
def two_studies(tmp_path_factory):
    """A page on the committed study and on an invented study of another machine."""
    command = conftest.Command(tmp_path_factory.mktemp("two"))
    results = json.loads((conftest.ROOT / "docs" / "reproduction" / "results.json").read_text())
    for name, points in (("a", 0), ("b", -9)):
        (command.folder / name).mkdir()
        for scenario in results["scenarios"]:
            for order in scenario["orders"]:
                speedup = order["speedup"]
                for key in ("percent", "low", "high"):
                    speedup[key] += points
                speedup["beyond_noise"] = not speedup["low"] <= 0 <= speedup["high"]
        (command.folder / name / "results.json").write_text(json.dumps(results))
    command.ok("report", "a", "b")
    return command.folder / "comparison.html"


@pytest.mark.parametrize("size", [DESKTOP, PHONE])
def test_two_studies_stand_side_by_side(page, two_studies, size):
    page.resize(*size, phone=size == PHONE)
    page.open(two_studies)
    assert page.requests()[-1] == two_studies.resolve().as_uri()
    for table in ("comparison", "comparison-machines", "comparison-seconds", "comparison-kernels"):
        assert shown(page, f"#{table}"), table
    assert {cell["words"] for cell in summary_cells(page, "comparison")} == {"saves", "costs", "not told apart"}
    assert page.run("return document.documentElement.scrollWidth") <= size[0]
    before = column(page, "#comparison", 1)
    page.run("document.querySelectorAll('#comparison thead button')[1].click()")
    assert column(page, "#comparison", 1) == sorted(before)


def test_pictures(page, path, tmp_path):
    """Writes the README's pictures into MESHORDER_PICTURES if it is set."""
    folder = pathlib.Path(os.environ.get("MESHORDER_PICTURES") or tmp_path)
    for name, (width, height) in (("desktop", (900, 800)), ("phone", PHONE)):
        page.resize(width, height)
        page.open(path)
        for part in ("findings", "meshes", "motion"):
            # wide enough for all of the first table
            page.resize(*((1000, 860) if (part, name) == ("findings", "desktop") else (width, height)))
            page.tab(part)
            page.run("arguments[0] ? scrollTo(0, 0) : document.querySelector('main').scrollIntoView()", part == "findings")
            picture = folder / f"report-{part}-{name}.png"
            page.picture(picture)
            assert 10_000 < picture.stat().st_size < 300_000
