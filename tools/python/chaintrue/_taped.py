# SPDX-License-Identifier: GPL-3.0-or-later
"""Tape and belt measurements, from files and from arrays."""

from __future__ import annotations

from typing import Any, Iterable, Optional

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _plots
from ._base import Filed, Listed, PathLike, from_file, sources_of
from ._contents import PLACE, Readings, add, add_visits, distance_of, entries_of
from ._measured import Machine, machine_in

_LENGTHS = ("tl_mm", "tr_mm", "bl_mm", "br_mm")


class Belts(Listed):
    """What a router on four belts measured by itself (docs/formats/belts.md).

    lengths    (n, 4) array, mm: top left, top right, bottom left, bottom right belt as printed
    anchors    (4, 2) or (4, 3) array, mm: where these leave the frame, and how high; None: unknown
    commanded  (n, 2) array, mm: where the controller was told to go; or None
    order      n whole numbers, all different: which visit each was; or None
    distances  (from, to, distance in mm[, sigma in mm]) of a tape, between places by their number, the
               anchors tl, tr, bl and br, and holes by their commanded (x, y)
    machine    what else its file says of the machine, {"arm_mm": 123.4, ...}; or other Belts
    """

    def __init__(
        self,
        lengths: ArrayLike,
        anchors: Optional[ArrayLike] = None,
        commanded: Optional[ArrayLike] = None,
        order: Optional[Iterable[int]] = None,
        distances: Iterable[tuple[Any, ...]] = (),
        machine: Any = None,
        name: str = "",
    ):
        points = entries_of(lengths, "lengths", _LENGTHS)
        add_visits(points, "lengths", commanded, order)
        stated = dict(_machine_of(machine) or {})
        if anchors is not None:
            keys = (*PLACE, "z_mm") if numpy.shape(anchors)[1:] == (3,) else PLACE
            stated["anchors"] = {length[:2]: {} for length in _LENGTHS}
            placed = [*stated["anchors"].values()]
            add(placed, "belts", entries_of(anchors, "anchors", keys), "anchors")
        contents = {
            "name": name,
            "machine": stated or None,
            "points": points,
            "distances": [distance_of(one) for one in distances] or None,
        }
        self._become(contents, sources_of(machine))

    @property
    def lengths(self) -> NDArray[numpy.float64]:
        """(n, 4) array, mm: top left, top right, bottom left, bottom right belt as printed."""
        return self._columns(*_LENGTHS)

    def _facts(self) -> dict[str, Any]:
        return {"places": len(self), "taped distances": len(self._contents.get("distances", []))}

    plot = _plots.belts


class Holes(Listed):
    """Holes that the machine drilled, and a tape's distances (docs/formats/holes.md).

    commanded  (n, 2) array, mm: where the controller was told to drill
    distances  (from, to, distance in mm), or with the reading's own sigma in mm as a fourth: from and
               to name holes or count them from 0, to may be left, right, top or bottom edge
    names      n words; None: the holes are numbered from 0
    machine    the Machine that drilled them, or the Belts of a machine on four belts
    tape_sigma_mm, hole_sigma_mm, noise_dof
               one sigma of a reading, of a hole on each axis, and how well these are known
    hook_offset_mm
               by how much each reading is longer than the distance
    sheet      {"width_mm": ..., "height_mm": ..., "size_sigma_mm": ...}, for edges
    readings   what was measured besides, dictionaries as in a file
    few        a few distances, which only check a map
    """

    _list = "holes"

    def __init__(
        self,
        commanded: ArrayLike,
        distances: Iterable[tuple[Any, ...]],
        names: Optional[Iterable[str]] = None,
        machine: Optional[Filed] = None,
        tape_sigma_mm: float = 0.5,
        hole_sigma_mm: float = 0.3,
        noise_dof: float = 15.0,
        hook_offset_mm: float = 0.0,
        sheet: Optional[dict[str, float]] = None,
        name: str = "",
        readings: Readings = (),
        few: bool = False,
    ):
        holes = entries_of(commanded, "commanded", PLACE)
        if names is not None:
            add(holes, "holes", [{"name": name} for name in names], "names")
        contents = {
            "name": name,
            "machine": _machine_of(machine),
            "tape": {"sigma_mm": tape_sigma_mm, "hook_offset_mm": hook_offset_mm},
            "hole_sigma_mm": hole_sigma_mm,
            "noise_dof": noise_dof,
            "sheet": sheet,
            "readings": list(readings) or None,
            "holes": holes,
            "distances": [distance_of(one) for one in distances],
        }
        self._become(contents, sources_of(machine), few)

    @property
    def machine(self) -> Optional[Machine]:
        """The Machine on two chains that drilled them, or None."""
        return machine_in(self._contents)

    @property
    def commanded(self) -> NDArray[numpy.float64]:
        """(n, 2) array, mm: the commanded places of the holes."""
        return self._columns(*PLACE)

    @property
    def _are_of_belts(self) -> bool:
        return "anchors" in self._contents.get("machine", {})

    def _facts(self) -> dict[str, Any]:
        return {"holes": len(self), "distances": len(self._contents["distances"])}

    plot = _plots.holes


def _machine_of(machine: Any) -> Optional[dict[str, Any]]:
    """The "machine" entry, from a Machine, from other Belts or as it stands in a file."""
    if isinstance(machine, Belts):
        return machine.to_dict()["machine"]
    return machine.to_dict() if isinstance(machine, Machine) else machine


def read_holes(path: PathLike, machine: Optional[Machine] = None, few: bool = False) -> Holes:
    """The Holes of a chaintrue_holes file, JSON or CSV; machine in place of the one that it names.

    few  a few distances, which only check a map
    """
    return from_file(Holes, path, machine, few)


def read_belts(path: PathLike) -> Belts:
    """The Belts of a chaintrue_belts file."""
    return from_file(Belts, path)
