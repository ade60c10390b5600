# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of maps and anchors with new readings."""

from __future__ import annotations

import os
from typing import Any, Optional, Union

from . import _plots
from ._base import Paged, PathLike, Written, inputs, key
from ._maps import Anchors, Map, Measured, sorted_out
from ._records import Record, Records, records
from ._run import run


class Check(Paged, Written):
    """Whether a map or anchors are still valid; the file is that of `chaintrue check --json`."""

    _height = 420

    def __init__(self, text: str, page: str):
        self._text = text
        self._page_text = page

    sentence: str = key("sentence", "The answer.")
    verdict: str = key("verdict", "valid, valid_after_rezeroing or measure_again.")
    decided: bool = key("decided", "False: more readings are needed to tell.")
    probability: Record = key("probability", "Of valid, valid_after_rezeroing and measure_again.")
    hypotheses: Records = key(
        "hypotheses",
        "What may have changed, the most probable first: what, side, verdict, probability.",
        records,
    )

    @property
    def valid(self) -> bool:
        """True if it is valid as it is and the new readings suffice to say so."""
        has_changed = "settings_have_changed" in self._contents
        return self.decided and self.verdict == "valid" and not has_changed

    @property
    def residuals(self) -> Records:
        """Residuals of the new readings and their sigmas, mm."""
        return records(self._contents.get("residuals") or self._contents.get("places"))

    def to_frame(self) -> Any:
        """residuals.to_frame(): a pandas.DataFrame. Raises MissingPackage without pandas."""
        return self.residuals.to_frame()

    plot = _plots.probabilities

    def __repr__(self) -> str:
        return f"<chaintrue.Check: {self.sentence}>"


def check(
    calibration: Union[Map, Anchors], *measured: Measured, settings: Optional[PathLike] = None
) -> Check:
    """Whether a Map holds for new Grids and Holes, or Anchors for new Belts: three to five places far
    from each other will do. Made with few=True, a Grid takes so few.

    settings  the file of what the controller held when the new points were commanded, if other than
              when the map was measured: groundcontrol.ini, webcontrol.json, or a machine file
    """
    grids, holes, belts = sorted_out(measured, "check")
    if isinstance(calibration, Anchors) and (grids or holes or len(belts) != 1):
        raise ValueError("anchors are checked by one Belts")
    if isinstance(calibration, Map) and belts:
        raise ValueError("a map is checked by Grids and Holes; Belts check Anchors")
    words = ["check", calibration._file, *inputs(measured), "--json"]
    if settings is not None:
        words += ["--settings", os.fspath(settings)]
    answer, page = "check.json", "check.html"
    files, _, _ = run(*words, "-o", answer, "--report", page, out=[answer, page])
    return Check(files[answer], files[page])
