# SPDX-License-Identifier: GPL-3.0-or-later
"""chaintrue for Python: from measured points to a compensation map and a diagnosis.

    import chaintrue
    grid = chaintrue.read_grid("fixtures/grids/seven_by_four.json")
    map = chaintrue.fit(grid)
    answer = chaintrue.query(map, [[100.0, 200.0], [-1000.0, -450.0]])
    answer.lengths, answer.sigma           # (2, 2) each: left and right chain, mm
    found = chaintrue.diagnose(grid)
    print(found.sentence)
    chaintrue.report(found, "diagnosis.html")

Lengths are millimetres, coordinates those of the bed: zero in its middle, x to the right, y up. Arrays
are float64 of shape (n, 2), a row a point: (x, y), or (left, right). Where there is no answer an array
is masked (numpy.ma); no NaN is ever given or taken.

Bad input raises InputError (a ValueError) with every problem of the file; what cannot be done with
sound input raises Failure (a RuntimeError) with a sentence.
"""

import dataclasses
import json
import os
import warnings

import numpy

from . import _core
from ._core import Failure, InputError, __version__

__all__ = [
    "Answer",
    "Diagnosis",
    "Failure",
    "Grid",
    "Holes",
    "InputError",
    "Machine",
    "Map",
    "diagnose",
    "fit",
    "inverse",
    "query",
    "read_diagnosis",
    "read_grid",
    "read_holes",
    "read_machine",
    "read_map",
    "report",
]


class _Wrapped:
    """A thing of the library, with the text of its file."""

    def __init__(self, core):
        self._core = core

    def to_dict(self):
        """The contents of its JSON file (docs/formats) as dictionaries and lists."""
        return json.loads(self._core.text())

    def write(self, path):
        """Writes its JSON file, whole or not at all; the same object gives the same bytes."""
        _core.write(os.fspath(path), self._core.text())


class Machine(_Wrapped):
    """A machine as its owner states it (docs/formats/machine.md)."""

    @property
    def name(self):
        return self._core.name


class Grid(_Wrapped):
    """Measured points of one session.

    marks      (n, 2) array, mm: where the tool was, x and y
    lengths    (n, 2) array, mm: left and right chain as read; or None
    commanded  (n, 2) array, mm: where the controller was told to go, in place of lengths; or None
    order      n whole numbers, all different: which visit each was; or None
    machine    a Machine, which a fit and a diagnosis need
    length_noise_mm, position_noise_mm
               one sigma of a length, and of a mark on each axis; None: told from repeated visits or
               from the fit
    noise_dof  how well these are known, in degrees of freedom
    """

    def __init__(
        self,
        marks,
        lengths=None,
        commanded=None,
        order=None,
        machine=None,
        length_noise_mm=None,
        position_noise_mm=None,
        noise_dof=15.0,
        name="",
    ):
        if (length_noise_mm is None) != (position_noise_mm is None):
            raise ValueError("give both length_noise_mm and position_noise_mm, or neither")
        noise = None if length_noise_mm is None else _core.Noise(length_noise_mm, position_noise_mm, noise_dof)
        super().__init__(
            _core.grid_of(
                marks,
                lengths,
                commanded,
                None if order is None else [int(number) for number in order],
                None if machine is None else machine._core,
                noise,
                name,
            )
        )

    @classmethod
    def _of(cls, core):
        grid = cls.__new__(cls)
        _Wrapped.__init__(grid, core)
        return grid

    @property
    def name(self):
        return self._core.name

    @property
    def machine(self):
        """The Machine that the grid names, or None."""
        return None if self._core.machine is None else Machine(self._core.machine)

    @property
    def marks(self):
        """(n, 2) array, mm: where the tool was, x and y."""
        return self._core.marks

    @property
    def lengths(self):
        """(n, 2) array, mm: left and right chain as read; None where a point has none."""
        return self._core.lengths

    @property
    def commanded(self):
        """(n, 2) array, mm: where the controller was told to go; None where a point has none."""
        return self._core.commanded

    @property
    def order(self):
        """(n,) array of whole numbers: which visit each was; None where that is not known."""
        return None if self._core.order is None else numpy.array(self._core.order)

    def __len__(self):
        return len(self._core.marks)


class Holes(_Wrapped):
    """Holes that the machine drilled, and a tape's distances (docs/formats/holes.md)."""

    @property
    def name(self):
        return self._core.name


class Map(_Wrapped):
    """A compensation map: what the chains must be for every place of the bed."""

    @property
    def name(self):
        return self._core.name

    @property
    def notes(self):
        """What its reader should know, in sentences."""
        return self._core.notes


class Diagnosis(_Wrapped):
    """Why a machine errs, and how sure that is (docs/diagnosis.md)."""

    @property
    def sentence(self):
        """The answer."""
        return self._core.sentence

    @property
    def verdict(self):
        """named, named_set, several_causes, unknown_pattern, noise_larger_than_stated, bad_points or
        nothing_found."""
        return self.to_dict()["verdict"]

    @property
    def causes(self):
        """The causes named, the most probable first: dictionaries with effect, side, probability and
        parameters, each with value and sigma in the unit that its name ends in."""
        return self.to_dict()["causes"]


