#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Puts the page together: one HTML file, with the module, the worker, the viewer and three.js inside.

    browser/make_page.py MODULE PAGE        MODULE.wasm and MODULE.js are what emscripten made
"""

import base64
import pathlib
import re
import sys
import zlib

BROWSER = pathlib.Path(__file__).resolve().parent
ROOT = BROWSER.parent
VIEWER = ROOT / "viewer"
VIEWER_SCRIPTS = ["blobs", "choices", "stage", "orbit", "bands", "orders", "results", "mesh_view"]
THREE_FOLDER = pathlib.Path("/usr/share/javascript/three")


def read(*paths: pathlib.Path) -> str:
    return "\n".join(path.read_text(encoding="utf-8") for path in paths)


def three() -> pathlib.Path:
    for path in (THREE_FOLDER / "three.min.js", THREE_FOLDER / "build" / "three.min.js"):
        if path.is_file():
            return path
    sys.exit("browser/make_page.py: three.js is missing, which draws the meshes: apt-get install libjs-three")


def version() -> str:
    found = re.search(r"project\(meshorder VERSION (\S+)", read(ROOT / "CMakeLists.txt"))
    return found[1] if found else ""


def page(module: pathlib.Path) -> str:
    wasm = zlib.compress(module.with_suffix(".wasm").read_bytes(), 9)
    parts = {
        "version": version(),
        "style": read(VIEWER / "style.css", BROWSER / "page.css"),
        "scripts": read(*(VIEWER / f"{name}.js" for name in VIEWER_SCRIPTS), BROWSER / "ball.js", BROWSER / "page.js"),
        "three": read(VIEWER / "three_licence.txt", three()),
        "worker": read(module.with_suffix(".js"), BROWSER / "module.js", BROWSER / "worker.js"),
        "wasm": base64.b64encode(wasm).decode("ascii"),
    }
    for name, text in parts.items():
        if "</script" in text:
            sys.exit(f"browser/make_page.py: '{name}' ends its element early: it contains '</script'")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], read(BROWSER / "page.html"))


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    target = pathlib.Path(sys.argv[2])
    target.write_text(page(pathlib.Path(sys.argv[1])), encoding="utf-8")
    print(f"{target}: {target.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
