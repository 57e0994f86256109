# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""docs/results.schema.json against what the command writes and reads."""
import copy
import json

import pytest

import conftest
import schemas

# keys that earlier versions did not write; they may be missing
ADDED = {"revision", "precision", "gain", "other_seconds", "pace_seconds"}
ADDED_SECONDS = {"triangulation", "order", "motion"}
SCHEMA = schemas.read_schema(conftest.ROOT / "docs" / "results.schema.json")


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The folder of a study of one small scenario."""
    command = conftest.Command(tmp_path_factory.mktemp("study"))
    command.ok("reproduce", "--quick", "--scenario", "bounce", "--mesh", "grid-4", "--budget", "0.1", "-o", "study")
    return command.folder / "study"


def objects_of(schema):
    """Every part of a schema that describes an object."""
    for value in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        yield from objects_of(value)
    if isinstance(schema, dict) and schema.get("type") == "object":
        yield schema


def test_every_key_is_described():
    described = list(objects_of(SCHEMA))
    assert len(described) > 10
    for part in described:
        added = ADDED | (ADDED_SECONDS if "triangulation" in part["properties"] else set())
        assert part["additionalProperties"] is False and set(part["required"]) == set(part["properties"]) - added
        for key, value in part["properties"].items():
            target = SCHEMA["$defs"][value["$ref"].removeprefix("#/$defs/")] if "$ref" in value else {}
            assert value.get("description") or target.get("description"), key


def test_schema_takes_what_the_command_writes(study):
    results = json.loads((study / "results.json").read_text())
    assert schemas.faults(results, SCHEMA) == []
    assert results["scenarios"][0]["orders"][0]["runs"] and results["meshes"][0]["orders"]


def test_schema_and_command_take_what_earlier_versions_wrote(study, command):
    results = json.loads((study / "results.json").read_text())
    assert results["machine"].pop("revision") is not None
    assert results["scenarios"][0].pop("precision") == "double"
    for order in results["scenarios"][0]["orders"]:
        for run in order["runs"]:
            run["seconds"] = {key: value for key, value in run["seconds"].items() if key not in ADDED_SECONDS}
    assert schemas.faults(results, SCHEMA) == []
    (command.folder / "results.json").write_text(json.dumps(results))
    command.ok("report", ".")


@pytest.mark.parametrize("break_it", [
    lambda study: study.pop("reference"),
    lambda study: study.update(colour="red"),
    lambda study: study.update(version=2),
    lambda study: study.update(threads=0),
    lambda study: study["machine"].update(cores=-1),
    lambda study: study["machine"].update(processor=""),
    lambda study: study["machine"].update(cache_bytes=[100]),
    lambda study: study["meshes"][0].update(vertices=1.5),
    lambda study: study["meshes"][0]["orders"][0]["kernels"].pop("spmv"),
    lambda study: study["scenarios"][0].update(turn=0),
    lambda study: study["scenarios"][0].update(precision="half"),
    lambda study: study["scenarios"][0].update(interleaved=1),
    lambda study: study["scenarios"][0]["orders"][0]["runs"][0]["step_seconds"].__setitem__(0, None),
    lambda study: study["scenarios"][0]["orders"][0]["speedup"].update(break_even_step=0),
    lambda study: study["scenarios"][0]["orders"][0]["motion"].update(largest=-1e-9),
])
def test_schema_and_command_refuse_the_same(study, command, break_it):
    results = json.loads((study / "results.json").read_text())
    broken = copy.deepcopy(results)
    break_it(broken)
    assert schemas.faults(broken, SCHEMA)
    (command.folder / "results.json").write_text(json.dumps(broken))
    assert "results.json: " in command.fails("report", ".")
