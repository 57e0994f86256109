# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Makes the command reference, a page of Markdown, from the command's own help."""

from __future__ import annotations

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import command_pages

INTRODUCTION = """# Command reference

Made from the help of meshorder {version}. `meshorder --help` and `meshorder order --help` print the same, and
`man meshorder-order` shows it where the command is installed. `--json` prints one object with
[documented keys](../json.md).

Exit status: 0 on success, 2 for faulty input or arguments, 1 for a failure of the command itself, 130 and 143 after
Ctrl-C and SIGTERM. Faults are one line on stderr, `meshorder: PLACE: fault; remedy`, and no output file is left behind.
Warnings are lines on stderr that begin with `meshorder: warning: `. `--quiet` prints nothing but faults and the object of
`--json`; subcommands that only list something (`methods`, `models list`, `simulate --list`) still do.
"""


def escaped(text: str) -> str:
    """Help as Markdown: options, `--` and what stands in backquotes are code, the rest must not be read as markup."""
    text = re.sub(r"(?<![`\w-])(--(?:[a-z][a-z-]*)?)(?![^`]*`(?:[^`]*`[^`]*`)*[^`]*$)", r"`\1`", text)
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([\\*_<>\[\]|])", r"\\\1", part) for part in parts)


def head(entry: command_pages.Entry) -> str:
    names = ", ".join(f"`{name}`" for name in entry.names)
    value = f" `{entry.value}`" if entry.value else ""
    facts = [word for word in ("required" if entry.required else "", escaped(entry.relations)) if word]
    return names + value + (f" ({'; '.join(facts)})" if facts else "")


def section(page: command_pages.Page) -> list[str]:
    lines = [f"{'#' * (len(page.words) + 1)} {' '.join(page.words)}", "", escaped(" ".join(page.description)), ""]
    lines += ["```text", page.usage, "```", ""]
    for title, entries in (("Arguments", page.arguments), ("Options", page.options)):
        shown = [entry for entry in entries if entry.names[0] != "-h"]
        if shown:
            lines += [f"{title}:", ""]
        for entry in shown:
            lines += [head(entry), f": {escaped(entry.sentence) or '–'}", ""]
    if page.subcommands:
        rows = [(" ".join([*page.words, entry.names[0]]), escaped(entry.sentence)) for entry in page.subcommands]
        lines += [
            "| subcommand | |",
            "| --- | --- |",
            *(f"| [{name}](#{anchor(name)}) | {text} |" for name, text in rows),
            "",
        ]
    examples = [line for line in page.examples if line.strip()]
    if examples:
        lines += ["Examples:", "", "```text", *(line.strip() for line in examples), "```", ""]
    return lines


def anchor(heading: str) -> str:
    return heading.lower().replace(" ", "-")


def command_reference(command: str) -> str:
    """Returns the page for the command at a path."""
    version = command_pages.run(command, "--version").strip()  # type: ignore[no-untyped-call]
    lines = [INTRODUCTION.format(version=version)]
    for page in command_pages.all_pages(command):  # type: ignore[no-untyped-call]
        lines += section(page)
    return "\n".join(lines) + "\n"
