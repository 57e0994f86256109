#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Writes manual pages and completions of the command, from its own --help.

  command_pages.py COMMAND FOLDER

writes FOLDER/man1/*.1.gz and FOLDER/completions/{meshorder,_meshorder,meshorder.fish} for bash, zsh and fish.
"""
import dataclasses
import gzip
import json
import pathlib
import re
import subprocess
import sys

SUMMARY_END = re.compile(r"[:.;] ?|$")


@dataclasses.dataclass
class Entry:
    """An option, an argument or a subcommand: its names, its value as the help writes it ("INT=0"), whether it is
    required, what it excludes or needs, and its description."""
    names: list
    value: str = ""
    required: bool = False
    relations: str = ""
    text: list = dataclasses.field(default_factory=list)

    @property
    def sentence(self):
        return " ".join(self.text)

    @property
    def placeholder(self):
        return re.split(r"[= ]", self.value)[0].rstrip(",")


@dataclasses.dataclass
class Page:
    """The help of a subcommand."""
    words: list
    description: list = dataclasses.field(default_factory=list)
    usage: str = ""
    examples: list = dataclasses.field(default_factory=list)
    arguments: list = dataclasses.field(default_factory=list)
    options: list = dataclasses.field(default_factory=list)
    subcommands: list = dataclasses.field(default_factory=list)

    @property
    def name(self):
        return "-".join(self.words)


def parse_entry(head):
    """Makes an Entry of '-o,--output TEXT REQUIRED' or 'make'."""
    names, value, required, relations = re.fullmatch(
        r"(\S+) ?(.*?) ?(REQUIRED)? ?((?:(?:Excludes|Needs): .*)?)", head).groups()
    return Entry(names.split(","), value, bool(required), relations)


def parse_help(words, text):
    page = Page(words)
    section = page.description
    for line in text.splitlines():
        heading = re.fullmatch(r"(\w+):", line)
        if line.startswith("Usage: "):
            page.usage = line.removeprefix("Usage: ")
            section = None
        elif heading and page.usage:
            section = {"Positionals": page.arguments, "Options": page.options, "Subcommands": page.subcommands,
                       "Example": page.examples, "Examples": page.examples}[heading[1]]
        elif section is page.description:
            (page.examples if line.startswith("  ") else page.description).append(line)
        elif section is page.examples:
            page.examples.append(line)
        elif line.startswith("   "):
            section[-1].text.append(line.strip())
        elif line.startswith("  "):
            head, _, rest = line.strip().partition("  ")
            section.append(parse_entry(head))
            if rest:
                section[-1].text.append(rest.strip())
        elif line:
            raise ValueError(f"{' '.join(words)} --help: a line is not understood: {line}")
    page.description = [line for line in page.description if line]
    return page


def run(command, *arguments):
    return subprocess.run([command, *arguments], capture_output=True, text=True, check=True, encoding="utf-8").stdout


def all_pages(command, words=()):
    """Reads the help of the command and of all its subcommands."""
    page = parse_help(["meshorder", *words], run(command, *words, "--help"))
    pages = [page]
    for subcommand in page.subcommands:
        pages += all_pages(command, (*words, subcommand.names[0]))
    return pages


# ---- manual pages


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    text = re.sub(r"`([^`]*)`", r"\\fB\1\\fR", text)
    return "\\&" + text if text.startswith((".", "'")) else text


def bold(text):
    return f"\\fB{roff(text)}\\fR"


def italic(text):
    return f"\\fI{roff(text)}\\fR"


def summary_of(page):
    sentence = " ".join(page.description)
    sentence = sentence[:SUMMARY_END.search(sentence).start()]
    return sentence[:1].lower() + sentence[1:]


def manual(page, pages, version):
    lines = [f'.TH {page.name.upper()} 1 "" "meshorder {version}" "User Commands"', ".SH NAME",
             f"{roff(page.name)} \\- {roff(summary_of(page))}", ".SH SYNOPSIS"]
    head = " ".join(page.words)
    lines.append(f"{bold(head)} {italic(page.usage.removeprefix(head).strip())}")
    lines += [".SH DESCRIPTION", *map(roff, page.description)]
    for title, entries in (("ARGUMENTS", page.arguments), ("OPTIONS", page.options)):
        if entries:
            lines.append(f".SH {title}")
        for entry in entries:
            names = ", ".join(bold(name) if name.startswith("-") else italic(name) for name in entry.names)
            value = f" {italic(entry.value)}" if entry.value else ""
            lines += [".TP", names + value + (" (required)" if entry.required else ""), *map(roff, entry.text)]
            if entry.relations:
                lines.append(f"({roff(entry.relations)})")
    if page.subcommands:
        lines.append(".SH SUBCOMMANDS")
        for entry in page.subcommands:
            lines += [".TP", f"{bold('-'.join([*page.words, entry.names[0]]))}(1)", *map(roff, entry.text)]
    if any(line.strip() for line in page.examples):
        lines += [".SH EXAMPLES", ".nf", *(roff(line) for line in page.examples if line.strip()), ".fi"]
    lines += [".SH EXIT STATUS", "0 on success, 2 for faulty input or arguments, 1 for a failure of the command itself."]
    others = [bold(other.name) + "(1)" for other in pages if other is not page]
    lines += [".SH SEE ALSO", ",\n".join(others)]
    return "\n".join(lines) + "\n"


# ---- completions


def choices(command):
    """Returns the words that an option or argument takes, where the command lists them: {(option, page): words}."""
    methods = json.loads(run(command, "methods", "--json"))
    scenarios = json.loads(run(command, "simulate", "--list", "--json"))["scenarios"]
    # models with a size in their names are only in this user's cache
    names = [model["name"] for model in json.loads(run(command, "models", "list", "--json"))["models"]]
    vertices = [method["name"] for method in methods["vertices"]]
    elements = [method["name"] for method in methods["elements"]]
    machines = [machine["name"] for machine in json.loads(run(command, "calibrate", "--list", "--json"))["machines"]]
    return {"--machine": machines, "--vertices": vertices, "--cells": vertices, "--elements": elements, "--order": vertices, "--orders": vertices,
            "--methods": vertices, "SCENARIO": [scenario["name"] for scenario in scenarios],
            "NAME": [name for name in names if not re.search(r"-\d+$", name)] + ["all"]}


def words_for(entry, known):
    """Returns the words that an option or argument may take; empty for a file or a number."""
    listed = re.search(r"(?:^| )((?:[a-z][a-z-]*, )+[a-z][a-z-]*)$", entry.sentence)
    if listed and entry.value and "," in listed[1]:
        return listed[1].split(", ")
    for name in entry.names:
        if name in known and entry.value:
            return known[name]
    return []


def takes_list(entry):
    """Returns whether an option takes several words, separated by commas."""
    return "separated by commas" in entry.sentence


def takes_file(entry):
    return entry.placeholder in ("TEXT", "NAME", "MESH…")


def bash(pages, known):
    cases = []
    for page in pages:
        options = [name for entry in page.options for name in entry.names]
        words = [entry.names[0] for entry in page.subcommands]
        words += [word for entry in page.arguments for word in words_for(entry, known)]
        cases.append(f"      '{' '.join(page.words)}') options='{' '.join(options)}' words='{' '.join(words)}' ;;")
    values = []
    for page in pages:
        for entry in page.options:
            listed = words_for(entry, known)
            if entry.value:
                names = " | ".join(f"'{' '.join(page.words)} {name}'" for name in entry.names)
                values.append(f"    {names}) words='{' '.join(listed)}'{' comma=,' if takes_list(entry) else ''} ;;")
    nested = " | ".join(f"'{' '.join(page.words)}'" for page in pages if len(page.words) > 1)
    return f"""# bash completion of meshorder, made from its --help
_meshorder() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} at='meshorder' options='' words='' comma='' i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$at ${{COMP_WORDS[i]}}" in {nested})
      at+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case "$at $previous" in
{chr(10).join(values)}
    *)
      case $at in
{chr(10).join(cases)}
      esac
      [[ $current != -* ]] || words=$options ;;
  esac
  # the last word of a list
  local before=''
  [[ -z $comma || $current != *,* ]] || before=${{current%,*}},
  # files, if none of these fits
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$words" -- "${{current#"$before"}}")
}}
complete -o default -F _meshorder meshorder
"""


def zsh_text(text):
    return re.sub(r"([\[\]:\\])", r"\\\1", text).replace("'", "'\\''")


def zsh(pages, known):
    def action(entry):
        listed = " ".join(words_for(entry, known))
        if listed and takes_list(entry):
            return f"_values -s , {zsh_text(entry.placeholder)} {listed}"
        return f"({listed})" if listed else "_files" if takes_file(entry) else " "

    def option(entry):
        spec = f"[{zsh_text(entry.sentence)}]"
        if entry.value:
            spec += f":{zsh_text(entry.placeholder)}:{action(entry)}"
        if len(entry.names) == 1:
            return f"'{entry.names[0]}{spec}'"
        return f"'({' '.join(entry.names)})'{{{','.join(entry.names)}}}'{spec}'"

    functions = []
    for page in pages:
        lines = [option(entry) for entry in page.options]
        body = ""
        if page.subcommands:
            lines += ["'1: :->subcommand'", "'*:: :->arguments'"]
            listed = " ".join(f"'{zsh_text(e.names[0])}:{zsh_text(e.sentence)}'" for e in page.subcommands)
            body = f"""
  case $state in
    subcommand)
      local -a subcommands=({listed})
      _describe subcommand subcommands ;;
    arguments) (( $+functions[_{page.name}-$words[1]] )) && _{page.name}-$words[1] ;;
  esac"""
        for entry in page.arguments:
            many = "..." in entry.value or len(page.arguments) == 1
            lines.append(f"'{'*' if many else ''}:{zsh_text(entry.names[0])}:{action(entry)}'")
        local = "  local context state state_descr line\n  typeset -A opt_args\n" if page.subcommands else ""
        arguments = " \\\n    ".join(lines)
        functions.append(f"_{page.name}() {{\n{local}  _arguments {'-C ' if page.subcommands else ''}\\\n    "
                         f"{arguments}{body}\n}}")
    return "#compdef meshorder\n# zsh completion, made from the command's --help\n" + "\n".join(functions) + \
        '\n_meshorder "$@"\n'


def fish(pages, known):
    def quoted(text):
        return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"

    lines = ["# fish completion of meshorder, made from its --help"]
    for page in pages:
        where = " && ".join(f"__fish_seen_subcommand_from {word}" for word in page.words[1:])
        if page.subcommands:
            names = " ".join(entry.names[0] for entry in page.subcommands)
            nothing_yet = f"not __fish_seen_subcommand_from {names}"
            within = " && ".join(filter(None, [where, nothing_yet]))
            for entry in page.subcommands:
                lines.append(f"complete -c meshorder -n {quoted(within)} -f -a {entry.names[0]} "
                             f"-d {quoted(entry.sentence)}")
            where = within
        for entry in page.options:
            line = f"complete -c meshorder -n {quoted(where)}"
            for name in entry.names:
                line += f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}"
            if entry.value:
                listed = words_for(entry, known)
                words = f"(__fish_append , {' '.join(listed)})" if takes_list(entry) else " ".join(listed)
                line += f" -x -a {quoted(words)}" if listed else " -r"
            lines.append(f"{line} -d {quoted(entry.sentence)}")
        for entry in page.arguments:
            listed = words_for(entry, known)
            if listed:
                lines.append(f"complete -c meshorder -n {quoted(where)} -a {quoted(' '.join(listed))}")
    return "\n".join(lines) + "\n"


def main():
    command, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    pages = all_pages(command)
    known = choices(command)
    version = run(command, "--version").strip()
    for name in ("man1", "completions"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    for page in pages:
        text = manual(page, pages, version).encode()
        (folder / "man1" / f"{page.name}.1.gz").write_bytes(gzip.compress(text, 9, mtime=0))
    for name, make in (("meshorder", bash), ("_meshorder", zsh), ("meshorder.fish", fish)):
        (folder / "completions" / name).write_text(make(pages, known), encoding="utf-8")


if __name__ == "__main__":
    main()
