#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of docs/methods.md are those of the code: a constant that it names has the value that its source has.

Usage: methods.py ROOT. A constant stands there as "| `kName` | value |" or as "`kName` = value", a probability of
model/mechanism_change.hpp as "`name` = value"; all of grid/diagnosis/constants.hpp must stand there but for the limits
of the search.
"""

import pathlib
import re
import sys

VALUE = r"\d[\d.]*(?:e-?\d+)?(?: / \d[\d.]*)?"
DEFINED = re.compile(rf"\b(k[A-Z]\w+)(?: = |, )({VALUE})(?=;|,)")
CHANGE = re.compile(rf"^  double (\w+) = ({VALUE});", re.M)
NAMED = re.compile(rf"`(\w+)`(?: \| | = )({VALUE})(?= |,|;|$)", re.M)
PRIORS = re.compile(r"\A.*?(?=^// How far is searched)", re.S | re.M)


def number(text):
    """Of a literal, or of one literal divided by another."""
    over, _, under = text.partition("/")
    return float(over) / (float(under) if under else 1.0)


def defined_in(root):
    found = {}
    for folder in ("grid", "model"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in (".hpp", ".cpp", ".def"):
                for name, value in DEFINED.findall(file.read_text(encoding="utf-8")):
                    found.setdefault(name, set()).add(number(value))
    changes = (root / "model/mechanism_change.hpp").read_text(encoding="utf-8")
    for name, value in CHANGE.findall(changes[changes.index("struct ChangePriors") :]):
        found[name] = {number(value)}
    return found


def problems_of(root):
    page = (root / "docs/methods.md").read_text(encoding="utf-8")
    constants = defined_in(root)
    named = {name: value.strip() for name, value in NAMED.findall(page)}
    for name, value in named.items():
        if constants.get(name, set()) != {number(value)}:
            yield f"docs/methods.md: {name} is {value} there, in the sources {sorted(constants.get(name, []))}"
    definitions = PRIORS.match((root / "grid/diagnosis/constants.hpp").read_text(encoding="utf-8")).group(0)
    for name in re.findall(r"^inline constexpr [\w:]+ (k\w+) =", definitions, re.M):
        if name not in named:
            yield f"docs/methods.md does not give {name} of grid/diagnosis/constants.hpp"
    if len(named) < 20:
        yield f"docs/methods.md names {len(named)} constants only: is it read as it is written?"


problems = list(problems_of(pathlib.Path(sys.argv[1])))
for problem in problems:
    print(problem)
sys.exit(1 if problems else 0)
