# SPDX-License-Identifier: GPL-3.0-or-later
"""Accuracy against the simulator over any product of factors."""

from __future__ import annotations

import csv
import json
import math
import os
import pathlib
import tempfile
import warnings
from typing import Any, Optional, Union

from . import _plots
from ._base import Paged, PathLike, text_of
from ._measured import Machine
from ._records import Records, records
from ._run import run

_FACTORS = ("machine", "effects", "used_on", "surface", "spacing", "jitter_mm", "noise_mm", "grid")
"""Columns of results.csv."""


class Sweep(Paged):
    """The results of a sweep.

    name, question  as its specification has them
    errors     records: factor, level, points, cells, tool_rms_mm, tool_max_mm; what one level of one
               factor comes to at one number of points, over all else
    results    records: each cell with its levels and its errors, as results.csv has them
    summary    what summary.json holds
    """

    def __init__(self, folder: pathlib.Path):
        with open(folder / "results.csv", newline="", encoding="utf-8") as table:
            lines = list(csv.DictReader(table))
        self.results: Records = records({key: _number(value) for key, value in line.items()} for line in lines)
        self.summary: dict[str, Any] = json.loads((folder / "summary.json").read_text("utf-8"))
        self.name: str = self.summary["name"]
        self.question: str = self.summary["question"]
        self.errors: Records = _errors_of(lines)
        self._page_text: str = (folder / "report.html").read_text("utf-8")

    def to_frame(self) -> Any:
        """results.to_frame(): a pandas.DataFrame. Raises MissingPackage without pandas."""
        return self.results.to_frame()

    plot = _plots.sweep

    def __len__(self) -> int:
        return len(self.results)

    def __repr__(self) -> str:
        return f"<chaintrue.Sweep {self.name!r}: {len(self)} cells>"


def sweep(
    specification: Union[PathLike, dict[str, Any]],
    folder: Optional[PathLike] = None,
    threads: int = 0,
) -> Sweep:
    """Runs a sweep and gives its results.

    specification  a chaintrue_sweep file, or its contents as a dictionary, in which a machine may be a
                   Machine: {"machines": [{"name": "mine", "machine": machine}], "grids": ["4x3"]}
    folder         keeps the finished cells: the same sweep goes on there; results.csv, summary.json
                   and a specification that was a dictionary are in it; None: nothing is kept
    threads        0: all cores
    """
    with tempfile.TemporaryDirectory(prefix="chaintrue-") as scratch:
        place = pathlib.Path(scratch) if folder is None else pathlib.Path(folder)
        place.mkdir(parents=True, exist_ok=True)
        path = _written(specification, place) if isinstance(specification, dict) else specification
        words = ["sweep", os.fspath(path), "-o", str(place), "--resume", "--threads", str(threads)]
        *assumed, _, _ = run(*words)[2].splitlines()
        for sentence in assumed:
            warnings.warn(sentence, stacklevel=2)
        return Sweep(place)


def _errors_of(cells: list[dict[str, str]]) -> Records:
    """The tool's error, pooled over all other factors, by factor, level and number of points."""
    found: dict[tuple[str, str, str], list[dict[str, str]]] = {}
    for factor in _FACTORS:
        for cell in cells:
            if cell["status"] == "done":
                found.setdefault((factor, cell[factor], cell["points"]), []).append(cell)
    return records(
        {
            "factor": factor,
            "level": level,
            "points": int(points),
            "cells": len(same),
            "tool_rms_mm": math.sqrt(sum(float(cell["tool_rms_mm"]) ** 2 for cell in same) / len(same)),
            "tool_max_mm": max(float(cell["tool_max_mm"]) for cell in same),
        }
        for (factor, level, points), same in found.items()
    )


def _written(contents: dict[str, Any], folder: pathlib.Path) -> pathlib.Path:
    """The specification as a file in the folder, and the machines that it holds beside it: the same
    names each time, since they are part of what a sweep is."""
    contents = {"name": "a sweep", **contents}
    machines = [dict(level) for level in contents.get("machines", [])]
    files: dict[str, str] = {}
    for number, level in enumerate(machines):
        for key in ("machine", "stated"):
            file_key = f"{key}_file"
            if isinstance(level.get(key), Machine):
                level[file_key] = f"{key}{number}.json"
                files[level[file_key]] = json.dumps(level.pop(key).to_dict())
            elif file_key in level:
                level[file_key] = str(pathlib.Path(level[file_key]).resolve())
    files["sweep.json"] = text_of({**contents, "machines": machines}, "chaintrue_sweep")
    for name, text in files.items():
        path = folder / name
        if path.exists() and path.read_text(encoding="utf-8") != text:
            raise ValueError(f"{folder} holds another sweep: its {name} differs; take a new folder")
        path.write_text(text, encoding="utf-8")
    return folder / "sweep.json"


def _number(text: str) -> Any:
    """A number where it is one; None of an empty cell."""
    try:
        return float(text) if text else None
    except ValueError:
        return text
