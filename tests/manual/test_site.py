# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The built manual in a browser, opened from disk. MANUAL names its folder; the default is build/manual."""

import os
import pathlib

import pytest
from browser import Browser, open_chromium

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = pathlib.Path(os.environ.get("MANUAL", ROOT / "build" / "manual"))
PICTURES = SITE.with_name(SITE.name + "-pictures")
PAGES = sorted(str(path.relative_to(SITE)) for path in SITE.rglob("*.html"))
WIDTHS = {"desktop": (1280, 900), "phone": (390, 844)}
#: pages of which pictures are kept
SHOWN = [
    "index.html",
    "start.html",
    "which.html",
    "formats.html",
    "how/fiedler.html",
    "how/solver.html",
    "how/cost.html",
    "reference/command.html",
    "reference/python.html",
    "reference/cpp/order.html",
    "benchmarks.html",
]


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    if not PAGES:
        pytest.skip(f"no manual in {SITE}; docs/site/build.py builds it")
    driver = open_chromium(tmp_path_factory.mktemp("profile"))
    PICTURES.mkdir(exist_ok=True)
    opened = Browser(driver)
    driver.get("about:blank")
    opened.requests()  # drops those of the browser's own first page
    yield opened
    driver.quit()


def check_quiet(browser):
    assert browser.complaints() == []
    assert [url for url in browser.requests() if not url.startswith("file://")] == []


@pytest.mark.parametrize("device", WIDTHS)
def test_every_page_fits_and_asks_no_network(browser, device):
    browser.resize(*WIDTHS[device], phone=device == "phone")
    for page in PAGES:
        browser.open(SITE / page)
        browser.settle()
        too_wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert too_wide <= 0, f"{page} is {too_wide} pixels too wide for a {device}"
        broken = browser.run(
            "return [...document.images].filter((one) => one.complete && !one.naturalWidth).map((one) => one.src)"
        )
        assert broken == [], page
        if page in SHOWN:
            browser.picture(PICTURES / f"{page.removesuffix('.html').replace('/', '-')}-{device}.png")
        check_quiet(browser)


@pytest.mark.parametrize("width", [600, 768, 1024, 1330, 1366, 1920])
def test_the_layout_fits_between_phone_and_wall(browser, width):
    browser.resize(width, 900)
    browser.open(SITE / "start.html")
    assert browser.run("return document.documentElement.scrollWidth") == width


@pytest.mark.parametrize("device", WIDTHS)
def test_search_finds_the_glossary_offline(browser, device):
    browser.resize(*WIDTHS[device], phone=device == "phone")
    browser.open(SITE / "index.html")
    browser.run("""
        const field = document.querySelector(".sidebar-search");
        field.value = "lexmax";
        field.form.submit();""")
    browser.wait(
        "location.pathname.endsWith('search.html') && "
        "[...document.querySelectorAll('.search a')].some((one) => one.textContent === 'Glossary')",
        seconds=20,
    )
    browser.picture(PICTURES / f"search-{device}.png")
    browser.run("[...document.querySelectorAll('.search a')].find((one) => one.textContent === 'Glossary').click()")
    browser.wait(
        "location.pathname.endsWith('glossary.html') && document.body.textContent.includes('Lexmax.')", seconds=20
    )
    check_quiet(browser)


@pytest.mark.parametrize(
    "words, page",
    [("reverse_cuthill_mckee", "python"), ("group-by", "command"), ("mo_order_mesh", "c"), ("order_vertices", "order")],
)
def test_search_finds_names_of_the_interfaces(browser, words, page):
    browser.resize(*WIDTHS["desktop"])
    browser.open(SITE / "search.html")
    browser.driver.get((SITE / "search.html").as_uri() + f"?q={words}")
    browser.wait(
        f"[...document.querySelectorAll('.search a')].some((one) => one.pathname.endsWith('/{page}.html'))", seconds=20
    )
    check_quiet(browser)


def test_the_sections_open_on_a_phone(browser):
    browser.resize(*WIDTHS["phone"], phone=True)
    browser.open(SITE / "index.html")
    browser.run("document.querySelector('label.nav-overlay-icon').click()")
    browser.wait("document.querySelector('.sidebar-drawer').getBoundingClientRect().left >= 0")
    browser.picture(PICTURES / "navigation-phone.png")


def test_dark_colours_follow_the_system(browser):
    browser.resize(*WIDTHS["desktop"])
    browser.dark(True)
    browser.open(SITE / "reference/cpp/order.html")
    red, green, blue = browser.run(
        "return getComputedStyle(document.body).backgroundColor.match(/\\d+/g).slice(0, 3).map(Number)"
    )
    browser.picture(PICTURES / "reference-cpp-order-dark.png")
    browser.dark(False)
    assert max(red, green, blue) < 80
