# SPDX-License-Identifier: GPL-3.0-or-later
"""Machines, and points that somebody measured with one: from files, and from arrays."""

from __future__ import annotations

import os
from typing import Any, Iterable, Optional

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _core, _plots
from ._base import Filed, PathLike, sources_of, text_of, told
from ._contents import Readings, points_of


class Machine(Filed):
    """A machine as its owner states it (docs/formats/machine.md): read_machine, or from_dict."""

    _parse = staticmethod(_core.parse_machine)

    def _facts(self) -> dict[str, Any]:
        contents = self.to_dict()
        bed = contents["bed"]
        return {"mm wide": bed["width_mm"], "mm high": bed["height_mm"]}

    def plot(self, ax: Any = None) -> Any:
        """Bed and motors, with matplotlib; the axes are given back."""
        return _plots.machine(self.to_dict(), ax)


class Grid(Filed):
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

    _parse = staticmethod(lambda text, file: _core.parse_grid(text, file, True))

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
        contents = {
            "name": name,
            "machine": None if machine is None else machine.to_dict(),
            "noise": noise,
            "readings": list(readings) or None,
            "points": points_of(marks, lengths, commanded, order),
        }
        grid, _ = _core.parse_grid(text_of(contents, "chaintrue_grid"), "arrays", few)
        super().__init__(grid, sources_of(machine))

    @property
    def machine(self) -> Optional[Machine]:
        """The Machine that the grid names, or None."""
        return None if self._core.machine is None else Machine(self._core.machine)

    @property
    def marks(self) -> NDArray[numpy.float64]:
        """(n, 2) array, mm: where the tool was, x and y."""
        return self._core.marks

    @property
    def lengths(self) -> Optional[NDArray[numpy.float64]]:
        """(n, 2) array, mm: left and right chain as read; None where a point has none."""
        return self._core.lengths

    @property
    def commanded(self) -> Optional[NDArray[numpy.float64]]:
        """(n, 2) array, mm: where the controller was told to go; None where a point has none."""
        return self._core.commanded

    @property
    def order(self) -> Optional[NDArray[numpy.int_]]:
        """(n,) array of whole numbers: which visit each was; None where that is not known."""
        return None if self._core.order is None else numpy.array(self._core.order)

    def __len__(self) -> int:
        return len(self._core.marks)

    def _facts(self) -> dict[str, Any]:
        read = "read at each" if self.lengths is not None else "commanded for each"
        what = "two lengths" if self.lengths is not None else "a place"
        return {"points": len(self), read: what}

    def plot(self, ax: Any = None) -> Any:
        """The marks, and arrows from where the tool was sent; the axes are given back."""
        return _plots.grid(self.marks, self.commanded, ax)


def core_of(machine: Optional[Machine]) -> Any:
    return None if machine is None else machine._core


def read_machine(path: PathLike) -> Machine:
    """The Machine of a chaintrue_machine file. What was assumed is a warning."""
    return told(_core.read_machine(os.fspath(path)), Machine)


def read_grid(path: PathLike, machine: Optional[Machine] = None, few: bool = False) -> Grid:
    """The Grid of a chaintrue_grid file, JSON or CSV; machine in place of the one that it names.

    few  a handful of points, which only check a map
    """
    return told(_core.read_grid(os.fspath(path), core_of(machine), few), Grid, machine)
