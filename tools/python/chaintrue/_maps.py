# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of two chains and anchors of four belts: fits and queries."""

from __future__ import annotations

import functools
from typing import Any, Iterable, Optional, Union, overload

import numpy
from numpy.typing import ArrayLike

from . import _core, _plots
from ._base import Made, PathLike, array_of, from_file, inputs, key, one_of, sources_of
from ._lengths import Lengths, answered, masked
from ._measured import Grid, Machine
from ._records import Record, Records, records
from ._taped import Belts, Holes

Measured = Union[Grid, Holes, Belts]


class Accuracy(Record):
    """A map's expected and held-out errors. Errors of the tool and of the chains have rms_mm and
    maximum_mm; those of points left out contain the readings' noise."""

    expected_tool: Record
    """Over the measured part, one sigma, against the true machine."""
    expected_worst_at: Record
    """x_mm and y_mm of its largest."""
    leave_one_out: Record
    """Each point predicted by the others: chain, tool, tool_x_rms_mm, tool_y_rms_mm."""
    blocked: Record
    """The same for whole parts of the bed."""


class AnchorsAccuracy(Record):
    """The errors of fitted anchors, mm."""

    spread_mm: float
    """One reading of a belt, one sigma."""
    rms_mm: float
    """The same, as the firmware computes it."""
    foretold: Record
    """Left-out readings predicted by the others."""


class _Asked(Made):
    """A result that converts places to lengths and back."""

    @functools.cached_property
    def _answering(self) -> Any:
        return _core.Answering(self._text)

    def query(self, xy: ArrayLike, frame: str = "marks") -> Lengths:
        """The chain or belt lengths at places, an array (..., 2) of x and y in mm; (2,) is one place.

        frame  of a map: marks: as the grid's points were given; bed: as the machine file has it
        """
        places = array_of(xy, "points", also_single=True)
        return answered(places, self._answering.query(places.reshape(-1, 2), _is_bed(frame)))

    def inverse(self, lengths: Union[ArrayLike, Lengths], frame: str = "marks") -> numpy.ma.MaskedArray:
        """Where the tool is, a masked array (..., 2) of x and y in mm, for lengths: an array (..., 2)
        of left and right chain or of the upper two belts in mm, or what query gave."""
        if isinstance(lengths, Lengths):
            lengths = lengths.lengths[..., :2]
        unknown = numpy.ma.getmaskarray(numpy.ma.asarray(lengths)).any(axis=-1)
        pairs = array_of(numpy.ma.filled(lengths, 0.0), "lengths", also_single=True)
        points = self._answering.inverse(pairs.reshape(-1, 2), _is_bed(frame)).reshape(pairs.shape)
        points[unknown] = numpy.nan
        return masked(points)


class Map(_Asked):
    """A compensation map: the chain lengths for every place of the bed."""

    notes: list[str] = key("notes", "What its reader should know, in sentences.", missing=[])
    accuracy: Accuracy = key(
        "accuracy",
        "What it says of its own error: accuracy.expected_tool.rms_mm and more.",
        Accuracy.of,
    )
    settings: Records = key(
        "settings", "The settings as stated and as fitted, with their sigmas.", records
    )
    points: Records = key(
        "points",
        "The measured points: how far the tool was off as stated, with the map, and left out.",
        records,
    )

    @property
    def sentence(self) -> str:
        """The tool's error today, and the error that remains with this map."""
        return self._answering.sentence()

    @property
    def machine(self) -> Optional[Machine]:
        """The Machine with its settings as fitted; None of a direct surface."""
        text = self._answering.machine()
        return Machine._of(text) if text else None

    plot = _plots.calibration

    def _facts(self) -> dict[str, Any]:
        return {
            "points": len(self.points),
            "mm expected error of the tool, rms": f"{self.accuracy.expected_tool.rms_mm:.2f}",
        }


