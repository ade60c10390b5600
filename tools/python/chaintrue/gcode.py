# SPDX-License-Identifier: GPL-3.0-or-later
"""G-code: programs compensated with a map, and run on a simulated machine.

    program = pathlib.Path("part.nc")
    done = chaintrue.gcode.compensate(program, calibration)
    done.write("part.true.nc")
    chaintrue.gcode.verify(program, done, calibration).holds

A program is a path, or its text where that has more than one line. Options that both functions take:

    tolerance_mm           how far the tool may stray from the path
    decimals               of the output's coordinates
    largest_correction_mm, steepest_correction
                           larger corrections are refused, and changes above this in mm per mm
    frame                  marks or bed: what the program's X and Y count in
    home                   (x, y), mm: added to them
    controller             maslow_classic, holey, fluidnc_wallplotter, ideal or maslow4; empty: the map's
    machine, settings      paths: the machine that the controller believes in, or what it holds now
    keep_rapids_whole, home_is_zero, skip_deletable, tools_have_no_diameter
                           as `chaintrue gcode compensate --help` says
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from typing import Any, Callable, Optional, Union

import numpy
from numpy.typing import NDArray

from . import _core, _plots
from ._base import PathLike, facts_table, in_words, one_of
from ._errors import GcodeError, GcodeProblem
from ._maps import Anchors, Map
from ._run import File, run

__all__ = ["Compensated", "GcodeError", "GcodeProblem", "Verification", "compensate", "verify"]


@dataclasses.dataclass(frozen=True, eq=False)
class Compensated:
    """A program whose commands move the tool along the path that another one means.

    text         the program
    moves, commands, path_mm
                 how many it had and has, and how long its path is
    largest_correction_mm, largest_correction_line
                 how far a command is moved at most, and on which line
    strays_mm    how far the tool leaves the path on a simulated machine; None: not run
    expected_mm  error of the tool to expect along the cuts, one sigma; None: the map does not know
    notes        (line, name, sentence) of what is odd and goes through
    pieces       (n, 10) array: line, 1 for a rapid, start x and y, end x and y, correction at the start
                 x and y, at the end x and y; mm. Of a long program every second, fourth ... piece
    """

    text: str
    moves: int
    commands: int
    path_mm: float
    largest_correction_mm: float
    largest_correction_line: int
    strays_mm: Optional[float]
    expected_mm: Optional[float]
    notes: list[tuple[int, str, str]]
    pieces: NDArray[numpy.float64]

    def write(self, path: PathLike) -> None:
        """Writes the program atomically."""
        _core.write(os.fspath(path), self.text.encode("utf-8", "surrogateescape"))

    plot = _plots.path

    def _facts(self) -> dict[str, Any]:
        facts = {
            "moves": self.moves,
            "commands": self.commands,
            "mm largest correction": f"{self.largest_correction_mm:.2f}",
        }
        if self.strays_mm is not None:
            facts["mm from the path on the simulated machine"] = f"{self.strays_mm:.3f}"
        if self.expected_mm is not None:
            facts["mm error of the tool to expect"] = f"{self.expected_mm:.2f}"
        return facts

    def __repr__(self) -> str:
        return f"<chaintrue.gcode.Compensated: {in_words(self._facts())}>"

    def _repr_html_(self) -> str:
        return facts_table("Compensated program", self._facts())


@dataclasses.dataclass(frozen=True)
class Verification:
    """What a program does on a simulated machine, against the path that another one means.

    holds             the tool stays on the path, at the intended feeds, with every word at its place
    largest_mm, line  how far it strays at most, and on which line of the original
    feeds_mm, rapids_mm
                      the same of cuts and of rapids
    uncompensated_mm  how far the original itself would stray; None: it cannot be run
    expected_mm       error of the tool to expect along the cuts, one sigma; None: not known
    tick_overshoot_mm by how much the controller overshoots every move, as in every file
    commands          how many were run
    fault             the first fault, a sentence; empty where it holds
    """

    holds: bool
    largest_mm: float
    line: int
    feeds_mm: float
    rapids_mm: float
    uncompensated_mm: Optional[float]
    expected_mm: Optional[float]
    tick_overshoot_mm: float
    commands: int
    fault: str

    def __bool__(self) -> bool:
        return self.holds

    def _repr_html_(self) -> str:
        return facts_table("Verification", dataclasses.asdict(self))


def compensate(
    program: Union[str, PathLike],
    calibration: Union[Map, Anchors],
    *,
    verified: bool = True,
    force: bool = False,
    **options: Any,
) -> Compensated:
    """The program whose commands move the tool along the given program's path.

    verified  run it on the simulated machine, and fail where it does not hold its tolerance
    force     even with a map that is not to be cut with

    Raises GcodeError with every line that cannot be compensated, Failure where the result would not
    hold.
    """
    words = ["gcode", "compensate", _file(program, "program.nc"), *_words(calibration, options)]
    words += ["--no-verify"] * (not verified) + ["--force"] * force
    files, answer, _ = run(*words, "-o", _OUTPUT, "--json", out=[_OUTPUT])
    found = json.loads(answer)
    return Compensated(
        text=files[_OUTPUT],
        notes=[tuple(note.values()) for note in found.pop("notes")],
        pieces=numpy.array(found.pop("pieces"), dtype=numpy.float64).reshape(-1, 10),
        **{key: found[key] for key in _keys(Compensated) & found.keys()},
    )


def verify(
    program: Union[str, PathLike],
    compensated: Union[str, PathLike, Compensated],
    calibration: Union[Map, Anchors],
    **options: Any,
) -> Verification:
    """Compares the compensated program on a simulated machine with the original's path."""
    ran = compensated.text if isinstance(compensated, Compensated) else compensated
    files = [_file(program, "program.nc"), _file(ran, "compensated.nc")]
    _, answer, _ = run("gcode", "verify", *files, *_words(calibration, options), "--json")
    found = json.loads(answer)
    found["line"] = found["original_line"]
    return Verification(**{key: found[key] for key in _keys(Verification)})


