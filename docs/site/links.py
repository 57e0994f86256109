# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Checks the links of a built site without a network."""

from __future__ import annotations

import html.parser
import pathlib
import urllib.parse


class Page(html.parser.HTMLParser):
    """What a page links to, loads, and can be linked at."""

    def __init__(self, path: pathlib.Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            elif tag == "a" and name == "href" and value:
                self.links.append(value)
            elif value and (
                (tag in ("script", "img", "source", "iframe") and name == "src") or (tag == "link" and name == "href")
            ):
                self.loaded.append(value)


def faults(site: pathlib.Path) -> list[str]:
    """Returns a sentence for each link to nowhere, each malformed address and whatever a page loads from elsewhere."""
    pages = {path: Page(path) for path in site.rglob("*.html")}
    found = []
    for path, page in pages.items():
        here = path.relative_to(site)
        for link in page.loaded:
            parts = urllib.parse.urlsplit(link)
            if parts.netloc or parts.scheme not in ("", "data"):
                found.append(f"{here} loads {link}, which is not part of the site")
        for link in page.links + [one for one in page.loaded if not urllib.parse.urlsplit(one).netloc]:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme in ("data", "mailto"):
                continue
            if parts.scheme or parts.netloc:
                if parts.scheme not in ("http", "https") or "." not in parts.netloc or " " in link:
                    found.append(f"{here}: {link} is no address")
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                found.append(f"{here}: {link} leads nowhere")
            elif (
                parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors
            ):
                found.append(f"{here}: {link}: there is no such place on that page")
    return sorted(set(found))
