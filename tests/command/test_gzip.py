# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files that gzip compressed are read; none are written."""
import gzip

import meshes


def compressed(path):
    packed = path.with_name(path.name + ".gz")
    packed.write_bytes(gzip.compress(path.read_bytes()))
    path.unlink()
    return packed


def test_compressed_files_are_read_with_their_companions(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "plain.vtu", "--vertices", "scrambled")
    files = [compressed(tmp_path / name) for name in ("mesh.node", "mesh.ele")]
    for file in files:
        command.ok("order", file, "-o", "from_gz.vtu", "--vertices", "scrambled")
        assert (tmp_path / "from_gz.vtu").read_bytes() == (tmp_path / "plain.vtu").read_bytes()
    packed = compressed(tmp_path / "plain.vtu")
    assert command.json("info", packed)["format"] == "VTU"


def test_damaged_ones_are_refused(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "a.vtu")
    packed = compressed(tmp_path / "a.vtu")
    whole = packed.read_bytes()
    packed.write_bytes(whole[:-20])
    assert "the gzip file ends within its compressed data" in command.fails("info", packed)
    packed.write_bytes(whole[:40] + b"?" + whole[41:])
    assert "the gzip file is damaged" in command.fails("info", packed)


def test_output_is_not_compressed(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    line = command.fails("order", "mesh.node", "-o", "a.vtu.gz")
    assert line == "meshorder: a.vtu.gz: would not be compressed; write a.vtu, then gzip it"
    assert not list(tmp_path.glob("a.vtu*"))