_OUTPUT = "output.nc"
_FRAMES = ("marks", "bed")
_CONTROLLERS = ("maslow_classic", "holey", "fluidnc_wallplotter", "ideal", "maslow4")
_OPTIONS: dict[str, Callable[[Any], Any]] = {
    "tolerance_mm": str,
    "decimals": str,
    "largest_correction_mm": str,
    "steepest_correction": str,
    "frame": lambda word: one_of(word, "frame", _FRAMES),
    "controller": lambda word: one_of(word, "controller", _CONTROLLERS),
    "home": lambda place: ",".join(map(str, place)),
    "machine": os.fspath,
    "settings": os.fspath,
    "keep_rapids_whole": bool,
    "home_is_zero": bool,
    "skip_deletable": bool,
    "tools_have_no_diameter": bool,
}
"""How the command's option of the same name is written; True and False of one without a value."""


def _words(calibration: Union[Map, Anchors], options: dict[str, Any]) -> list[Union[str, File]]:
    """Calibration and options as arguments of the command."""
    if not isinstance(calibration, (Map, Anchors)):
        raise TypeError(f"programs are compensated with a Map or Anchors, not {calibration!r}")
    words: list[Union[str, File]] = ["--map", calibration._file]
    for name, value in options.items():
        if name not in _OPTIONS:
            raise TypeError(f"there is no option {name}, but {', '.join(_OPTIONS)}")
        written = _OPTIONS[name](value)
        word = "--block-delete" if name == "skip_deletable" else f"--{name.replace('_', '-')}"
        words += [word] * written if isinstance(written, bool) else [f"{word}={written}"]
    return words


def _file(program: Union[str, PathLike], name: str) -> File:
    """The program's file; `name` for a text."""
    if isinstance(program, str) and "\n" in program:
        return File(name, program)
    path = pathlib.Path(program)
    return File(path.name, path.read_bytes().decode("utf-8", "surrogateescape"))


def _keys(kind: type) -> set[str]:
    return {field.name for field in dataclasses.fields(kind)}
