# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans, checks, programs and sweeps."""

import csv
import hashlib
import io
import json
import pickle

import numpy
import pytest

import chaintrue
from chaintrue import _core
from conftest import FIXTURES, read_anew

BRACKET = FIXTURES / "gcode" / "bracket.nc"


def test_a_plan_that_is_filled_in_is_a_grid(tmp_path, machine, calibration):
    plan = chaintrue.plan(machine, 20, second_visits=2)
    assert plan.marks.shape == (20, 2) and len(plan.visits) == 22
    assert plan.expected_rms_mm > 0.0
    rows = list(csv.DictReader(io.StringIO(plan.table)))
    assert len(rows) == 22
    for row, place in zip(rows, plan.marks[plan.visits]):
        assert (float(row["x_mm"]), float(row["y_mm"])) == tuple(place)
        answer = calibration.query(place)
        row.update(left_mm=f"{answer.left:.3f}", right_mm=f"{answer.right:.3f}")
    filled = tmp_path / "filled.csv"
    with filled.open("w", newline="") as out:
        writer = csv.DictWriter(out, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    again = chaintrue.fit(chaintrue.read_grid(filled, machine=machine))
    # Readings of the map itself, rounded to 0.001 mm; the surfaces between the marks differ by less
    # than either map expects of itself.
    at = [[0.0, 0.0], [500.0, -200.0]]
    off = numpy.abs(again.query(at).lengths - calibration.query(at).lengths)
    assert off.max() < 3.0 * calibration.accuracy.expected_tool.maximum_mm


def test_plans_of_holes_and_of_checks(tmp_path, machine, calibration):
    holes = chaintrue.plan(machine, holes=6, edges=True)
    assert holes.marks.shape == (6, 2) and "from,to" in holes.table
    few = chaintrue.plan(calibration)
    assert len(few) == 5 and min(few.expected_sigmas) > 1.0
    assert "<svg" in few.drawing and "G0" in few.program
    few.write(tmp_path / "five.json")
    few.write(tmp_path / "five.csv")
    assert (tmp_path / "five.json").read_text() == few.sheet
    assert (tmp_path / "five.csv").read_text() == few.table


@pytest.mark.parametrize(
    "asked, says",
    [
        ({"points": 3}, "--points: found 3"),
        ({"points": 28, "holes": 9}, "not both"),
        ({"holes": 1}, "--holes: found 1"),
        ({"holes": 6, "distances": 1}, "--distances: found 1"),
        ({"second_visits": 20}, "--second-visits: found 20"),
        ({"measure": "angles"}, "measure is"),
    ],
)
def test_plans_that_cannot_be_are_refused(machine, asked, says):
    with pytest.raises(ValueError, match=says):
        chaintrue.plan(machine, **asked)


def test_a_check_finds_what_has_changed(calibration, new_points):
    holds = chaintrue.check(calibration, new_points)
    assert holds.valid and holds.verdict == "valid" and holds.decided
    assert sum(holds.probability.values()) == pytest.approx(1.0, abs=1e-9)  # rounding of three sums
    assert len(holds.residuals) == 2 * len(new_points) and holds.residuals[0].sigma_mm > 0.0
    moved = read_anew(new_points, new_points.lengths + [6.35, 0.0], few=True)
    changed = chaintrue.check(calibration, moved)
    assert not changed.valid and changed.verdict == "valid_after_rezeroing"
    assert changed.hypotheses[0].side == "left"


def test_a_check_goes_by_the_settings_that_were_in_force(tmp_path, calibration, new_points):
    # Lengths were read, whatever the controller held.
    settings = FIXTURES / "good" / "groundcontrol_ring.ini"
    assert chaintrue.check(calibration, new_points, settings=settings).verdict == "valid"
    with pytest.raises(chaintrue.InputError, match="no file"):
        chaintrue.check(calibration, new_points, settings=tmp_path / "nothing.ini")


def test_what_to_measure_after_a_diagnosis(tmp_path, grid, diagnosis, belts):
    plan = chaintrue.plan(grid, after=diagnosis)
    assert plan.marks.shape == (len(plan.visits), 2)
    assert len(plan) <= len(diagnosis.next_measurements)
    assert plan.page and plan.program == "" and "<svg" in plan.drawing
    other = chaintrue.Grid(grid.marks + 5.0, grid.lengths, machine=grid.machine)
    with pytest.raises(ValueError, match="other readings"):
        chaintrue.plan(other, after=diagnosis)
    with pytest.raises(ValueError, match="other readings"):
        chaintrue.plan(belts, after=diagnosis)
    with pytest.raises(TypeError, match="after"):
        chaintrue.plan(grid)
    with pytest.raises(TypeError, match="what was diagnosed"):
        chaintrue.plan(grid.machine, after=diagnosis)


def test_a_diagnosis_predicts_another_grid(grid, diagnosis, belts):
    now = chaintrue.diagnose(grid, gain=False, held_out=grid)
    assert now.held_out is not None and diagnosis.held_out is None
    with pytest.raises(TypeError, match="held_out is a Grid"):
        chaintrue.diagnose(grid, held_out=diagnosis)
    with pytest.raises(ValueError, match="one Grid"):
        chaintrue.diagnose(belts, held_out=grid)


def test_results_say_what_they_were_made_from(tmp_path, grid, calibration, machine, diagnosis):
    path = FIXTURES / "grids" / "seven_by_four.json"
    of_grid = {"name": path.name, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
    assert calibration.made_by.verb == "fit" and calibration.made_by.inputs == [of_grid]
    assert calibration.made_by.version == chaintrue.__version__
    assert diagnosis.made_by.inputs == [of_grid]
    calibration.write(tmp_path / "map.json")
    again = chaintrue.read_map(tmp_path / "map.json")
    assert again.made_by == pickle.loads(pickle.dumps(again)).made_by == calibration.made_by
    assert chaintrue.fit(grid, plain=True).made_by.options == ["--plain"]
    # Arrays have no file; their machine has.
    arrays = chaintrue.fit(chaintrue.Grid(grid.marks, grid.lengths, machine=machine))
    assert [one.name for one in arrays.made_by.inputs] == ["classic.json"]
    with pytest.raises(chaintrue.InputError, match="the version that this program reads"):
        chaintrue.Map.from_dict({**again.to_dict(), "format_version": "1.1"})
    head = chaintrue.gcode.compensate(BRACKET, again, tolerance_mm=0.1).text
    for file in (BRACKET, tmp_path / "map.json"):
        digest = hashlib.sha256(file.read_bytes()).hexdigest()
        assert f"(from {file.name})\n(sha256 begins {digest[:32]})\n" in head
    assert "(option --tolerance-mm 0.1)\n" in head


def test_anchors_are_checked_by_belts(anchors, belts, calibration, grid):
    assert chaintrue.check(anchors, belts).valid
    with pytest.raises(ValueError, match="one Belts"):
        chaintrue.check(anchors, grid)
    with pytest.raises(ValueError, match="Belts check Anchors"):
        chaintrue.check(calibration, belts)


def test_a_compensated_program_holds_and_the_plain_one_does_not(tmp_path, calibration):
    done = chaintrue.gcode.compensate(BRACKET, calibration, tolerance_mm=0.05)
    assert done.strays_mm <= 0.05
    assert done.pieces.shape == (len(done.pieces), 10) and len(done.pieces) > 20
    moved = numpy.hypot(done.pieces[:, 8], done.pieces[:, 9]).max()
    assert moved == pytest.approx(done.largest_correction_mm, rel=1e-6)  # the same, at commands' ends
    done.write(tmp_path / "bracket.true.nc")
    held = chaintrue.gcode.verify(BRACKET, tmp_path / "bracket.true.nc", calibration)
    assert held and held.largest_mm == pytest.approx(done.strays_mm, abs=1e-12)  # the same file
    plain = chaintrue.gcode.verify(BRACKET, BRACKET, calibration)
    assert not plain and plain.fault
    assert plain.uncompensated_mm == held.uncompensated_mm > 1.0


def test_a_program_may_be_its_text_and_lie_elsewhere(calibration):
    text = "G21 G90\nG0 Z5\nG0 X0 Y0\nG1 Z-1 F100\nG1 X100 F500\nG0 Z5\nM2\n"
    there = chaintrue.gcode.compensate(text, calibration, home=(200.0, -100.0))
    assert there.pieces[-1, 4:6].tolist() == [300.0, -100.0]


def test_a_program_that_is_refused_says_its_lines(calibration):
    with pytest.raises(chaintrue.GcodeError) as told:
        chaintrue.gcode.compensate("G21 G90\nG0 X0 Y0\nG1 X99999 F100\nM2\n", calibration)
    assert told.value.problems[0].line == 3
    assert told.value.problems[0].name == "outside_map"
    assert isinstance(told.value, chaintrue.Failure)
    with pytest.raises(TypeError, match="no option tolerance"):
        chaintrue.gcode.compensate(BRACKET, calibration, tolerance=1.0)
    with pytest.raises(ValueError, match="controller is"):
        chaintrue.gcode.compensate(BRACKET, calibration, controller="grbl")
    with pytest.raises(TypeError, match="Map or Anchors"):
        chaintrue.gcode.compensate(BRACKET, "map.json")


def test_a_sweep_goes_on_where_it_was(tmp_path, machine):
    asked = {
        "machines": [{"name": "mine", "machine": machine}],
        "repetitions": 2,
        "evaluation": "13x7",
        "grids": ["4x3", "5x4"],
    }
    first = chaintrue.sweep(asked, tmp_path / "cells")
    kept = (tmp_path / "cells" / "results.csv").read_bytes()
    again = chaintrue.sweep(asked, tmp_path / "cells")
    assert (tmp_path / "cells" / "results.csv").read_bytes() == kept
    assert list(again.results) == list(first.results) and len(first) == 4
    assert {result.status for result in first.results} == {"done"}
    assert {error.points for error in first.errors} == {12, 20}
    with pytest.raises(ValueError, match="another sweep"):
        chaintrue.sweep({**asked, "repetitions": 3}, tmp_path / "cells")
    with pytest.raises(chaintrue.InputError, match="grids"):
        chaintrue.sweep({**asked, "grids": ["a lot"]})


def test_the_module_writes_the_commands_bytes(tmp_path, calibration, diagnosis):
    """Though the module's run reads another file than the command's."""
    path = str(FIXTURES / "grids" / "seven_by_four.json")
    for thing, verb in ((calibration, ["fit", path]), (diagnosis, ["diagnose", path, "--no-gain"])):
        written, commands = tmp_path / f"{verb[0]}_module.json", tmp_path / f"{verb[0]}.json"
        thing.write(written)
        assert _core.run([*verb, "-o", str(commands)], None)[0] == 0
        assert commands.read_bytes() == written.read_bytes()
