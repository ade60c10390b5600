# SPDX-License-Identifier: GPL-3.0-or-later
"""New readings against a map, or against anchors."""

from __future__ import annotations

import json
import os
from typing import Any, Optional, Union

from . import _core, _plots
from ._base import PathLike, framed
from ._maps import Anchors, Map, Measured, sorted_out
from ._records import Record, Records, records


class Check:
    """Whether a map, or anchors, still hold."""

    def __init__(self, text: str, page: str, valid: bool):
        self._text = text
        self._page_text = page
        self.valid: bool = valid
        """It holds as it is, and the new readings are enough to say so."""

    def to_dict(self) -> dict[str, Any]:
        """What `chaintrue check --json` writes, as dictionaries and lists."""
        return json.loads(self._text)

    def write(self, path: PathLike) -> None:
        """Writes that file, whole or not at all."""
        _core.write(os.fspath(path), self._text)

    @property
    def sentence(self) -> str:
        """The answer."""
        return self.to_dict()["sentence"]

    @property
    def verdict(self) -> str:
        """valid, valid_after_rezeroing or measure_again."""
        return self.to_dict()["verdict"]

    @property
    def decided(self) -> bool:
        """False: more readings are needed to tell."""
        return self.to_dict()["decided"]

    @property
    def probability(self) -> Record:
        """Of valid, valid_after_rezeroing and measure_again."""
        return Record.of(self.to_dict()["probability"])

    @property
    def hypotheses(self) -> Records:
        """What may have changed, the most probable first: what, side, verdict, probability."""
        return records(self.to_dict()["hypotheses"])

    @property
    def residuals(self) -> Records:
        """How far the new readings lie from what was expected, with sigmas; mm."""
        contents = self.to_dict()
        return records(contents.get("residuals", contents.get("places", [])))

    def to_frame(self) -> Any:
        """residuals.to_frame(): a pandas.DataFrame. Raises MissingPackage without pandas."""
        return self.residuals.to_frame()

    def plot(self, ax: Any = None) -> Any:
        """The probabilities of what may have changed; the axes are given back."""
        return _plots.probabilities(self.hypotheses, "what", ax)

    def __eq__(self, other: object) -> bool:
        return self._text == other._text if isinstance(other, Check) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        return f"<chaintrue.Check: {self.sentence}>"

    def _page(self, source: str) -> str:
        return self._page_text

    def _repr_html_(self) -> str:
        return framed(self._page_text, 420)


def check(
    calibration: Union[Map, Anchors], *measured: Measured, settings: Optional[PathLike] = None
) -> Check:
    """Whether a Map holds for new Grids and Holes, or Anchors for new Belts: three to five places far
    from each other will do. Made with few=True, a Grid takes so few.

    settings  the file of what the controller held when the new points were commanded, if other than
              when the map was measured: groundcontrol.ini, webcontrol.json, or a machine file
    """
    grids, holes, belts = sorted_out(measured, "check")
    if isinstance(calibration, Anchors):
        if grids or holes or len(belts) != 1:
            raise ValueError("anchors are checked by one Belts")
        if settings is not None:
            raise ValueError("settings are of a map: anchors are checked by lengths")
        return Check(*_core.check_anchors(calibration._core, belts[0]))
    if belts:
        raise ValueError("a map is checked by Grids and Holes; Belts check Anchors")
    file = "" if settings is None else os.fspath(settings)
    return Check(*_core.check_map(calibration._core, grids, holes, file))
