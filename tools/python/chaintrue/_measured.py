# SPDX-License-Identifier: GPL-3.0-or-later
"""Machines and measured points, from files and from arrays."""

from __future__ import annotations

import json
from typing import Any, Iterable, Optional

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _core, _plots
from ._base import Filed, Listed, PathLike, from_file, sources_of
from ._contents import COMMANDED, PLACE, Readings, add, add_visits, entries_of

_LENGTHS = ("left_mm", "right_mm")


class Machine(Filed):
    """A machine as its owner states it (docs/formats/machine.md): read_machine, or from_dict."""

    def _facts(self) -> dict[str, Any]:
        bed = self._contents["bed"]
        return {"mm wide": bed["width_mm"], "mm high": bed["height_mm"]}

    plot = _plots.machine


class Grid(Listed):
    """Measured points of one session.

    marks      (n, 2) array, mm: where the tool was, x and y
    lengths    (n, 2) array, mm: left and right chain as read; or None
    commanded  (n, 2) array, mm: where the controller was told to go, in place of lengths; or None
    order      n whole numbers, all different: which visit each was; or None
    machine    a Machine, which a fit and a diagnosis need
    length_noise_mm, position_noise_mm
               one sigma of a length, and of a mark on each axis; None: told from repeated visits or
               from the fit
    noise_dof  how well these are known, in degrees of freedom
    readings   what was measured besides, dictionaries as in a file
    few        a handful of points, which only check a map
    """

    def __init__(
        self,
        marks: ArrayLike,
        lengths: Optional[ArrayLike] = None,
        commanded: Optional[ArrayLike] = None,
        order: Optional[Iterable[int]] = None,
        machine: Optional[Machine] = None,
        length_noise_mm: Optional[float] = None,
        position_noise_mm: Optional[float] = None,
        noise_dof: float = 15.0,
        name: str = "",
        readings: Readings = (),
        few: bool = False,
    ):
        if (length_noise_mm is None) != (position_noise_mm is None):
            raise ValueError("give both length_noise_mm and position_noise_mm, or neither")
        noise = None
        if length_noise_mm is not None:
            noise = {"length_mm": length_noise_mm, "position_mm": position_noise_mm, "dof": noise_dof}
        points = entries_of(marks, "marks", PLACE)
        if lengths is not None:
            add(points, "marks", entries_of(lengths, "lengths", _LENGTHS), "lengths")
        add_visits(points, "marks", commanded, order)
        contents = {
            "name": name,
            "machine": None if machine is None else machine.to_dict(),
            "noise": noise,
            "readings": list(readings) or None,
            "points": points,
        }
        self._become(contents, sources_of(machine), few)

    @property
    def machine(self) -> Optional[Machine]:
        """The Machine that the grid names, or None."""
        return machine_in(self._contents)

    @property
    def marks(self) -> NDArray[numpy.float64]:
        """(n, 2) array, mm: where the tool was, x and y."""
        return self._columns(*PLACE)

    @property
    def lengths(self) -> Optional[NDArray[numpy.float64]]:
        """(n, 2) array, mm: left and right chain as read; None where a point has none."""
        return self._columns(*_LENGTHS)

    @property
    def commanded(self) -> Optional[NDArray[numpy.float64]]:
        """(n, 2) array, mm: the commanded places; None for points without one."""
        return self._columns(*COMMANDED)

    @property
    def order(self) -> Optional[NDArray[numpy.int_]]:
        """(n,) array of visit numbers; None if the order is not known."""
        order = self._columns("order", number=int)
        return None if order is None else order[:, 0]

    def _facts(self) -> dict[str, Any]:
        read = "read at each" if self.lengths is not None else "commanded for each"
        what = "two lengths" if self.lengths is not None else "a place"
        return {"points": len(self), read: what}

    plot = _plots.grid


def machine_in(contents: dict[str, Any], key: str = "machine") -> Optional[Machine]:
    """The Machine on two chains that a file holds, or None."""
    if "motors" not in contents.get(key, {}):
        return None
    return Machine._of(_core.parse("machine", json.dumps(contents[key]), key, "", True)[0])


def read_machine(path: PathLike) -> Machine:
    """The Machine of a chaintrue_machine file; assumptions are issued as warnings."""
    return from_file(Machine, path)


def read_grid(path: PathLike, machine: Optional[Machine] = None, few: bool = False) -> Grid:
    """The Grid of a chaintrue_grid file, JSON or CSV; machine in place of the one that it names.

    few  a handful of points, which only check a map
    """
    return from_file(Grid, path, machine, few)
