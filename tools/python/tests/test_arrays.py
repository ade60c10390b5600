# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids, holes and belts from arrays are what their files are, and held to the same."""

import numpy
import pytest

import chaintrue

SQUARE = [(-900.0, -400.0), (900.0, -400.0), (900.0, 400.0), (-900.0, 400.0)]
DIAGONAL = numpy.hypot(1800.0, 800.0)
TAPED = [*((i, (i + 1) % 4, (1800.0, 800.0)[i % 2]) for i in range(4)), (0, 2, DIAGONAL), (1, 3, DIAGONAL)]


def test_holes_of_arrays_are_the_file(holes):
    contents = holes.to_dict()
    again = chaintrue.Holes(
        holes.commanded,
        [(one["from"], one["to"], one["distance_mm"]) for one in contents["distances"]],
        names=[hole["name"] for hole in contents["holes"]],
        machine=holes.machine,
        name=holes.name,
    )
    assert again == holes
    assert len(again) == 9


def test_holes_are_counted_where_they_have_no_names(machine):
    taped = [*TAPED, (0, 1, 1800.2, 0.4), (0, "left", 319.2)]
    holes = chaintrue.Holes(SQUARE, taped, machine=machine, sheet={"width_mm": 2438.4})
    *_, again, edge = holes.to_dict()["distances"]
    assert (again["from"], again["sigma_mm"], edge["to"]) == ("0", 0.4, "left")


def test_belts_of_arrays_are_the_file(belts):
    points = belts.to_dict()["points"]
    again = chaintrue.Belts(
        belts.lengths,
        commanded=[(point["commanded_x_mm"], point["commanded_y_mm"]) for point in points],
        order=[point["order"] for point in points],
        machine=belts,
        name=belts.name,
    )
    assert again.to_dict()["machine"] == belts.to_dict()["machine"]
    for one, other in zip(points, again.to_dict()["points"]):
        assert other.items() <= one.items() and len(other) == 7  # four lengths, the place, the order


def test_anchors_of_belts_are_an_array(belts):
    at = numpy.array(
        [list(anchor.values()) for anchor in belts.to_dict()["machine"]["anchors"].values()]
    )
    assert at.shape == (4, 3)
    taped = chaintrue.Belts(
        belts.lengths, anchors=at, distances=[("bl", "br", 2953.0), (0, 5, 149.0, 2.0)]
    )
    contents = taped.to_dict()
    assert contents["machine"]["anchors"]["tr"]["x_mm"] == at[1, 0]
    assert [one["from"] for one in contents["distances"]] == ["bl", 0]
    with pytest.raises(ValueError, match="4 belts, but 3 anchors"):
        chaintrue.Belts(belts.lengths, anchors=at[:3])


def test_anchors_are_fitted_to_belts_and_holes(belts):
    holes = chaintrue.Holes(SQUARE, TAPED, machine=belts)
    assert isinstance(chaintrue.fit([belts, holes]), chaintrue.Anchors)
    with pytest.raises(ValueError, match="four belts"):
        chaintrue.diagnose(holes)


@pytest.mark.parametrize(
    "make, says",
    [
        (lambda: chaintrue.Grid([[0.0, 0.0]] * 9, [[1.0, 1.0]] * 8), "9 marks, but 8 lengths"),
        (lambda: chaintrue.Grid([[0.0, numpy.nan]]), "row 0"),
        (lambda: chaintrue.Grid([0.0, 0.0]), "shape"),
        (lambda: chaintrue.Holes([[0.0, 0.0]], [(0, 1)]), "a distance is"),
        (lambda: chaintrue.Holes([[0.0, 0.0]], [], names=["A", "B"]), "1 holes, but 2 names"),
        (lambda: chaintrue.Belts([[1.0, 2.0]]), r"\(n, 4\)"),
    ],
)
def test_shapes_that_do_not_fit_are_named(make, says):
    with pytest.raises(ValueError, match=says):
        make()


def test_bad_input_has_fields(machine):
    with pytest.raises(chaintrue.InputError) as told:
        chaintrue.Holes([[0.0, 0.0]] * 5, [("A", "B", 100.0)], machine=machine)
    problems = told.value.problems
    assert problems and all(isinstance(problem, chaintrue.Problem) for problem in problems)
    assert all(problem.file == "arrays" for problem in problems)
    assert any(problem.place.startswith("/distances/0") for problem in problems)
    assert all(problem.message in str(told.value) for problem in problems)


@pytest.mark.parametrize(
    "reason, make",
    [
        ("no_machine", lambda grid: chaintrue.fit(chaintrue.Grid(grid.marks, grid.lengths))),
        ("not_a_grid", lambda grid: chaintrue.fit(grid, surface="direct")),
    ],
)
def test_a_failure_has_a_reason(grid, reason, make):
    with pytest.raises(chaintrue.Failure) as told:
        make(grid)
    assert told.value.reason == reason
    assert told.value.sentence == str(told.value)


def test_few_points_check_and_do_not_fit(grid):
    marks, lengths = grid.marks[:4], grid.lengths[:4]
    with pytest.raises(chaintrue.InputError):
        chaintrue.Grid(marks, lengths)
    few = chaintrue.Grid(marks, lengths, machine=grid.machine, few=True)
    assert len(few) == 4
    with pytest.raises(chaintrue.InputError, match="/points") as told:
        chaintrue.fit(few)
    assert {problem.file for problem in told.value.problems} == {"grid.json"}


def test_a_dictionary_is_held_to_what_a_file_is(machine):
    with pytest.raises(TypeError, match="from_dict"):
        chaintrue.Machine()
    assert chaintrue.Machine.from_dict(machine.to_dict()) == machine
    with pytest.raises(chaintrue.InputError, match="motors"):
        chaintrue.Machine.from_dict({**machine.to_dict(), "motors": 3})
