# SPDX-License-Identifier: GPL-3.0-or-later
"""The package as it is installed: type hints, stubs, the wheel, and the notebook."""

import ast
import importlib.util
import inspect
import json
import pathlib
import re
import subprocess
import sys
import textwrap
import types
import typing

import pytest

import chaintrue
from chaintrue import _core
from conftest import ROOT

PACKAGE = pathlib.Path(chaintrue.__file__).parent
SCRIPTS = ROOT / "tools" / "python" / "scripts"


def script(name):
    specification = importlib.util.spec_from_file_location(name, SCRIPTS / f"{name}.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def public_functions():
    things = [getattr(chaintrue, name) for name in chaintrue.__all__]
    things += [chaintrue.gcode.compensate, chaintrue.gcode.verify]
    for thing in things:
        if inspect.isfunction(thing):
            yield thing.__name__, thing
        if not inspect.isclass(thing):
            continue
        for name, member in inspect.getmembers(thing):
            function = member.fget if isinstance(member, property) else member
            if inspect.isfunction(function) and (name[0] != "_" or name == "__init__"):
                yield f"{thing.__name__}.{name}", function


@pytest.mark.parametrize("name, function", public_functions())
def test_types_are_written_down(name, function):
    hints = typing.get_type_hints(function)
    given = [parameter for parameter in inspect.signature(function).parameters if parameter != "self"]
    missing = [parameter for parameter in given if parameter not in hints]
    assert not missing
    if not name.endswith("__init__") and function.__qualname__.find("__create_fn__") < 0:
        assert "return" in hints
        assert name.startswith("Record") or inspect.getdoc(function)


def test_the_stub_is_the_compiled_module():
    assert (PACKAGE / "py.typed").exists()
    stub = ast.parse((PACKAGE / "_core.pyi").read_text())
    declared = {}
    for node in stub.body:
        if isinstance(node, ast.ClassDef):
            members = {getattr(one, "name", None) or one.target.id for one in node.body}
            declared[node.name] = members - {"__init__"}
        elif isinstance(node, ast.FunctionDef):
            declared[node.name] = set()
        elif isinstance(node, ast.AnnAssign):
            declared[node.target.id] = set()
    found = {
        name: {member for member in vars(value) if member[0] != "_"}
        if inspect.isclass(value)
        else set()
        for name, value in vars(_core).items()
        if name == "__version__" or name[0] != "_"
    }
    assert declared == found
    for node in (one for one in stub.body if isinstance(one, ast.FunctionDef)):
        arguments = re.search(r"\((.*)\) ->", getattr(_core, node.name).__doc__)[1]
        assert len(node.args.args) == len(re.findall(r"arg\d+: ", arguments)), node.name


def test_the_documents_do_not_shadow_a_builtin():
    shown = chaintrue.__doc__ + (ROOT / "docs" / "python.md").read_text()
    assert not re.findall(r"\b(?:map|list|dict|type|input|set) = ", shown)


def blocks(document):
    """The indented blocks of a document that are Python."""
    for block in re.findall(r"(?:^(?:    .*)?\n)+", document, re.MULTILINE):
        if block.strip() and "tools/" not in block:
            yield textwrap.dedent(block)


def test_the_documents_code_runs(tmp_path, monkeypatch):
    (tmp_path / "fixtures").symlink_to(ROOT / "fixtures")
    monkeypatch.chdir(tmp_path)
    pandas = types.ModuleType("pandas")
    pandas.DataFrame = dict
    monkeypatch.setitem(sys.modules, "pandas", pandas)
    names = {}
    found = list(blocks((ROOT / "docs" / "python.md").read_text()))
    assert len(found) >= 4
    for block in found:
        exec(block, names)
    exec(next(blocks(chaintrue.__doc__)), names)
    assert (tmp_path / "diagnosis.html").exists() and (tmp_path / "part.true.nc").exists()


def test_the_wheel_is_whole_and_can_be_imported(tmp_path):
    wheel = script("make_wheel").make(PACKAGE, tmp_path)
    assert re.fullmatch(r"chaintrue-\d+\.\d+\.\d+-cp3\d+-cp3\d+-linux_\w+\.whl", wheel.name)
    unpack = [sys.executable, "-m", "wheel", "unpack", wheel, "--dest", tmp_path]
    subprocess.run(unpack, check=True)  # compares the digest of every file
    (site,) = (path for path in tmp_path.iterdir() if path.is_dir())
    names = [{path.name for path in there.iterdir() if path.is_file()} for there in (PACKAGE, site / "chaintrue")]
    assert names[0] == names[1]
    (metadata,) = (path.read_text() for path in site.glob("*/METADATA"))
    assert "Requires-Dist: numpy" in metadata and "Requires-External: libtbb" in metadata
    code = "import chaintrue; print(chaintrue.__file__, chaintrue.Machine.from_dict)"
    there = f"import sys; sys.path.insert(0, {str(site)!r}); "
    shown = subprocess.run(
        [sys.executable, "-I", "-c", there + code], check=True, capture_output=True, text=True
    )
    assert shown.stdout.startswith(str(site))
    first = wheel.read_bytes()
    assert script("make_wheel").make(PACKAGE, tmp_path).read_bytes() == first


def test_the_notebook_goes_from_readings_to_a_verdict(capsys, monkeypatch):
    monkeypatch.setattr(chaintrue.Map, "plot", lambda self: None)  # drawn in test_views
    monkeypatch.setattr(chaintrue.Diagnosis, "plot", lambda self: None)
    runner = script("run_notebook")
    path = ROOT / "docs" / "readings_to_verdict.ipynb"
    names = runner.run(path)
    assert names["found"].verdict == "named"
    assert (names["found"].causes[0].effect, names["found"].causes[0].side) == (
        "chain_pitch_error",
        "left",
    )
    assert names["square"].strays_mm < 0.05  # the tolerance that it was made with
    assert names["found"].sentence in capsys.readouterr().out
    stored = json.loads(path.read_text())["cells"]
    assert all(not cell["outputs"] for cell in stored if cell["cell_type"] == "code")


def test_a_cell_that_fails_is_named(tmp_path):
    path = tmp_path / "broken.ipynb"
    path.write_text('{"cells": [{"cell_type": "code", "source": ["1 / 0"]}]}')
    with pytest.raises(ZeroDivisionError) as told:
        script("run_notebook").run(path)
    assert "cell 1" in str(told.traceback[-1])
