# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors, with fields for a program and a sentence for a person."""

from __future__ import annotations

from typing import NamedTuple


class Problem(NamedTuple):
    """One problem in an input."""

    file: str
    """Its name, or "arrays"."""
    place: str
    """/points/3/x_mm, "line 4, column 12", or empty for the whole file."""
    value: str
    """As found; empty where something is missing."""
    expected: str
    """What was expected."""
    message: str
    """The whole problem in a sentence, with the likely mistake if it is recognised."""


class GcodeProblem(NamedTuple):
    """One problem in a refused program."""

    line: int
    """From 1; 0 is the file."""
    column: int
    """From 1; 0 is the whole line."""
    name: str
    """A stable name, such as bad_arc."""
    sentence: str


class InputError(ValueError):
    """Bad input, with every problem in it.

    problems  a Problem each
    """

    problems: list[Problem]

    def __init__(self, message: str, problems: list[tuple[str, str, str, str, str]] = ()):
        super().__init__(message)
        self.problems = [Problem(*problem) for problem in problems]


class Failure(RuntimeError):
    """A task that is impossible with valid input.

    sentence  what happened, and what to do
    reason    a stable name: no_machine, not_converged, unreachable ...; empty where there is none
    """

    sentence: str
    reason: str

    def __init__(self, sentence: str, reason: str = ""):
        super().__init__(sentence)
        self.sentence = sentence
        self.reason = reason


class GcodeError(Failure):
    """A refused program; nothing is written.

    problems  a GcodeProblem each
    """

    problems: list[GcodeProblem]

    def __init__(self, sentence: str, problems: list[tuple[int, int, str, str]] = ()):
        super().__init__(sentence, "bad_program")
        self.problems = [GcodeProblem(*problem) for problem in problems]


class MissingPackage(ImportError):
    """Another Python package is needed for this; its field `name` says which."""

    def __init__(self, package: str, purpose: str):
        super().__init__(
            f"{purpose} needs the Python package {package}, which is not installed. On Debian: "
            f"apt install python3-{package}",
            name=package,
        )
        self._given = (package, purpose)

    def __reduce__(self):
        return type(self), self._given
