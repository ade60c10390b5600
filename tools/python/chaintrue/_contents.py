# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays as the contents of a file of measurements."""

from __future__ import annotations

from typing import Any, Iterable

import numpy

from ._base import rows, same_count

Readings = Iterable[dict[str, Any]]
"""An additional reading, as in a file: {"what": "link_pitch_mm", "side": "left", "value": 6.353,
"sigma": 0.001}."""


def points_of(marks: Any, lengths: Any, commanded: Any, order: Any) -> list[dict[str, Any]]:
    """The "points" entry of a grid."""
    places = rows(marks, "marks")
    points: list[dict[str, Any]] = [{"x_mm": x, "y_mm": y} for x, y in places.tolist()]
    if lengths is not None:
        read = rows(lengths, "lengths")
        same_count({"marks": len(points), "lengths": len(read)})
        for point, (left, right) in zip(points, read.tolist()):
            point.update(left_mm=left, right_mm=right)
    add_visits(points, commanded, order, "marks")
    return points


def add_visits(points: list[dict[str, Any]], commanded: Any, order: Any, rows_are: str) -> None:
    """Adds commanded places and visit numbers, if given."""
    if commanded is not None:
        sent = rows(commanded, "commanded")
        same_count({rows_are: len(points), "commanded places": len(sent)})
        for point, (x, y) in zip(points, sent.tolist()):
            point.update(commanded_x_mm=x, commanded_y_mm=y)
    if order is not None:
        numbers = [int(number) for number in order]
        same_count({rows_are: len(points), "orders": len(numbers)})
        for point, number in zip(points, numbers):
            point["order"] = number


def _end(end: Any) -> Any:
    """A name, a number, or a place as (x, y)."""
    if isinstance(end, str):
        return end
    if numpy.ndim(end) == 1:
        x, y = end
        return {"x_mm": float(x), "y_mm": float(y)}
    return int(end)


def distance_of(one: tuple[Any, ...]) -> dict[str, Any]:
    """(from, to, mm) or (from, to, mm, sigma) as an entry of "distances"."""
    if len(one) not in (3, 4):
        raise ValueError(f"a distance is (from, to, mm) or (from, to, mm, sigma), not {one!r}")
    start, end, *numbers = one
    values = dict(zip(("distance_mm", "sigma_mm"), (float(number) for number in numbers)))
    return {"from": _end(start), "to": _end(end), **values}
