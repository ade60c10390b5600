# SPDX-License-Identifier: GPL-3.0-or-later
"""What maps and anchors answer: shapes, names, masks, accuracy."""

import numpy
import pytest

import chaintrue

# Newton's steps end at 1e-9 mm; on the bed the tool moves at most ten times as far as the chains.
RETURNS_MM = 1e-8


def test_one_place_is_one_answer(calibration):
    one = calibration.query([100.0, 200.0])
    row = calibration.query([[100.0, 200.0]])
    assert one.lengths.shape == (2,) and one.left.shape == one.tool_sigma.shape == ()
    assert one.left == row.left[0] and one.right_sigma == row.right_sigma[0]
    assert one.status == "inside" and one.why == ""
    place = calibration.inverse(one)
    assert place.shape == (2,)
    assert numpy.abs(place - [100.0, 200.0]).max() < RETURNS_MM


def test_a_raster_keeps_its_shape(calibration):
    x, y = numpy.meshgrid([-500.0, 0.0, 500.0], [-200.0, 200.0])
    raster = numpy.stack([x, y], axis=-1)
    answer = calibration.query(raster)
    assert answer.lengths.shape == answer.sigma.shape == (2, 3, 2)
    assert answer.left.shape == answer.tool_sigma.shape == answer.status.shape == (2, 3)
    flat = calibration.query(raster.reshape(-1, 2))
    assert numpy.array_equal(answer.lengths.reshape(-1, 2), flat.lengths)
    assert numpy.abs(calibration.inverse(answer) - raster).max() < RETURNS_MM
    assert calibration.query(numpy.zeros((0, 2))).lengths.shape == (0, 2)


def test_arrays_have_names(calibration, anchors):
    answer = calibration.query([[100.0, 200.0]])
    assert answer.names == ("left", "right")
    assert numpy.array_equal(answer.left, answer.lengths[..., 0])
    assert list(answer.columns())[:4] == ["x_mm", "y_mm", "left_mm", "right_mm"]
    with pytest.raises(AttributeError, match="left, right"):
        answer.middle
    belts = anchors.query([100.0, 200.0])
    assert belts.names == ("tl", "tr", "bl", "br")
    assert belts.bl == belts.lengths[2]
    assert numpy.abs(anchors.inverse(belts) - [100.0, 200.0]).max() < RETURNS_MM


def test_what_has_no_answer_says_why_and_stays_masked(calibration):
    answer = calibration.query([[0.0, 0.0], [0.0, 20000.0]])
    assert answer.why[0] == "" and answer.why[1] and answer.status[1] == "outside"
    assert answer.columns()["left_mm"][1] is None
    for masked in (answer.lengths, calibration.inverse(answer)):
        assert masked.mask.tolist() == [[False, False], [True, True]]
        assert numpy.isfinite(masked.data).all()
    assert calibration.inverse([[10.0, 10.0]]).mask.all()


def test_the_functions_are_the_methods(calibration, anchors):
    for thing in (calibration, anchors):
        assert chaintrue.query(thing, [0.0, 0.0]).left == thing.query([0.0, 0.0]).left
        lengths = thing.query([[0.0, 0.0]])
        assert numpy.array_equal(chaintrue.inverse(thing, lengths), thing.inverse(lengths))
    with pytest.raises(ValueError, match="marks or bed"):
        calibration.query([0.0, 0.0], frame="sheet")


def test_a_map_knows_its_accuracy(calibration, anchors):
    stored = calibration.to_dict()["accuracy"]
    assert calibration.accuracy.expected_tool.rms_mm == stored["expected_tool"]["rms_mm"]
    assert calibration.accuracy.leave_one_out.tool.maximum_mm > 0.0
    assert calibration.machine.to_dict()["motors"] != {}
    assert [row.setting for row in calibration.settings] == [
        row["setting"] for row in calibration.to_dict()["settings"]
    ]
    assert len(calibration.points) == 34
    assert anchors.accuracy.spread_mm == anchors.to_dict()["fit"]["spread_mm"]
    assert anchors.coordinates[0].coordinate == "tl_x_mm"
    assert "tlX" in anchors.settings


def test_causes_are_records(worn_diagnosis):
    assert worn_diagnosis.verdict == "named"
    cause = worn_diagnosis.causes[0]
    assert isinstance(cause, chaintrue.Cause)
    assert (cause.effect, cause.side) == ("chain_pitch_error", "left")
    assert cause["effect"] == cause.effect  # dictionaries, as they were
    found = cause.parameters.elongation
    # Four of its sigmas: once in ten thousand beside it by chance.
    assert abs(found.value - 0.003) < 4.0 * found.sigma
    columns = worn_diagnosis.causes.columns()
    assert columns["parameters.elongation.value"] == [found.value]
    assert worn_diagnosis.hypotheses[0].probability >= worn_diagnosis.hypotheses[1].probability
    effects = worn_diagnosis.machine.to_dict()["effects"]
    assert any("chain_pitch_error" in str(effect) for effect in effects)


def test_several_files_are_one_fit(grid, holes, calibration):
    joint = chaintrue.fit([grid, holes])
    assert joint.accuracy != calibration.accuracy != chaintrue.fit(holes).accuracy
    with pytest.raises(TypeError, match="Grids, Holes and Belts"):
        chaintrue.fit([grid, "holes.json"])
    with pytest.raises(TypeError):
        chaintrue.fit([])


def test_belts_are_diagnosed_by_themselves(belts, grid):
    found = chaintrue.diagnose(belts)
    assert found.sentence and found.machine is None
    with pytest.raises(ValueError, match="with the machine in their file"):
        chaintrue.diagnose(belts, grid)
