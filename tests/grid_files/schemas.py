#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The schemas that `chaintrue formats --all` writes, by a validator that is not ours: every good fixture is valid, and bad
ones are refused where a schema can tell (how points and machine fit together it cannot).

Usage: schemas.py COMMAND ROOT. Exits 77 where Debian's python3-jsonschema is missing.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import warnings

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)
warnings.simplefilter("ignore", DeprecationWarning)

ROOT = pathlib.Path(sys.argv[2])
FOLDER = tempfile.TemporaryDirectory()
FORMATS = pathlib.Path(FOLDER.name)
subprocess.run([sys.argv[1], "formats", "--all", FORMATS], stdout=subprocess.DEVNULL, check=True)
# Files with mistakes of one key, one type, one choice or one range each.
BAD = """diagnosis_slips drawing_slips plotter_pins_too_near grid_bad_values grid_machine_and_machine_file grid_machine_inside_is_bad
grid_misspelt_columns grid_neither_nor_both grid_orders grid_points_missing grid_points_not_a_list
grid_readings grid_sheet_and_noise grid_unknown_key holes_unknown_keys machine_absurd_mass
machine_absurd_values machine_decimal_comma_in_text machine_effect_without_name
machine_future_version machine_inches machine_missing_fields machine_misspelt_key
machine_mixed_attachment machine_unknown_attachment machine_unknown_controller
machine_unknown_controller_setting machine_unknown_key machine_wrong_file_type
machine_wrong_types""".split()

schemas = {}
for path in sorted(FORMATS.glob("*.schema.json")):
    schema = json.loads(path.read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    schemas[path.as_uri()] = schema


def slips(path):
    document = json.loads(path.read_text())
    kind = document["file_type"].removeprefix("chaintrue_")
    uri = (FORMATS / f"{kind}.schema.json").as_uri()
    resolver = jsonschema.RefResolver(uri, schemas[uri], store=schemas)
    validator = jsonschema.Draft7Validator(schemas[uri], resolver=resolver)
    return [f"{'/'.join(map(str, e.absolute_path))}: {e.message}" for e in validator.iter_errors(document)]


failures = 0
good = [p for room in ("good", "grids", "holes", "machines", "sweeps", "effects", "effects/catalogue") for p in sorted((ROOT / "fixtures" / room).glob("*.json"))]
for path in good:
    for slip in slips(path):
        print(f"{path.name} is good, but: {slip[:200]}")
        failures += 1
for name in BAD:
    if not slips(ROOT / "fixtures" / "bad" / f"{name}.json"):
        print(f"{name}.json is bad, and the schema does not say so")
        failures += 1
print(f"{len(schemas)} schemas, {len(good)} good files, {len(BAD)} bad ones, {failures} wrong")
sys.exit(1 if failures or len(schemas) != 11 or len(good) < 20 else 0)
