# SPDX-License-Identifier: GPL-3.0-or-later
"""What several tests start from."""

import pathlib

import numpy
import pytest

import chaintrue

ROOT = pathlib.Path(__file__).resolve().parents[3]
FIXTURES = ROOT / "fixtures"


@pytest.fixture(scope="session")
def grid():
    return chaintrue.read_grid(FIXTURES / "grids" / "seven_by_four.json")


@pytest.fixture(scope="session")
def calibration(grid):
    return chaintrue.fit(grid)


@pytest.fixture(scope="session")
def new_points():
    """Of the same machine: for a check."""
    return chaintrue.read_grid(FIXTURES / "grids" / "five_new_points.json", few=True)


def read_anew(grid, lengths, **others):
    """The grid with other readings, as precise as those of the fixtures."""
    return chaintrue.Grid(
        grid.marks, lengths, machine=grid.machine, length_noise_mm=0.2, position_noise_mm=0.3, **others
    )


@pytest.fixture(scope="session")
def machine():
    return chaintrue.read_machine(FIXTURES / "machines" / "classic.json")


@pytest.fixture(scope="session")
def holes():
    return chaintrue.read_holes(FIXTURES / "holes" / "nine_holes.json")


@pytest.fixture(scope="session")
def belts():
    return chaintrue.read_belts(FIXTURES / "belts" / "thirty_one_places.json")


@pytest.fixture(scope="session")
def anchors(belts):
    return chaintrue.fit(belts)


@pytest.fixture(scope="session")
def diagnosis(grid):
    return chaintrue.diagnose(grid, gain=False)


@pytest.fixture(scope="session")
def worn_diagnosis(grid):
    """Of the grid's marks with the left chain's links 0.3 % longer: readings of a machine that is as
    stated otherwise, and noise of the fixture's size from a printed seed."""
    seed = 20
    print(f"seed {seed}")
    noise = numpy.random.default_rng(seed)
    lengths = grid.lengths.copy()
    lengths[:, 0] /= 1.003
    lengths += noise.normal(0.0, 0.05, lengths.shape)
    worn = read_anew(grid, lengths, order=grid.order, name="a worn chain")
    return chaintrue.diagnose(worn, gain=False)