@dataclasses.dataclass(frozen=True)
class Answer:
    """What a map says of n places.

    lengths     (n, 2) masked array, mm: left and right chain
    sigma       (n, 2) masked array, mm: one sigma of each
    tool_sigma  (n,) masked array, mm: one sigma of the tool's place
    status      (n,) array of inside, edge, extrapolated, outside
    """

    lengths: numpy.ma.MaskedArray
    sigma: numpy.ma.MaskedArray
    tool_sigma: numpy.ma.MaskedArray
    status: numpy.ndarray


def _told(read, wrap):
    thing, sentences = read
    for sentence in sentences:
        warnings.warn(sentence, stacklevel=3)
    return wrap(thing)


def _core_of(machine):
    return None if machine is None else machine._core


def read_machine(path):
    """The Machine of a chaintrue_machine file. What was assumed is a warning."""
    return _told(_core.read_machine(os.fspath(path)), Machine)


def read_grid(path, machine=None):
    """The Grid of a chaintrue_grid file, JSON or CSV; machine in place of the one that it names."""
    return _told(_core.read_grid(os.fspath(path), _core_of(machine)), Grid._of)


def read_holes(path, machine=None):
    """The Holes of a chaintrue_holes file, JSON or CSV; machine in place of the one that it names."""
    return _told(_core.read_holes(os.fspath(path), _core_of(machine)), Holes)


def read_map(path):
    """The Map of a chaintrue_map file."""
    return _told(_core.read_map(os.fspath(path)), Map)


def read_diagnosis(path):
    """The Diagnosis of a chaintrue_diagnosis file."""
    return _told(_core.read_diagnosis(os.fspath(path)), Diagnosis)


def fit(measured, surface="residual", causes=False, accept_class=False):
    """The Map of a Grid or of Holes.

    surface  residual: the machine, calibrated, and a smooth correction of what it leaves
             direct: splines through the lengths themselves, for points on full rows and columns; needs
             no machine
    causes   look for causes as diagnose does, and build the map on those that make it better on points
             left out; its notes say which
    accept_class  with causes: where links and tape cannot be told apart, it is the links
    """
    if accept_class and not causes:
        raise ValueError("accept_class says which of two causes acts: give causes=True")
    if causes and surface == "direct":
        raise ValueError("a direct surface has no machine that could err")
    if surface not in ("residual", "direct"):
        raise ValueError(f'surface is residual or direct, not "{surface}"')
    if isinstance(measured, Holes):
        if surface == "direct":
            raise ValueError("holes have no lengths for a direct surface")
        if causes:
            return Map(_core.fit_distances_on_causes(measured._core, accept_class))
        return Map(_core.fit_distances(measured._core))
    if causes:
        return Map(_core.fit_points_on_causes(measured._core, accept_class))
    return Map(_core.fit_points(measured._core, surface == "direct"))


def query(map, points, frame="marks"):
    """What the chains must be: an Answer for points, an (n, 2) array of x and y in mm.

    frame  marks: as the grid's points were given; bed: as the machine file has it
    """
    found = map._core.query(points, _is_bed(frame))
    outside = found["outside"]
    both = numpy.column_stack([outside, outside])
    return Answer(
        lengths=numpy.ma.array(found["lengths"], mask=both),
        sigma=numpy.ma.array(found["sigma"], mask=both),
        tool_sigma=numpy.ma.array(found["tool_sigma"], mask=outside),
        status=numpy.array(found["status"]),
    )


def inverse(map, lengths, frame="marks"):
    """Where the tool is: an (n, 2) masked array of x and y in mm, for lengths, an (n, 2) array of left
    and right chain in mm."""
    points, outside = map._core.inverse(lengths, _is_bed(frame))
    return numpy.ma.array(points, mask=numpy.column_stack([outside, outside]))


def _is_bed(frame):
    if frame not in ("marks", "bed"):
        raise ValueError(f'frame is marks or bed, not "{frame}"')
    return frame == "bed"


def diagnose(*measured, seed=1, gain=True):
    """The Diagnosis of any mix of Grids and Holes of one machine.

    seed  of the draws that chances are counted with; same input, same answer
    gain  also what naming the cause gains on points held out, which takes most of the time
    """
    grids = [thing._core for thing in measured if isinstance(thing, Grid)]
    holes = [thing._core for thing in measured if isinstance(thing, Holes)]
    if len(grids) + len(holes) != len(measured) or not measured:
        raise TypeError("diagnose takes Grids and Holes, one at least")
    return Diagnosis(_core.diagnose(grids, holes, seed, gain))


def report(of, path=None, certificate=False, source="Python"):
    """The page of a Map or a Diagnosis, as text; with a path it is written there too.

    certificate  of a Map: one page to print
    source       what the page's last line says that it was made from
    """
    if certificate and not isinstance(of, Map):
        raise ValueError("only a map has a certificate")
    page = of._core.page(source, certificate) if isinstance(of, Map) else of._core.page(source)
    if path is not None:
        _core.write(os.fspath(path), page)
    return page
