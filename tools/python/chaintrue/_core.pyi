# SPDX-License-Identifier: GPL-3.0-or-later
"""What core/*.cpp adds to the module. A text is that of a file of the thing; what was assumed of one
comes alongside it, a sentence each."""

from typing import Any, Optional

import numpy
from numpy.typing import NDArray

__version__: str
PLANNED_POINTS: tuple[int, int]
PLANNED_HOLES: tuple[int, int]
PLANNED_CHECK_POINTS: tuple[int, int]

_Rows = NDArray[numpy.float64]
_Sources = list[tuple[str, str]]
_MadeBy = tuple[str, list[str], _Sources]
_Asked = tuple[int, Optional[float], Optional[float], Optional[float], str, float]

class Answering:
    def __init__(self, text: str) -> None: ...
    def sentence(self) -> str: ...
    def machine(self) -> str: ...
    def query(self, points: _Rows, bed: bool) -> dict[str, Any]: ...
    def inverse(self, lengths: _Rows, bed: bool) -> _Rows: ...

class GcodeOptions:
    tolerance_mm: float
    decimals: int
    largest_correction_mm: float
    steepest_correction: float
    controller: str
    machine: str
    settings: str
    frame: str
    home: str
    keep_rapids_whole: bool
    home_is_zero: bool
    skip_deletable: bool
    tools_have_no_diameter: bool
    no_verify: bool
    forced: bool
    def __init__(self) -> None: ...

def parse(kind: str, text: str, file: str, machine: str, few: bool) -> tuple[str, list[str]]: ...
def read(kind: str, path: str, machine: str, few: bool) -> tuple[str, list[str], _Sources]: ...
def write(path: str, text: str) -> None: ...
def format_version(file_type: str) -> str: ...
def run(words: list[str]) -> tuple[int, str]: ...
def maslow4_settings(anchors: str) -> str: ...
def plan_marks(machine: str, asked: _Asked, second_visits: int) -> dict[str, Any]: ...
def plan_check(map: str, asked: _Asked) -> dict[str, Any]: ...
def plan_holes(
    machine: str,
    asked: _Asked,
    distances: int,
    edges: bool,
    tape_sigma_mm: float,
    hole_sigma_mm: float,
) -> dict[str, Any]: ...
def plan_after(found: str, texts: list[str]) -> dict[str, Any]: ...
def planned_distances(holes: int, edges: bool) -> tuple[int, int]: ...
def compensate(
    program: str, target: str, options: GcodeOptions, made_by: _MadeBy
) -> dict[str, Any]: ...
def verify(original: str, run: str, target: str, options: GcodeOptions) -> dict[str, Any]: ...
