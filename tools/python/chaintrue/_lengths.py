# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths that a map gives for places."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy
from numpy.typing import NDArray

from . import _plots
from ._records import Tabled


@dataclasses.dataclass(frozen=True, eq=False)
class Lengths(Tabled):
    """What a map says of places. A single place has no first axis: lengths are (2,), status is a word.

    points      (..., 2) array, mm: x and y as they were asked for
    names       what the lengths are of: left and right chain; of belts tl, tr, bl and br
    lengths     (..., 2) masked array, mm, or (..., 4) of belts
    sigma       (..., 2) masked array, mm: one sigma of the first two
    tool_sigma  (...) masked array, mm: one sigma of the tool's place
    status      (...) array of inside, edge, extrapolated, outside
    why         (...) array of sentences: why there is no answer; empty where there is one

    Each of names is an attribute as well: answer.left is answer.lengths[..., 0].
    """

    points: NDArray[numpy.float64]
    names: tuple[str, ...]
    lengths: numpy.ma.MaskedArray
    sigma: numpy.ma.MaskedArray
    tool_sigma: numpy.ma.MaskedArray
    status: Any
    why: Any

    @property
    def left(self) -> numpy.ma.MaskedArray:
        """(...) masked array, mm: the left chain, or the top left belt."""
        return self.lengths[..., 0]

    @property
    def right(self) -> numpy.ma.MaskedArray:
        """(...) masked array, mm: the right chain, or the top right belt."""
        return self.lengths[..., 1]

    @property
    def left_sigma(self) -> numpy.ma.MaskedArray:
        """(...) masked array, mm: one sigma of left."""
        return self.sigma[..., 0]

    @property
    def right_sigma(self) -> numpy.ma.MaskedArray:
        """(...) masked array, mm: one sigma of right."""
        return self.sigma[..., 1]

    def __getattr__(self, name: str) -> numpy.ma.MaskedArray:
        names = self.__dict__.get("names", ())
        if name not in names:
            raise AttributeError(f"there is no {name} here, but {', '.join(names)}")
        return self.lengths[..., names.index(name)]

    def __repr__(self) -> str:
        if self.points.ndim == 1:
            words = [f"{name} {length:.3f} mm" for name, length in zip(self.names, self.lengths)]
            told = f"{self.status}: {self.why}" if self.why else ", ".join([*words, self.status])
            return f"<chaintrue.Lengths: {told}>"
        answered = int((numpy.asarray(self.status) != "outside").sum())
        count = self.points.size // 2
        return f"<chaintrue.Lengths: {count} places, {answered} answered; {', '.join(self.names)}>"

    def __len__(self) -> int:
        return len(self.status) if isinstance(self.status, numpy.ndarray) else 1

    def columns(self) -> dict[str, list[Any]]:
        """A list for each column of to_frame(), None where there is no answer."""
        columns = {f"{axis}_mm": self.points[..., i] for i, axis in enumerate("xy")}
        columns |= {f"{name}_mm": self.lengths[..., i] for i, name in enumerate(self.names)}
        columns |= {f"{name}_sigma_mm": self.sigma[..., i] for i, name in enumerate(self.names[:2])}
        columns |= {"tool_sigma_mm": self.tool_sigma, "status": self.status}
        return {name: numpy.ma.reshape(column, -1).tolist() for name, column in columns.items()}

    plot = _plots.lengths


def masked(numbers: NDArray[numpy.float64]) -> numpy.ma.MaskedArray:
    """Zero and masked where they are none."""
    mask = numpy.isnan(numbers)
    return numpy.ma.array(numpy.where(mask, 0.0, numbers), mask=mask)


def answered(places: NDArray[numpy.float64], found: dict[str, Any]) -> Lengths:
    """The core's answer to places.reshape(-1, 2), in the shape of places."""
    shape = places.shape[:-1]
    status = numpy.array(found["status"]).reshape(shape)
    why = numpy.array(found["why"], dtype=object).reshape(shape)
    return Lengths(
        points=places,
        names=tuple(found["names"]),
        lengths=masked(found["lengths"].reshape(*shape, len(found["names"]))),
        sigma=masked(found["sigma"].reshape(*shape, 2)),
        tool_sigma=masked(found["tool_sigma"].reshape(shape)),
        status=status if shape else str(status[()]),
        why=why if shape else str(why[()]),
    )
