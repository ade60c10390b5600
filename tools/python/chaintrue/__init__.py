# SPDX-License-Identifier: GPL-3.0-or-later
"""chaintrue for Python: from measured points to a compensation map and a diagnosis.

    import chaintrue
    grid = chaintrue.read_grid("fixtures/grids/seven_by_four.json")
    calibration = chaintrue.fit(grid)
    answer = calibration.query([[100.0, 200.0], [-1000.0, -450.0]])
    answer.left, answer.right, answer.tool_sigma       # (2,) each, mm
    calibration.query([100.0, 200.0]).left             # one place: one number
    calibration.inverse(answer)                        # the places again
    found = chaintrue.diagnose(grid)
    print(found.sentence)
    found.causes.to_frame()                            # where pandas is installed
    chaintrue.report(found, "diagnosis.html")

Measured things are Machine, Grid, Holes and Belts, from files or from arrays; answers are Map, Anchors,
Diagnosis, Check, Plan and Sweep. Each has a repr, shows itself in a notebook, can be pickled, and has
plot() where matplotlib is installed. chaintrue.gcode compensates and verifies programs.

Lengths are millimetres, coordinates those of the bed: zero in its middle, x to the right, y up. Arrays
are float64 of shape (n, 2), a row a point: (x, y), or (left, right). Where there is no answer an array
is masked (numpy.ma); no NaN is ever given or taken.

Bad input raises InputError (a ValueError) with every problem of the file; what cannot be done with
sound input raises Failure (a RuntimeError) with a sentence and a reason.
"""

from . import _core, gcode
from ._checks import Check, check
from ._core import __version__
from ._diagnosis import Cause, Diagnosis, diagnose, read_diagnosis
from ._errors import Failure, GcodeError, GcodeProblem, InputError, MissingPackage, Problem
from ._lengths import Lengths
from ._maps import (
    Accuracy,
    Anchors,
    AnchorsAccuracy,
    Map,
    fit,
    inverse,
    query,
    read_anchors,
    read_map,
)
from ._measured import Grid, Machine, read_grid, read_machine
from ._plans import Plan, plan
from ._records import Record, Records
from ._reports import report
from ._sweeps import Sweep, sweep
from ._taped import Belts, Holes, read_belts, read_holes

Answer = Lengths

__all__ = [
    "Accuracy",
    "Anchors",
    "AnchorsAccuracy",
    "Answer",
    "Belts",
    "Cause",
    "Check",
    "Diagnosis",
    "Failure",
    "GcodeError",
    "GcodeProblem",
    "Grid",
    "Holes",
    "InputError",
    "Lengths",
    "Machine",
    "Map",
    "MissingPackage",
    "Plan",
    "Problem",
    "Record",
    "Records",
    "Sweep",
    "check",
    "diagnose",
    "fit",
    "gcode",
    "inverse",
    "plan",
    "query",
    "read_anchors",
    "read_belts",
    "read_diagnosis",
    "read_grid",
    "read_holes",
    "read_machine",
    "read_map",
    "report",
    "sweep",
]

# By the name that a user writes: in messages, in help(), and in what is pickled.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__
del _name
