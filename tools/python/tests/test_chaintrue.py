# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module against files, arrays and itself."""

import doctest
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


def test_a_grid_of_arrays_gives_the_same_map(grid, calibration):
    noise = grid.to_dict().get("noise", {})
    again = chaintrue.Grid(
        grid.marks,
        grid.lengths,
        order=grid.order,
        machine=grid.machine,
        length_noise_mm=noise.get("length_mm"),
        position_noise_mm=noise.get("position_mm"),
        noise_dof=noise.get("dof", 15.0),
        name=grid.name,
    )
    assert chaintrue.fit(again).to_dict()["points"] == calibration.to_dict()["points"]


def test_a_query_has_shapes_and_an_inverse(calibration):
    points = numpy.array([[100.0, 200.0], [-1000.0, -450.0], [0.0, 0.0]])
    answer = chaintrue.query(calibration, points)
    assert answer.lengths.shape == answer.sigma.shape == (3, 2)
    assert answer.tool_sigma.shape == answer.status.shape == (3,)
    # The numbers of docs/cut.md, to the last digit.
    assert [f"{length:.6f}" for length in answer.lengths[0]] == ["1678.789218", "1510.239393"]
    assert answer.status[0] == "inside"
    # Newton's steps end at 1e-9 mm; on the bed the tool moves at most ten times as far as the
    # chains.
    assert numpy.abs(chaintrue.inverse(calibration, answer.lengths) - points).max() < 1e-8


def test_outside_is_masked_and_no_number(calibration):
    answer = chaintrue.query(calibration, [[0.0, 0.0], [0.0, 20000.0]])
    assert answer.lengths.mask.tolist() == [[False, False], [True, True]]
    assert answer.status[1] == "outside"
    assert numpy.isfinite(answer.lengths.data).all()
    assert chaintrue.inverse(calibration, [[10.0, 10.0]]).mask.all()


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


def test_a_diagnosis_answers(diagnosis):
    assert diagnosis.verdict == diagnosis.to_dict()["verdict"]
    assert diagnosis.sentence
    assert isinstance(diagnosis.causes, list)


def test_holes_are_fitted_too():
    fitted = chaintrue.fit(chaintrue.read_holes(FIXTURES / "holes" / "nine_holes.json"))
    assert chaintrue.query(fitted, [[0.0, 0.0]]).lengths.shape == (1, 2)


def test_a_map_is_built_on_the_causes_that_are_found():
    grid = chaintrue.read_grid(FIXTURES / "grids" / "seven_by_four.json")
    plain, own = chaintrue.fit(grid, plain=True), chaintrue.fit(grid)
    assert len(own.notes) > len(plain.notes)
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
    with pytest.raises(chaintrue.InputError):
        chaintrue.Grid([[0.0, 0.0]] * 9, [[1.0, 1.0]] * 9)


def test_what_cannot_be_done_is_a_sentence(grid):
    without = chaintrue.Grid(grid.marks, grid.lengths)
    with pytest.raises(chaintrue.Failure, match="machine"):
        chaintrue.fit(without)


def test_what_was_assumed_is_a_warning():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        chaintrue.read_machine(FIXTURES / "good" / "machine_fewest_keys.json")
    assert any("assumed" in str(warning.message) for warning in told)


def test_everything_is_explained():
    for name in chaintrue.__all__:
        assert inspect.getdoc(getattr(chaintrue, name)), name
    assert doctest.DocTestParser().get_examples(chaintrue.__doc__) == []
