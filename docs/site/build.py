#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Builds the manual from docs/, the command's help, the Python package and the public headers.

    docs/site/build.py [FOLDER]          FOLDER/index.html, build/manual/index.html by default

To be run by a Python that has what docs/requirements.txt lists and the package meshorder. MESHORDER names the command,
build/bin/meshorder by default. Warnings of Sphinx and Doxygen are errors, and so are links to nowhere. The sources as
Sphinx gets them are left in FOLDER-sources.
"""

from __future__ import annotations

import os
import pathlib
import re
import shutil
import subprocess
import sys

import command_reference
import formats_table
import headers
import links
import python_reference

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = ROOT / "docs" / "site"
#: files of the root that are pages of the manual; other Markdown and folders outside docs/ are named, not linked
ROOT_PAGES = {"README.md": "start.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}
#: sections of the root's files that have another place here
ROOT_SECTIONS = {"README.md#formats": "formats.md", "README.md#from-c": "install.md"}
DOWNLOADS = "files"
BROWSER_PAGE = ROOT / "build-browser" / "meshorder.html"
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)")
IMAGE = re.compile(r"(!\[[^\]]*\]\()([^)\s]+)\)")


def fail(message: str) -> None:
    sys.exit(f"docs/site/build.py: {message}")


def run(*command: str, **options: object) -> None:
    if subprocess.run(command, cwd=ROOT, check=False, **options).returncode:  # type: ignore[call-overload]
        fail(f"{pathlib.Path(command[0]).name} failed")


def relinked(text: str, folder: pathlib.Path, page_folder: pathlib.Path, downloads: set[pathlib.Path]) -> str:
    """Markdown of a file in `folder`, with its links as a page of the manual in `page_folder` needs them.

    `downloads` receives the files outside docs/ that it links to, which are to be copied to the folder DOWNLOADS.
    """

    def target(link: str) -> str | None:
        if re.match(r"[a-z]+:|#", link):
            return link
        path, _, anchor = link.partition("#")
        place = (folder / path).resolve()
        inside = place.relative_to(ROOT)
        if inside.parts[0] == "docs":  # Sphinx sees to these
            local = os.path.relpath(place, page_folder)
            return f"{local}#{anchor}" if anchor else local
        if not place.exists():
            fail(f"{folder.relative_to(ROOT)}: a link to {link}, which does not exist")
        whole = f"{inside}#{anchor}" if anchor else str(inside)
        page = ROOT_SECTIONS.get(whole) or ROOT_PAGES.get(str(inside))
        if page:
            return os.path.relpath(ROOT / "docs" / page, page_folder)
        if place.is_file() and place.suffix != ".md":
            downloads.add(inside)
            return os.path.relpath(ROOT / "docs" / DOWNLOADS / inside, page_folder)
        return None

    def link(found: re.Match[str]) -> str:
        to = target(found[2])
        return f"[{found[1]}]({to})" if to else found[1]

    text = IMAGE.sub(lambda found: f"{found[1]}{target(found[2])})", text)
    return LINK.sub(link, text)


def assemble(sources: pathlib.Path, command: str) -> None:
    """Copies the pages and writes those that are generated."""
    docs = ROOT / "docs"
    downloads: set[pathlib.Path] = set()
    for path in sorted(docs.rglob("*")):
        place = sources / path.relative_to(docs)
        if (
            path.is_dir()
            or path.name == "requirements.txt"
            or (SITE in path.parents and path.suffix not in (".css", ".js"))
        ):
            continue
        place.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".md":
            place.write_text(relinked(path.read_text(), path.parent, path.parent, downloads))
        else:
            shutil.copyfile(path, place)
    shutil.copyfile(SITE / "conf.py", sources / "conf.py")
    for name, page in ROOT_PAGES.items():
        # pages of docs/ include parts of the README
        place = sources.parent / name if name == "README.md" else sources / page
        place.write_text(relinked((ROOT / name).read_text(), ROOT, docs, downloads))
    for path in downloads:
        place = sources / DOWNLOADS / path
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / path, place)

    if BROWSER_PAGE.is_file():  # browser/build has made it
        (sources / DOWNLOADS).mkdir(exist_ok=True)
        shutil.copyfile(BROWSER_PAGE, sources / DOWNLOADS / BROWSER_PAGE.name)
        link = f"**[Open the page]({DOWNLOADS}/{BROWSER_PAGE.name})**, which is a part of this manual."
        page = sources / "browser.md"
        page.write_text(page.read_text().replace("<!-- the page -->", link))

    reference = sources / "reference"
    (reference / "command.md").write_text(command_reference.command_reference(command))
    (reference / "python.rst").write_text(python_reference.package_page())
    (sources / "formats-table.md").write_text(formats_table.formats_table())
    headers.write_pages(ROOT / "include", reference)


def doxygen(folder: pathlib.Path) -> pathlib.Path:
    """Reads the headers; returns the folder of Doxygen's XML."""
    folder.mkdir(parents=True)
    settings = (SITE / "Doxyfile").read_text() + f"\nOUTPUT_DIRECTORY = {folder}\n"
    run("doxygen", "-", input=settings, text=True)
    headers.tidy(folder / "xml")
    return folder / "xml"


def main() -> None:
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        sys.exit(__doc__)
    site = (pathlib.Path(sys.argv[1]) if len(sys.argv) == 2 else ROOT / "build" / "manual").resolve()
    command = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
    if not os.access(command, os.X_OK):
        fail(f"{command}: no such command; ./run builds it, or MESHORDER names another")
    work = site.with_name(site.name + "-sources")
    for folder in (site, work):
        shutil.rmtree(folder, ignore_errors=True)
    xml = doxygen(work / "doxygen")
    assemble(work / "docs", command)
    version = subprocess.run([command, "--version"], capture_output=True, text=True, check=True).stdout.split()[-1]
    environment = {**os.environ, "MANUAL_VERSION": version, "MANUAL_DOXYGEN": str(xml)}
    sphinx = [sys.executable, "-W", "error:Warning on line", "-m", "sphinx", "-q", "-W", "--keep-going"]
    run(*sphinx, "-d", str(work / "doctrees"), str(work / "docs"), str(site), env=environment)
    faults = links.faults(site)
    if faults:
        fail("\n".join(["links:", *faults]))
    print(f"{site / 'index.html'}: {len(list(site.rglob('*.html')))} pages")


if __name__ == "__main__":
    main()
