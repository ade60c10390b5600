# SPDX-License-Identifier: GPL-3.0-or-later
"""How everything shows itself: repr, a notebook's HTML, pickle, plots and data frames, the last two
with the package and without it."""

import copy
import html
import pickle
import re
import sys
import types

import pytest

import chaintrue
from conftest import FIXTURES

FILED = ("grid", "holes", "belts", "machine", "calibration", "anchors", "diagnosis")
REPORTED = ("calibration", "anchors", "diagnosis", "check", "sweep")
OTHERS = ("answer", "check", "plan", "program", "sweep")


@pytest.fixture(scope="module")
def things(request, calibration, machine, new_points):
    made = {
        "answer": calibration.query([[0.0, 0.0], [0.0, 9e3]]),
        "check": chaintrue.check(calibration, new_points),
        "plan": chaintrue.plan(machine, 12),
        "program": chaintrue.gcode.compensate(FIXTURES / "gcode" / "bracket.nc", calibration),
        "sweep": chaintrue.sweep(FIXTURES / "sweeps" / "quick.json"),
    }
    return {**{name: request.getfixturevalue(name) for name in FILED}, **made}


def same(one, other):
    """Whether two long texts are equal; pytest would take minutes to show where they are not."""
    return one == other


@pytest.mark.parametrize("name", FILED + OTHERS)
def test_a_pickle_is_the_thing(things, name):
    thing = things[name]
    stored = pickle.dumps(thing)
    again = pickle.loads(stored)
    assert type(again) is type(thing) and repr(again) == repr(thing)
    assert same(pickle.loads(pickle.dumps(again))._repr_html_(), again._repr_html_())
    assert b"_core" not in stored  # by its file's text and its public name


@pytest.mark.parametrize("name", FILED)
def test_what_has_a_file_is_equal_by_it(things, name):
    thing = things[name]
    again = copy.deepcopy(thing)
    assert again == thing and hash(again) == hash(thing) and again != things["grid"].to_dict()
    assert type(thing).from_dict(thing.to_dict()) == thing


@pytest.mark.parametrize(
    "made",
    [
        chaintrue.InputError("bad", [("a.json", "/x", "1", "2", "a.json: /x: found 1, expected 2")]),
        chaintrue.Failure("no", "no_machine"),
        chaintrue.GcodeError("line 1", [(1, 0, "bad_arc", "an arc")]),
        chaintrue.MissingPackage("pandas", "A data frame"),
    ],
)
def test_errors_can_be_pickled(made):
    again = pickle.loads(pickle.dumps(made))
    assert str(again) == str(made) and vars(again) == vars(made)


@pytest.mark.parametrize("name", FILED + OTHERS)
def test_a_repr_is_one_line_and_names_its_type(things, name):
    shown = repr(things[name])
    assert "\n" not in shown and type(things[name]).__name__ in shown and " at 0x" not in shown


@pytest.mark.parametrize("name", FILED + OTHERS)
def test_a_notebook_shows_html(things, name):
    shown = things[name]._repr_html_()
    assert re.match(r"<(iframe|b|table)\b", shown)
    if name in REPORTED:
        page = html.unescape(re.search(r'srcdoc="([^"]*)"', shown)[1])
        assert same(page, chaintrue.report(things[name]))


class StandIn:
    """Axes and a figure that note what is asked of them."""

    def __init__(self):
        self.calls = {}
        self.figure = self

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *given, **named: self.calls.setdefault(name, []).append(given)


DRAWN = {
    "grid": "scatter",
    "holes": "plot",
    "belts": "scatter",
    "machine": "plot",
    "calibration": "pcolormesh",
    "anchors": "scatter",
    "diagnosis": "barh",
    "answer": "scatter",
    "check": "barh",
    "plan": "plot",
    "program": "quiver",
    "sweep": "plot",
}


@pytest.mark.parametrize("name", FILED + OTHERS)
def test_everything_has_a_plot(things, name):
    axes = StandIn()
    assert things[name].plot(axes) is axes
    assert axes.calls[DRAWN[name]]


def test_a_plot_shows_the_points(things):
    axes = StandIn()
    things["grid"].plot(axes)
    x, y = axes.calls["scatter"][0]
    assert x.tolist() == things["grid"].marks[:, 0].tolist()


def test_without_matplotlib_there_is_a_sentence(things, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.delitem(sys.modules, "matplotlib.pyplot", raising=False)
    with pytest.raises(chaintrue.MissingPackage, match="apt install python3-matplotlib") as told:
        things["grid"].plot()
    assert told.value.name == "matplotlib" and isinstance(told.value, ImportError)


def test_with_matplotlib_axes_are_made(things, monkeypatch):
    axes = StandIn()
    pyplot = types.ModuleType("matplotlib.pyplot")
    pyplot.subplots = lambda: (axes, axes)
    monkeypatch.setitem(sys.modules, "matplotlib", types.ModuleType("matplotlib"))
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", pyplot)
    assert things["diagnosis"].plot() is axes


TABLES = {
    "diagnosis": lambda found: found.causes,
    "answer": lambda answer: answer,
    "check": lambda check: check.residuals,
    "plan": lambda plan: plan.to_records(),
    "sweep": lambda sweep: sweep.results,
}


@pytest.mark.parametrize("name", TABLES)
def test_a_data_frame_has_the_columns(things, worn_diagnosis, monkeypatch, name):
    pandas = types.ModuleType("pandas")
    pandas.DataFrame = lambda columns: ("frame", columns)
    monkeypatch.setitem(sys.modules, "pandas", pandas)
    thing = worn_diagnosis if name == "diagnosis" else things[name]
    columns = TABLES[name](thing).columns()
    assert thing.to_frame() == ("frame", columns)
    assert len({len(column) for column in columns.values()}) == 1 and all(columns.values())
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(chaintrue.MissingPackage, match="apt install python3-pandas"):
        thing.to_frame()
