# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots with matplotlib, where it is installed. Each public function is the method `plot` of a class: it takes
axes to draw on, or makes them, and gives them back; places are in mm, x to the right, y up."""

from __future__ import annotations

from typing import Any, Iterable

import numpy

from ._records import needed

_MOST_BARS = 12
"""More rows cannot be read."""

BEFORE = "#d55e00"
"""As it is. The colours of every chart of the reports, tools/report/bed_chart.hpp."""
AFTER = "#0072b2"
"""With the map."""
NEUTRAL = "#8a94a3"
"""A reference."""
_EXPECTED_ERROR = "YlGnBu"
"""From little to much, from yellow to blue as error_map.vg.json has it."""


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    return needed("matplotlib", "A plot", "matplotlib.pyplot").subplots()[1]


def _bed_axes(ax: Any, title: str) -> Any:
    axes = _axes(ax)
    axes.set(aspect="equal", xlabel="x, mm", ylabel="y, mm", title=title)
    return axes


def _coloured(axes: Any, drawn: Any) -> None:
    axes.figure.colorbar(drawn, ax=axes, label="one sigma, mm", orientation="horizontal")


def _places(entries: Iterable[dict[str, Any]], before: str = "") -> numpy.ndarray:
    """(n, 2) array: x and y of the entries that have both."""
    x, y = f"{before}x_mm", f"{before}y_mm"
    return numpy.array([(one[x], one[y]) for one in entries if x in one and y in one]).reshape(-1, 2)


def machine(of: Any, ax: Any = None) -> Any:
    """Plots bed and motors with matplotlib; returns the axes."""
    contents = of.to_dict()
    axes = _bed_axes(ax, of.name)
    wide, high = contents["bed"]["width_mm"] / 2, contents["bed"]["height_mm"] / 2
    axes.plot([-wide, wide, wide, -wide, -wide], [-high, -high, high, high, -high])
    axes.scatter(*_places(contents["motors"].values()).T, marker="o")
    return axes


def grid(of: Any, ax: Any = None) -> Any:
    """Plots the marks, with arrows from the commanded places; returns the axes."""
    marks, commanded = of.marks, of.commanded
    arrows = "" if commanded is None else ", arrows not to scale"
    axes = _bed_axes(ax, f"{len(marks)} points{arrows}")
    axes.scatter(*marks.T, marker="+")
    if commanded is not None:
        axes.quiver(*commanded.T, *(marks - commanded).T, angles="xy", color=BEFORE)
    return axes


def holes(of: Any, ax: Any = None) -> Any:
    """Plots the holes and the distances between them; returns the axes."""
    contents, places = of.to_dict(), of.commanded
    names = [hole.get("name", str(number)) for number, hole in enumerate(contents["holes"])]
    numbers = {name: number for number, name in enumerate(names)}
    axes = _bed_axes(ax, f"{len(names)} holes")
    for distance in contents["distances"]:
        ends = [numbers.get(distance[end], distance[end]) for end in ("from", "to")]
        if all(isinstance(end, int) for end in ends):  # an edge is no place
            axes.plot(*places[ends].T, color=NEUTRAL, linewidth=0.8)
    for name, place in zip(names, places):
        axes.annotate(name, place)
    axes.scatter(*places.T, marker="o")
    return axes


def belts(of: Any, ax: Any = None) -> Any:
    """Plots the anchors and the places; returns the axes. Anchors count from the bottom left one, commanded
    places from where the frame's diagonals cross."""
    contents = of.to_dict()
    contents = contents.get("fit", contents)
    corners = _places(contents.get("machine", {}).get("anchors", {}).values())
    axes = _bed_axes(ax, "Four belts")
    if is_whole := len(corners) == 4:
        axes.scatter(*corners.T, marker="s")
    places = _places(contents.get("places", []))
    if "places" not in contents:
        places = _places(contents.get("points", []), "commanded_") + (_crossing(corners) if is_whole else 0.0)
    if places.size:
        axes.scatter(*places.T, marker="+")
    return axes


