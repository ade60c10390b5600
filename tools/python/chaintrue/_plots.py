# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots with matplotlib, where it is installed. Each takes axes to draw on, or makes them, and gives
them back; places are in mm, x to the right, y up."""

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
    axes.set_aspect("equal")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("y, mm")
    axes.set_title(title)
    return axes


def _coloured(axes: Any, drawn: Any, label: str) -> None:
    axes.figure.colorbar(drawn, ax=axes, label=label, orientation="horizontal")


def machine(contents: dict[str, Any], ax: Any) -> Any:
    axes = _bed_axes(ax, contents.get("name", ""))
    wide, high = contents["bed"]["width_mm"] / 2, contents["bed"]["height_mm"] / 2
    axes.plot([-wide, wide, wide, -wide, -wide], [-high, -high, high, high, -high])
    motors = contents["motors"].values()
    axes.scatter([motor["x_mm"] for motor in motors], [motor["y_mm"] for motor in motors], marker="o")
    return axes


def grid(marks: numpy.ndarray, commanded: Any, ax: Any) -> Any:
    arrows = "" if commanded is None else ", arrows not to scale"
    axes = _bed_axes(ax, f"{len(marks)} points{arrows}")
    axes.scatter(marks[:, 0], marks[:, 1], marker="+")
    if commanded is not None:
        off = marks - commanded
        axes.quiver(commanded[:, 0], commanded[:, 1], off[:, 0], off[:, 1], angles="xy", color=BEFORE)
    return axes


def holes(contents: dict[str, Any], ax: Any) -> Any:
    places = {}
    for number, hole in enumerate(contents["holes"]):
        places[number] = places[hole.get("name", str(number))] = (hole["x_mm"], hole["y_mm"])
    axes = _bed_axes(ax, f"{len(contents['holes'])} holes")
    for distance in contents["distances"]:
        ends = [places.get(distance["from"]), places.get(distance["to"])]
        if None not in ends:  # an edge is no place
            axes.plot(*zip(*ends), color=NEUTRAL, linewidth=0.8)
    for number, hole in enumerate(contents["holes"]):
        axes.annotate(hole.get("name", str(number)), places[number])
    axes.scatter(*zip(*(places[number] for number in range(len(contents["holes"])))), marker="o")
    return axes


def belts(contents: dict[str, Any], ax: Any) -> Any:
    """Of a chaintrue_belts file or of a fit: anchors count from the bottom left one, places of a file
    from where the frame's diagonals cross."""
    anchors = contents.get("machine", {}).get("anchors", {})
    corners = [
        (at["x_mm"], at["y_mm"]) for at in anchors.values() if "x_mm" in at and "y_mm" in at
    ]
    axes = _bed_axes(ax, "Four belts")
    if len(corners) == 4:
        axes.scatter(*zip(*corners), marker="s")
    if "places" in contents:
        places = [(place["x_mm"], place["y_mm"]) for place in contents["places"]]
    else:
        middle = _crossing(corners) if len(corners) == 4 else numpy.zeros(2)
        places = [
            (point["commanded_x_mm"] + middle[0], point["commanded_y_mm"] + middle[1])
            for point in contents.get("points", [])
            if "commanded_x_mm" in point
        ]
    if places:
        axes.scatter(*zip(*places), marker="+")
    return axes


def _crossing(corners: list[tuple[float, float]]) -> numpy.ndarray:
    """Where the diagonals cross: tl + s (br - tl) = tr + t (bl - tr)."""
    top_left, top_right, bottom_left, bottom_right = numpy.array(corners)
    sides = numpy.column_stack([bottom_right - top_left, top_right - bottom_left])
    along, _ = numpy.linalg.solve(sides, top_right - top_left)
    return top_left + along * (bottom_right - top_left)


def calibration(map: Any, ax: Any) -> Any:
    """The expected error over the domain, at 60 by 30 places, and the measured points."""
    contents = map.to_dict()
    domain = contents["domain_mm"]
    x = numpy.linspace(domain["x_min"], domain["x_max"], 60)
    y = numpy.linspace(domain["y_min"], domain["y_max"], 30)
    sigma = map.query(numpy.stack(numpy.meshgrid(x, y), axis=-1)).tool_sigma
    axes = _bed_axes(ax, f"{map.name}: expected error of the tool")
    _coloured(axes, axes.pcolormesh(x, y, sigma, shading="nearest", cmap=_EXPECTED_ERROR), "one sigma, mm")
    points = contents["points"]
    axes.scatter([p["x_mm"] for p in points], [p["y_mm"] for p in points], marker="+", color="black")
    return axes


def lengths(answer: Any, ax: Any) -> Any:
    places = answer.points.reshape(-1, 2)
    axes = _bed_axes(ax, "Expected error of the tool")
    drawn = axes.scatter(places[:, 0], places[:, 1], c=answer.tool_sigma.reshape(-1), cmap=_EXPECTED_ERROR)
    _coloured(axes, drawn, "one sigma, mm")
    return axes


def probabilities(hypotheses: Iterable[dict[str, Any]], key: str, ax: Any) -> Any:
    """The most probable causes, the first on top."""
    axes = _axes(ax)
    shown = sorted(hypotheses, key=lambda one: one["probability"], reverse=True)[:_MOST_BARS]
    names = [" ".join(filter(None, (one[key], one.get("side"), _point(one)))) for one in shown]
    axes.barh(range(len(shown)), [one["probability"] for one in shown], color=AFTER)
    axes.set_yticks(range(len(shown)))
    axes.set_yticklabels([name.replace("_", " ") for name in names])
    axes.invert_yaxis()
    axes.set_xlabel("probability")
    return axes


def _point(hypothesis: dict[str, Any]) -> str:
    """Of a bad point its number, from 1."""
    return str(hypothesis["point"] + 1) if "point" in hypothesis else ""


def plan(visits: numpy.ndarray, ax: Any) -> Any:
    axes = _bed_axes(ax, f"{len(visits)} visits")
    axes.plot(visits[:, 0], visits[:, 1], color=NEUTRAL, linewidth=0.8)
    axes.scatter(visits[:, 0], visits[:, 1], marker="+", color=AFTER)
    axes.annotate("1", visits[0])
    return axes


def path(pieces: numpy.ndarray, ax: Any) -> Any:
    """Cuts drawn through, rapids pale, arrows for how far each end is moved (not to scale)."""
    axes = _bed_axes(ax, "Path, and how far each command is moved")
    for piece in pieces:
        axes.plot(piece[[2, 4]], piece[[3, 5]], color=NEUTRAL if piece[1] else AFTER, linewidth=0.8)
    axes.quiver(pieces[:, 4], pieces[:, 5], pieces[:, 8], pieces[:, 9], color=BEFORE)
    return axes


def sweep(errors: Iterable[dict[str, Any]], ax: Any) -> Any:
    """A line for each level of a factor that has several; the number of points is the x axis."""
    axes = _axes(ax)
    lines: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for error in errors:
        line = lines.setdefault((error["factor"], error["level"]), [])
        line.append((error["points"], error["tool_rms_mm"]))
    factors = [factor for factor, _ in lines if factor != "grid"]
    several = [factor for factor in factors if factors.count(factor) > 1] or factors[:1]
    for (factor, level), line in lines.items():
        if factor in several:
            axes.plot(*zip(*sorted(line)), marker="o", label=f"{factor} {level}")
    axes.set_xlabel("points")
    axes.set_ylabel("error of the tool, rms, mm")
    axes.legend()
    return axes
