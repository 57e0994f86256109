# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""JSON against its schema."""
import json

import jsonschema


def read_schema(path):
    schema = json.loads(path.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return schema


def faults(value, schema):
    """The violations of the schema by a value, a line each."""
    return [f"{error.json_path}: {error.message}" for error in jsonschema.Draft202012Validator(schema).iter_errors(value)]
