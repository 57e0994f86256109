# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Prepares what Doxygen found in the headers for Breathe, and writes a page for each header."""

from __future__ import annotations

import pathlib
import re
import xml.etree.ElementTree as ElementTree

#: headers that only include others or hold macros
WITHOUT_PAGE = ("meshorder.hpp", "export.hpp")
#: all but macros
C_SECTIONS = "briefdescription detaileddescription innerclass public-attrib enum typedef func"


def tidy(folder: pathlib.Path) -> None:
    """Changes the XML where Breathe would show it badly."""
    for path in folder.glob("*.xml"):
        if path.name in ("index.xml", "Doxyfile.xml"):
            continue
        text = path.read_text(encoding="utf-8")
        # files have no place to be linked at, and which one to include is the page's title
        text = re.sub(r'<ref refid="\w+_8h(?:pp)?" kindref="compound">([^<]*)</ref>', r"\1", text)
        tree = ElementTree.ElementTree(ElementTree.fromstring(text))
        for compound in tree.iter("compounddef"):
            for includes in compound.findall("includes"):
                compound.remove(includes)
        for member in tree.iter("memberdef"):
            if member.get("kind") == "typedef":
                list_parameters(member)
            name_exceptions(member)
        tree.write(path, encoding="utf-8", xml_declaration=True)


def text_of(element: ElementTree.Element, child: str) -> str:
    found = element.find(child)
    return "" if found is None else "".join(found.itertext()).strip()


def list_parameters(member: ElementTree.Element) -> None:
    """Turns the parameters of a type of functions into a list, since types have no parameters for Sphinx."""
    for paragraph in member.iter("para"):
        for parameters in paragraph.findall("parameterlist[@kind='param']"):
            items = ElementTree.Element("itemizedlist")
            for one in parameters.findall("parameteritem"):
                item = ElementTree.SubElement(ElementTree.SubElement(items, "listitem"), "para")
                name = ElementTree.SubElement(item, "computeroutput")
                name.text = text_of(one, "parameternamelist")
                name.tail = ": " + text_of(one, "parameterdescription")
            paragraph[list(paragraph).index(parameters)] = items


def name_exceptions(member: ElementTree.Element) -> None:
    """Turns "@throws as `order_vertices`", of which Doxygen takes "as" for an exception, into a sentence."""
    description = member.find("detaileddescription")
    for paragraph in [] if description is None else list(description.iter("para")):
        for exceptions in paragraph.findall("parameterlist[@kind='exception']"):
            for item in exceptions.findall("parameteritem"):
                said = item.find("parameterdescription/para")
                if description is not None and said is not None and text_of(item, "parameternamelist") == "as":
                    said.text = "Throws as " + (said.text or "")
                    exceptions.remove(item)
                    description.append(said)
            if len(exceptions) == 0:
                paragraph.remove(exceptions)


def write_pages(include: pathlib.Path, folder: pathlib.Path) -> None:
    """Writes cpp/NAME.rst for each public header of C++, and c.rst, into a folder."""

    def write(path: pathlib.Path, title: str, directive: str) -> None:
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"{title}\n{'=' * len(title)}\n\n{directive}\n", encoding="utf-8")

    for header in sorted((include / "meshorder").glob("*.hpp")):
        if header.name not in WITHOUT_PAGE:
            write(folder / "cpp" / f"{header.stem}.rst", header.name, f".. doxygenfile:: {header.name}")
    files = [f".. doxygenfile:: {name}\n   :sections: {C_SECTIONS}" for name in ("meshorder.h", "meshorder_mpi.h")]
    write(folder / "c.rst", "C reference", "\n\n".join(files))
