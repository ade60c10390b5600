# SPDX-License-Identifier: GPL-3.0-or-later
"""Why a machine errs."""

from __future__ import annotations

from typing import Any, Optional

from . import _core, _plots
from ._base import Made, PathLike, read_made, sources_of, told
from ._maps import Measured, sorted_out
from ._measured import Grid, Machine
from ._records import Record, Records, records


class Cause(Record):
    """A cause: a dictionary, and each key an attribute."""

    effect: str
    """Its name in the catalogue (chaintrue effects): chain_pitch_error."""
    side: Optional[str]
    """left, right, both, x, y, a belt; None of the whole machine."""
    probability: float
    parameters: Record
    """Each with value and sigma, in the unit that its name ends in."""


class Diagnosis(Made):
    """Why a machine errs, and how sure that is (docs/diagnosis.md)."""

    _parse = staticmethod(_core.parse_diagnosis)

    @property
    def sentence(self) -> str:
        """The answer."""
        return self._core.sentence

    @property
    def verdict(self) -> str:
        """named, named_set, several_causes, unknown_pattern, noise_larger_than_stated, bad_points or
        nothing_found."""
        return self.to_dict()["verdict"]

    @property
    def what_to_do(self) -> list[str]:
        """What to do now, a sentence each."""
        return self.to_dict().get("what_to_do", [])

    @property
    def causes(self) -> Records:
        """The causes named, the most probable first: a Cause each. causes.to_frame() is their table."""
        return records(self.to_dict()["causes"], Cause)

    @property
    def hypotheses(self) -> Records:
        """Everything that was weighed, with its probability: effect, side, probability."""
        return records(self.to_dict()["hypotheses"])

    @property
    def next_measurements(self) -> Records:
        """What to measure next, the most telling first."""
        return records(self.to_dict().get("next_measurements", []))

    @property
    def held_out(self) -> Optional[Record]:
        """How well the result predicts another Grid, mm; None where none was given."""
        return Record.of(self.to_dict().get("held_out_grid"))

    @property
    def machine(self) -> Optional[Machine]:
        """The Machine with what was found in it: what to fit on. None of four belts."""
        return None if self._core.of_belts else Machine(self._core.machine)

    def to_frame(self) -> Any:
        """causes.to_frame(): a pandas.DataFrame. Raises MissingPackage without pandas."""
        return self.causes.to_frame()

    def plot(self, ax: Any = None) -> Any:
        """The probabilities of what was weighed; the axes are given back."""
        return _plots.probabilities(self.hypotheses, "effect", ax)

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
    options = {"--seed": None if seed == 1 else seed}
    sources = sources_of(*measured, held_out)
    if not belts:
        core = _core.diagnose(grids, holes, seed, gain, None if held_out is None else held_out._core)
    elif len(belts) > 1 or grids or holes:
        raise ValueError("Belts are diagnosed by themselves, one at a time")
    else:
        core = _core.diagnose_belts(belts[0], seed)
    return Diagnosis._made(core, "diagnose", options, sources)


def read_diagnosis(path: PathLike) -> Diagnosis:
    """The Diagnosis of a chaintrue_diagnosis file."""
    return told(read_made(path, Diagnosis), Diagnosis)
