# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages."""

from __future__ import annotations

import os
from typing import Optional, Union

from . import _core
from ._base import PathLike
from ._checks import Check
from ._diagnosis import Diagnosis
from ._maps import Anchors, Map
from ._sweeps import Sweep


def report(
    of: Union[Map, Anchors, Diagnosis, Check, Sweep],
    path: Optional[PathLike] = None,
    certificate: bool = False,
    source: str = "Python",
) -> str:
    """The page of a Map, Anchors, a Diagnosis, a Check or a Sweep, as text; with a path it is written
    there too.

    certificate  of a Map: one page to print
    source       what the page's last line says that it was made from
    """
    if certificate and not isinstance(of, Map):
        raise ValueError("only a map has a certificate")
    page = of._page(source, *["--certificate"] * certificate)
    if path is not None:
        _core.write(os.fspath(path), page)
    return page