def _crossing(corners: numpy.ndarray) -> numpy.ndarray:
    """Where the diagonals cross: tl + s (br - tl) = tr + t (bl - tr)."""
    top_left, top_right, bottom_left, bottom_right = corners
    sides = numpy.column_stack([bottom_right - top_left, top_right - bottom_left])
    along, _ = numpy.linalg.solve(sides, top_right - top_left)
    return top_left + along * (bottom_right - top_left)


def calibration(of: Any, ax: Any = None) -> Any:
    """Plots the tool's expected error over the bed, at 60 by 30 places, and the points; returns the axes."""
    contents = of.to_dict()
    domain = contents["domain_mm"]
    x = numpy.linspace(domain["x_min"], domain["x_max"], 60)
    y = numpy.linspace(domain["y_min"], domain["y_max"], 30)
    sigma = of.query(numpy.stack(numpy.meshgrid(x, y), axis=-1)).tool_sigma
    axes = _bed_axes(ax, f"{of.name}: expected error of the tool")
    _coloured(axes, axes.pcolormesh(x, y, sigma, shading="nearest", cmap=_EXPECTED_ERROR))
    axes.scatter(*_places(contents["points"]).T, marker="+", color="black")
    return axes


def lengths(of: Any, ax: Any = None) -> Any:
    """Plots the places, coloured by the tool's sigma; returns the axes."""
    axes = _bed_axes(ax, "Expected error of the tool")
    places = of.points.reshape(-1, 2)
    _coloured(axes, axes.scatter(*places.T, c=of.tool_sigma.reshape(-1), cmap=_EXPECTED_ERROR))
    return axes


def probabilities(of: Any, ax: Any = None) -> Any:
    """Plots the most probable hypotheses, the first on top; returns the axes."""
    axes = _axes(ax)
    shown = sorted(of.hypotheses, key=lambda one: one["probability"], reverse=True)[:_MOST_BARS]
    rows = range(len(shown))
    axes.barh(rows, [one["probability"] for one in shown], color=AFTER)
    axes.set_yticks(rows, [_name(one) for one in shown])
    axes.invert_yaxis()
    axes.set_xlabel("probability")
    return axes


def _name(hypothesis: dict[str, Any]) -> str:
    """Its cause, or what has changed, the side, and the number of a bad point, from 1."""
    words = [hypothesis.get(key) for key in ("effect", "what", "side")]
    number = str(hypothesis["point"] + 1) if "point" in hypothesis else ""
    return " ".join(filter(None, [*words, number])).replace("_", " ")


def plan(of: Any, ax: Any = None) -> Any:
    """Plots the places in the order of the visits; returns the axes."""
    visits = of.marks[of.visits]
    axes = _bed_axes(ax, f"{len(visits)} visits")
    axes.plot(*visits.T, color=NEUTRAL, linewidth=0.8)
    axes.scatter(*visits.T, marker="+", color=AFTER)
    axes.annotate("1", visits[0])
    return axes


def path(of: Any, ax: Any = None) -> Any:
    """Plots the path, rapids pale, with arrows for how far each end is moved (not to scale); returns the axes."""
    axes = _bed_axes(ax, "Path, and how far each command is moved")
    for piece in of.pieces:
        axes.plot(piece[[2, 4]], piece[[3, 5]], color=NEUTRAL if piece[1] else AFTER, linewidth=0.8)
    axes.quiver(*of.pieces[:, [4, 5, 8, 9]].T, color=BEFORE)
    return axes


def sweep(of: Any, ax: Any = None) -> Any:
    """Plots the tool's error over the number of points, a line for each level of the factors that have several;
    returns the axes."""
    axes = _axes(ax)
    lines: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for error in of.errors:
        line = lines.setdefault((error["factor"], error["level"]), [])
        line.append((error["points"], error["tool_rms_mm"]))
    factors = [factor for factor, _ in lines if factor != "grid"]
    several = [factor for factor in factors if factors.count(factor) > 1] or factors[:1]
    for (factor, level), line in lines.items():
        if factor in several:
            axes.plot(*zip(*sorted(line)), marker="o", label=f"{factor} {level}")
    axes.set(xlabel="points", ylabel="error of the tool, rms, mm")
    axes.legend()
    return axes
