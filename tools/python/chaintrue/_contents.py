# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays as the contents of a file of measurements."""

from __future__ import annotations

from typing import Any, Iterable

import numpy

from ._base import array_of

Readings = Iterable[dict[str, Any]]
"""An additional reading, as in a file: {"what": "link_pitch_mm", "side": "left", "value": 6.353,
"sigma": 0.001}."""

PLACE = ("x_mm", "y_mm")
COMMANDED = ("commanded_x_mm", "commanded_y_mm")


def entries_of(numbers: Any, name: str, keys: tuple[str, ...]) -> list[dict[str, Any]]:
    """The rows of an array with as many columns, each as an entry of a file."""
    return [dict(zip(keys, row)) for row in array_of(numbers, name, len(keys)).tolist()]


def add(entries: list[dict[str, Any]], name: str, more: list[dict[str, Any]], more_name: str) -> None:
    """Adds further keys to each entry. Raises ValueError unless there are as many."""
    if len(more) != len(entries):
        raise ValueError(f"{len(entries)} {name}, but {len(more)} {more_name}")
    for entry, values in zip(entries, more):
        entry.update(values)


def add_visits(points: list[dict[str, Any]], name: str, commanded: Any, order: Any) -> None:
    """Adds commanded places and visit numbers, if given."""
    if commanded is not None:
        add(points, name, entries_of(commanded, "commanded", COMMANDED), "commanded places")
    if order is not None:
        add(points, name, [{"order": int(number)} for number in order], "orders")


def _end(end: Any) -> Any:
    """A name, a number, or a place as (x, y)."""
    if isinstance(end, str):
        return end
    if numpy.ndim(end) == 1:
        return dict(zip(PLACE, map(float, end), strict=True))
    return int(end)


def distance_of(one: tuple[Any, ...]) -> dict[str, Any]:
    """(from, to, mm) or (from, to, mm, sigma) as an entry of "distances"."""
    if len(one) not in (3, 4):
        raise ValueError(f"a distance is (from, to, mm) or (from, to, mm, sigma), not {one!r}")
    start, end, *numbers = one
    values = dict(zip(("distance_mm", "sigma_mm"), map(float, numbers)))
    return {"from": _end(start), "to": _end(end), **values}
