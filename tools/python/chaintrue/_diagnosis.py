# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnoses: the causes of a machine's errors."""

from __future__ import annotations

from typing import Any, Optional

from . import _plots
from ._base import Made, PathLike, from_file, inputs, key, sources_of
from ._maps import Measured, sorted_out
from ._measured import Grid, Machine, machine_in
from ._records import Record, Records, records


class Cause(Record):
    """A cause: a dictionary whose keys are attributes too."""

    effect: str
    """Its name in the catalogue (chaintrue effects): chain_pitch_error."""
    side: Optional[str]
    """left, right, both, x, y, a belt; None of the whole machine."""
    probability: float
    parameters: Record
    """Each with value and sigma, in the unit that its name ends in."""


class Diagnosis(Made):
    """The causes of a machine's errors and their probabilities (docs/diagnosis.md)."""

    name: str = key("grid_name", "What was diagnosed, as its file calls it.", missing="")
    sentence: str = key("sentence", "The answer.")
    verdict: str = key(
        "verdict",
        "named, named_set, several_causes, unknown_pattern, noise_larger_than_stated, bad_points or "
        "nothing_found.",
    )
    what_to_do: list[str] = key("what_to_do", "What to do now, a sentence each.", missing=[])
    causes: Records = key(
        "causes",
        "The causes named, the most probable first: a Cause each. causes.to_frame() is their table.",
        lambda causes: records(causes, Cause),
    )
    hypotheses: Records = key(
        "hypotheses",
        "Everything that was weighed, with its probability: effect, side, probability.",
        records,
    )
    next_measurements: Records = key(
        "next_measurements", "What to measure next, the most telling first.", records
    )
    held_out: Optional[Record] = key(
        "held_out_grid", "How well the result predicts another Grid, mm; None where none was given."
    )

    @property
    def machine(self) -> Optional[Machine]:
        """The Machine extended by the causes found, to fit on; None for four belts."""
        return machine_in(self._contents, "extended_machine")

    def to_frame(self) -> Any:
        """causes.to_frame(): a pandas.DataFrame. Raises MissingPackage without pandas."""
        return self.causes.to_frame()

    plot = _plots.probabilities

    def __repr__(self) -> str:
        return f"<chaintrue.Diagnosis {self.name!r}: {self.sentence}>"


def diagnose(
    *measured: Measured,
    seed: int = 1,
    gain: bool = True,
    held_out: Optional[Grid] = None,
) -> Diagnosis:
    """The Diagnosis of any mix of Grids and Holes of one machine; or of one Belts.

    seed  of the draws that chances are counted with; same input, same answer
    gain  also what naming the cause gains on points left out, which takes most of the time; not of
          Belts
    held_out  another Grid of the same machine: `held_out` then says how well the result predicts it;
              of one Grid
    """
    grids, holes, belts = sorted_out(measured, "diagnose")
    if held_out is not None and not isinstance(held_out, Grid):
        raise TypeError(f"held_out is a Grid, not {type(held_out).__name__}")
    if held_out is not None and (len(grids) != 1 or holes or belts):
        raise ValueError("held_out is predicted by what one Grid alone says")
    words = ["diagnose", *inputs(measured)]
    if seed != 1:
        words += ["--seed", str(seed)]
    if not gain and not belts:
        words += ["--no-gain"]
    if held_out is not None:
        words += ["--held-out", held_out._file]
    return Diagnosis._by(*words, sources=sources_of(*measured, held_out))


def read_diagnosis(path: PathLike) -> Diagnosis:
    """The Diagnosis of a chaintrue_diagnosis file."""
    return from_file(Diagnosis, path)
