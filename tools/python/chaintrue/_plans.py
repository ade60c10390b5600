# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans: where to measure."""

from __future__ import annotations

import dataclasses
import json
import os
from typing import Any, Iterable, Optional, Union

import numpy
from numpy.typing import NDArray

from . import _core, _plots
from ._base import PathLike, facts_table, in_words, one_of
from ._diagnosis import Diagnosis
from ._maps import Map, Measured, sorted_out, things_of
from ._measured import Machine
from ._records import Records, records
from ._run import run


_USUAL_DEPTH_MM = 3.0


@dataclasses.dataclass(frozen=True, eq=False)
class Plan:
    """Where to measure, and what a person takes to the machine.

    marks    (n, 2) array, mm: the places
    visits   numbers of the marks in the order of the visits; some come twice
    table    a CSV with empty cells for what is read; read_grid and read_holes take it once it is
             filled in; after a diagnosis the lines that are to be added to its file
    sheet    the same as JSON, with the machine in it; after a diagnosis without it
    page     the same as a page to print; after a diagnosis a list, as text
    program  G-code that drives to the places, or drills them; none after a diagnosis
    drawing  an SVG
    expected_rms_mm, expected_largest_mm
             error of the tool that such a map will have, one sigma; None of a plan of a check
    expected_sigmas
             of a plan of a check: by how many sigmas links of the left and of the right chain would
             stand out that have grown as they usually do
    """

    marks: NDArray[numpy.float64]
    visits: list[int]
    table: str
    sheet: str
    page: str
    program: str
    drawing: str
    expected_rms_mm: Optional[float] = None
    expected_largest_mm: Optional[float] = None
    expected_sigmas: Optional[tuple[float, float]] = None

    def __len__(self) -> int:
        return len(self.marks)

    def __repr__(self) -> str:
        return f"<chaintrue.Plan: {in_words(self._facts())}>"

    def write(self, path: PathLike) -> None:
        """Writes the table: as JSON where the file is called .json, as CSV otherwise."""
        name = os.fspath(path)
        _core.write(name, self.sheet if name.endswith(".json") else self.table)

    def to_records(self) -> Records:
        """A record for each visit: x_mm, y_mm, and the number of the mark."""
        return records(
            {"mark": number, "x_mm": self.marks[number, 0], "y_mm": self.marks[number, 1]}
            for number in self.visits
        )

    def to_frame(self) -> Any:
        """to_records().to_frame(): a pandas.DataFrame. Raises MissingPackage without pandas."""
        return self.to_records().to_frame()

    plot = _plots.plan

    def _facts(self) -> dict[str, Any]:
        facts: dict[str, Any] = {"places": len(self), "visits": len(self.visits)}
        if self.expected_rms_mm is not None:
            facts["mm expected, rms"] = f"{self.expected_rms_mm:.2f}"
        return facts

    def _repr_html_(self) -> str:
        return facts_table("Plan", self._facts()) + self.drawing


def plan(
    of: Union[Machine, Map, Measured, Iterable[Measured]],
    points: Optional[int] = None,
    *,
    after: Optional[Diagnosis] = None,
    holes: Optional[int] = None,
    distances: int = 0,
    edges: bool = False,
    second_visits: int = 0,
    margin_mm: Optional[float] = None,
    length_noise_mm: Optional[float] = None,
    position_noise_mm: Optional[float] = None,
    tape_sigma_mm: float = 0.5,
    hole_sigma_mm: float = 0.3,
    measure: str = "",
    drill_depth_mm: float = _USUAL_DEPTH_MM,
) -> Plan:
    """Where to measure. Of a Machine: so many points (28), or holes and a tape's distances. Of a Map:
    the few points (5) that tell best whether it still holds. Of what was measured, after its
    Diagnosis: what to measure next, the most telling first; no other option goes with it.

    distances      with holes: how many; 0: twice the holes and two more, with edges six more
    edges          with holes: measure to the sheet's edges as well
    second_visits  so many marks come a second time; of points
    margin_mm      from the bed's edge to the outermost places; None: what a sled needs
    length_noise_mm, position_noise_mm
                   one sigma of a reading, and of a mark's place; of points
    tape_sigma_mm, hole_sigma_mm
                   with holes: one sigma of the tape, and of a hole's place
    measure        places: where the tool stood; lengths: both chains; empty: what the controller tells
    drill_depth_mm of the program
    """
    if after is not None:
        return _plan_after(of, after)
    if not isinstance(of, (Machine, Map)):
        raise TypeError("a plan is of a Machine or a Map; of what was measured, give its Diagnosis: after")
    one_of(measure, "measure", ("", "places", "lengths"))
    if holes is not None and points is not None:
        raise ValueError("give points or holes, not both")
    asked = {
        "points": points,
        "holes": holes,
        "distances": distances or None,
        "second-visits": second_visits or None,
        "margin-mm": margin_mm,
        "length-noise-mm": length_noise_mm,
        "position-noise-mm": position_noise_mm,
        "tape-sigma-mm": None if holes is None else tape_sigma_mm,
        "hole-sigma-mm": None if holes is None else hole_sigma_mm,
        "measure": measure or None,
    }
    words = ["plan", "--check" if isinstance(of, Map) else "--machine", of._file]
    words += [f"--{name}={value}" for name, value in asked.items() if value is not None]
    words += ["--edges"] * edges
    depth = [] if drill_depth_mm == _USUAL_DEPTH_MM else [f"--depth-mm={drill_depth_mm}"]
    sheet, page, program, drawing = "sheet.json", "page.html", "program.nc", "drawing.svg"
    outputs = ["--page", page, "--gcode", program, "--svg", drawing]
    made, table, _ = run(*words, *outputs, *depth, out=[page, program, drawing])
    listed, answer, _ = run(*words, "-o", sheet, "--json", out=[sheet])
    found = json.loads(answer)
    return Plan(
        marks=numpy.array(found.pop("marks")),
        table=table,
        sheet=listed[sheet],
        page=made[page],
        program=made[program],
        drawing=made[drawing],
        **found,
    )


def _plan_after(measured: Any, found: Diagnosis) -> Plan:
    if isinstance(measured, (Machine, Map)):
        raise TypeError("after a diagnosis a plan is of what was diagnosed: Grids, Holes or Belts")
    grids, holes, belts = sorted_out(things_of(measured), "plan")
    if belts and (len(belts) > 1 or grids or holes):
        raise ValueError("Belts are diagnosed by themselves, one at a time")
    texts = [thing._text for thing in (*grids, *holes, *belts)]
    plan = _core.plan_after(found._text, texts)
    marks = numpy.array(plan.pop("marks")).reshape(-1, 2)
    return Plan(marks=marks, visits=list(range(len(marks))), program="", **plan)