class Anchors(_Asked):
    """The anchors of four belts as fitted: the map of such a machine."""

    @property
    def accuracy(self) -> AnchorsAccuracy:
        """The errors of the fit."""
        fit = self._contents["fit"]
        return AnchorsAccuracy.of(
            {key: fit[key] for key in ("spread_mm", "rms_mm", "rms_of_mm", "foretold") if key in fit}
        )

    @property
    def coordinates(self) -> Records:
        """Each coordinate of an anchor: coordinate, stated_mm, fitted_mm, sigma_mm, rests_on."""
        return records(self._contents["fit"]["coordinates"])

    @property
    def settings(self) -> str:
        """Lines to paste into the machine's terminal."""
        return _core.maslow4_settings(self._text)

    plot = _plots.belts

    def _facts(self) -> dict[str, Any]:
        return {
            "places": len(self._contents["fit"].get("places", [])),
            "mm a reading is off": f"{self.accuracy.spread_mm:.2f}",
        }


def _is_bed(frame: str) -> bool:
    return one_of(frame, "frame", ("marks", "bed")) == "bed"


def things_of(measured: Union[Measured, Iterable[Measured]]) -> list[Measured]:
    """A list also of a single one."""
    return [measured] if isinstance(measured, (Grid, Holes, Belts)) else list(measured)


def sorted_out(measured: Iterable[Measured], who: str) -> tuple[list[Any], list[Any], list[Any]]:
    """The grids, the holes and the belts among them, or TypeError."""
    found: dict[type, list[Any]] = {Grid: [], Holes: [], Belts: []}
    for thing in measured:
        if type(thing) not in found:
            raise TypeError(f"{who} takes Grids, Holes and Belts, not {type(thing).__name__}")
        found[type(thing)].append(thing)
    if not any(found.values()):
        raise TypeError(f"{who} takes Grids, Holes and Belts, one at least")
    return found[Grid], found[Holes], found[Belts]


@overload
def fit(
    measured: Grid, surface: str = ..., plain: bool = ..., accept_class: bool = ...
) -> Map: ...
@overload
def fit(
    measured: Belts, surface: str = ..., plain: bool = ..., accept_class: bool = ...
) -> Anchors: ...
@overload
def fit(
    measured: Union[Measured, Iterable[Measured]],
    surface: str = ...,
    plain: bool = ...,
    accept_class: bool = ...,
) -> Any: ...
def fit(
    measured: Union[Measured, Iterable[Measured]],
    surface: str = "residual",
    plain: bool = False,
    accept_class: bool = False,
) -> Any:
    """The Map of a Grid, of Holes, or of several of one machine; of Belts, and of holes that such a
    machine drilled, the Anchors.

    surface  residual: the machine, calibrated, and a smooth correction of what it leaves
             direct: splines through the lengths themselves, for points on full rows and columns; needs
             no machine
    plain    on the machine as stated; without it causes are looked for as diagnose does, and the map is
             built on those that make it better on points left out: its notes say which
    accept_class  take the links if links and tape cannot be distinguished
    """
    things = things_of(measured)
    _, holes, belts = sorted_out(things, "fit")
    words = ["fit", *inputs(things)]
    if one_of(surface, "surface", ("residual", "direct")) == "direct":
        words += ["--surface", "direct"]
    words += ["--plain"] * plain + ["--accept-class"] * accept_class
    kind = Anchors if belts or any(read._are_of_belts for read in holes) else Map
    return kind._by(*words, sources=sources_of(*things))


def read_map(path: PathLike) -> Map:
    """The Map of a chaintrue_map file."""
    return from_file(Map, path)


def read_anchors(path: PathLike) -> Anchors:
    """The Anchors of a chaintrue_anchors file."""
    return from_file(Anchors, path)


def query(map: Union[Map, Anchors], points: ArrayLike, frame: str = "marks") -> Lengths:
    """Chain lengths at points: the same as calibration.query(points)."""
    return map.query(points, frame)


def inverse(
    map: Union[Map, Anchors], lengths: Union[ArrayLike, Lengths], frame: str = "marks"
) -> numpy.ma.MaskedArray:
    """Places for chain lengths: the same as calibration.inverse(lengths)."""
    return map.inverse(lengths, frame)
