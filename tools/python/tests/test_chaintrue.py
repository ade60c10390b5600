# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module against files, arrays and itself."""

import inspect
import json
import warnings

import numpy
import pytest

import chaintrue
from conftest import FIXTURES

GRID = FIXTURES / "grids" / "seven_by_four.json"


def test_a_grid_is_what_its_file_says(grid):
    points = json.loads(GRID.read_text())["points"]
    assert len(grid) == len(points)
    assert grid.marks.shape == grid.lengths.shape == (len(points), 2)
    assert grid.marks.dtype == numpy.float64
    assert grid.commanded is None
    assert grid.marks[3].tolist() == [points[3]["x_mm"], points[3]["y_mm"]]
    assert grid.lengths[3].tolist() == [points[3]["left_mm"], points[3]["right_mm"]]


def test_a_grid_of_arrays_is_the_file(grid):
    noise = grid.to_dict()["noise"]
    again = chaintrue.Grid(
        grid.marks,
        grid.lengths,
        order=grid.order,
        machine=grid.machine,
        length_noise_mm=noise["length_mm"],
        position_noise_mm=noise["position_mm"],
        noise_dof=noise["dof"],
        name=grid.name,
    )
    assert again == grid


def test_a_query_gives_the_numbers_of_docs_cut(calibration):
    answer = chaintrue.query(calibration, [100.0, 200.0])
    assert [f"{length:.6f}" for length in answer.lengths] == ["1678.789218", "1510.239393"]


@pytest.mark.parametrize(
    "points", [1.0, [1.0, 2.0, 3.0], [[1.0, 2.0, 3.0]], [[numpy.nan, 0.0]], [[numpy.inf, 0.0]]]
)
def test_other_shapes_and_numbers_that_are_none_are_refused(calibration, points):
    with pytest.raises(ValueError, match=r"shape|none, or infinite"):
        chaintrue.query(calibration, points)


def test_files_and_objects_are_the_same(tmp_path, calibration, diagnosis):
    for thing, read in ((calibration, chaintrue.read_map), (diagnosis, chaintrue.read_diagnosis)):
        path = tmp_path / "file.json"
        thing.write(path)
        assert read(path).to_dict() == thing.to_dict()


def test_a_map_is_built_on_the_causes_that_are_found(grid, calibration):
    assert len(calibration.notes) > len(chaintrue.fit(grid, plain=True).notes)
    with pytest.raises(ValueError):
        chaintrue.fit(grid, plain=True, accept_class=True)
    with pytest.raises(ValueError):
        chaintrue.fit(grid, surface="direct", plain=True)


def test_pages_are_the_commands(tmp_path, calibration, diagnosis):
    page = chaintrue.report(calibration, tmp_path / "map.html")
    assert (tmp_path / "map.html").read_text() == page
    assert page.startswith("<!DOCTYPE html>")
    assert "Certificate" in chaintrue.report(calibration, certificate=True)
    assert "Diagnosis" in chaintrue.report(diagnosis)
    with pytest.raises(ValueError):
        chaintrue.report(diagnosis, certificate=True)


def test_bad_input_is_told_whole():
    with pytest.raises(chaintrue.InputError, match="/points/0/x_mm") as told:
        chaintrue.read_grid(FIXTURES / "bad" / "grid_bad_values.json")
    assert "/points/1/left_mm" in str(told.value)


def test_what_was_assumed_is_a_warning():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        chaintrue.read_machine(FIXTURES / "good" / "machine_fewest_keys.json")
    assert any("assumed" in str(warning.message) for warning in told)


def test_everything_is_explained():
    for name in chaintrue.__all__:
        assert inspect.getdoc(getattr(chaintrue, name)), name
