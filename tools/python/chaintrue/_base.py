# SPDX-License-Identifier: GPL-3.0-or-later
"""What every object with a file has in common: contents, equality, pickling and a notebook's view."""

from __future__ import annotations

import functools
import html
import json
import os
import pathlib
import warnings
from typing import Any, Callable, Iterable, Optional, Sequence, Union

import numpy
from numpy.typing import NDArray

from . import _core
from ._records import Record, table
from ._run import File, run

PathLike = Union[str, "os.PathLike[str]"]
"""The path of a file."""
Sources = Sequence[tuple[str, str]]
"""The files that were read: name without folders, and SHA-256."""


class Written:
    """An immutable object with the text of a JSON file."""

    _text: str

    @functools.cached_property
    def _contents(self) -> dict[str, Any]:
        return self.to_dict()

    def to_dict(self) -> dict[str, Any]:
        """The contents of the JSON file (docs/formats) as dictionaries and lists."""
        return json.loads(self._text)

    def write(self, path: PathLike) -> None:
        """Writes the JSON file atomically; the same object gives the same bytes."""
        _core.write(os.fspath(path), self._text)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._content() == other._content()

    def __hash__(self) -> int:
        return hash(json.dumps(self._content()))

    def _content(self) -> dict[str, Any]:
        """The contents that equality compares: everything but the origin."""
        return {k: v for k, v in self._contents.items() if k not in ("made_by", "content_hash")}


def key(
    name: str, meaning: str, shown: Callable[[Any], Any] = Record.of, missing: Any = None
) -> Any:
    """A property that returns the file's value of this name, or `missing`."""

    def get(self: Written) -> Any:
        return shown(self._contents.get(name, missing))

    get.__doc__ = meaning
    return property(get)


class Filed(Written):
    """An object of the library, held as the text of its file."""

    _sources: Sources

    name: str = key("name", "What it is called in its file.", missing="")

    def __init__(self) -> None:
        raise TypeError(f"a {type(self).__name__} is read, fitted or made by from_dict()")

    @classmethod
    def _of(cls, text: str, sources: Sources = ()) -> Any:
        thing = cls.__new__(cls)
        thing._text, thing._sources = text, tuple(sources)
        return thing

    @classmethod
    def _kind(cls) -> str:
        return cls.__name__.lower()

    def _become(self, contents: dict[str, Any], sources: Sources, few: bool = False) -> None:
        """The object that a file with these contents describes; keys without a value are dropped."""
        text = text_of(contents, f"chaintrue_{self._kind()}")
        self._text, _ = _core.parse(self._kind(), text, "arrays", "", few)
        self._sources = tuple(sources)

    @classmethod
    def from_dict(cls, contents: dict[str, Any]) -> Any:
        """The object with this to_dict(), checked as a file is."""
        return from_text(cls, json.dumps(contents), "the dictionary")

    @property
    def _file(self) -> File:
        return File(f"{self._kind()}.json", self._text)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self._text, self._sources)

    def __repr__(self) -> str:
        return f"<chaintrue.{type(self).__name__} {self.name!r}: {in_words(self._facts())}>"

    def _facts(self) -> dict[str, Any]:
        """The values that repr and a notebook show, by label."""
        return {}

    def _repr_html_(self) -> str:
        return facts_table(f"{type(self).__name__} {self.name}", self._facts())


class Listed(Filed):
    """Measurements: entries of a list in their file."""

    _list = "points"

    def _columns(self, *keys: str, number: type = float) -> Any:
        """(n, ...) array of the values under these keys; None where an entry lacks one."""
        entries = self._contents[self._list]
        if any(key not in entry for entry in entries for key in keys):
            return None
        return numpy.array([[entry[key] for key in keys] for entry in entries], dtype=number)

    def __len__(self) -> int:
        return len(self._contents[self._list])


class Paged:
    """What has an HTML report, which a notebook shows."""

    _page_text: str
    _height = 640

    def _page(self, source: str, *options: str) -> str:
        return self._page_text

    def _repr_html_(self) -> str:
        """The page in a frame of the notebook, so that their styles stay apart."""
        return (
            f'<iframe sandbox="allow-scripts" srcdoc="{html.escape(self._page("Python"))}" '
            f'style="width:100%;height:{self._height}px;border:0"></iframe>'
        )


class Made(Paged, Filed):
    """A result with its sources and a report."""

    made_by: Optional[Record] = key(
        "made_by",
        "version, verb, options, and inputs with name and sha256 of each file that was read; None where "
        "that is not known.",
    )

    @property
    def _file(self) -> File:
        """The name of the file that it was read from, for a program's header."""
        return File(self._sources[0][0], self._text) if self._sources else super()._file

    @classmethod
    def _by(cls, *words: Union[str, File], sources: Sources) -> Any:
        """The output of a verb, with the sources of its inputs instead of the run's temporary files."""
        result = f"{cls._kind()}.json"
        files, _, _ = run(*words, "-o", result, out=[result], sources=sources)
        return cls._of(files[result])

    def _page(self, source: str, *options: str) -> str:
        """The page that `chaintrue report` writes for a file of that name."""
        page = "page.html"
        file = File(pathlib.PurePath(source).name or "Python", self._text)
        return run("report", file, "-o", page, *options, out=[page])[0][page]


def inputs(things: Iterable[Filed]) -> list[Union[str, File]]:
    """The arguments that pass these objects' files to a verb."""
    words = [word for thing in things for word in ("--with", thing._file)]
    return words[1:]


def from_text(kind: type[Filed], text: str, file: str, sources: Sources = ()) -> Any:
    """The object of a file's text."""
    return _told(kind, *_core.parse(kind._kind(), text, file, "", True), sources)


def from_file(
    kind: type[Filed], path: PathLike, machine: Optional[Filed] = None, few: bool = False
) -> Any:
    """The object of a file, with that machine in place of its own."""
    stated = "" if machine is None else machine._text
    text, assumed, sources = _core.read(kind._kind(), os.fspath(path), stated, few)
    return _told(kind, text, assumed, [*sources, *sources_of(machine)])


def _again(kind: type[Filed], text: str, sources: Sources) -> Any:
    """Restores a pickled object."""
    return from_text(kind, text, f"the stored {kind.__name__}", sources)


def _told(kind: type[Filed], text: str, assumed: list[str], sources: Sources) -> Any:
    """What was read; each assumption is a warning where the reading was asked for."""
    for sentence in assumed:
        warnings.warn(sentence, stacklevel=4)
    return kind._of(text, sources)


def sources_of(*things: Any) -> list[tuple[str, str]]:
    """The files of all objects that have any, each once."""
    return list(dict.fromkeys(source for thing in things for source in getattr(thing, "_sources", ())))


def facts_table(title: str, facts: dict[str, Any]) -> str:
    """A table with one row per value; "mm error" is shown as "error, mm"."""
    names = [f"{key[3:]}, mm" if key.startswith("mm ") else key for key in facts]
    values = [str(fact) for fact in facts.values()]
    return f"<b>{html.escape(title)}</b>" + table({"": names, " ": values})


def in_words(facts: dict[str, Any]) -> str:
    return ", ".join(f"{value} {key}" for key, value in facts.items())


def text_of(contents: dict[str, Any], file_type: str) -> str:
    """The text of a file with these contents; keys without a value are dropped."""
    head = {"file_type": file_type, "format_version": _core.format_version(file_type)}
    return json.dumps({**head, **{k: v for k, v in contents.items() if v is not None}})


def array_of(
    numbers: Any, name: str, columns: int = 2, also_single: bool = False
) -> NDArray[numpy.float64]:
    """Returns an (n, columns) float64 array of finite numbers, with `also_single` (..., columns); raises
    ValueError otherwise."""
    array = numpy.asarray(numbers, dtype=numpy.float64)
    if array.shape[-1:] != (columns,) or (array.ndim != 2 and not also_single):
        or_single = f" or ({columns},)" * also_single
        raise ValueError(f"{name} must have the shape (n, {columns}){or_single}, not {array.shape}")
    bad = numpy.argwhere(~numpy.isfinite(array))
    if bad.size:
        row = bad[0][0] if array.ndim > 1 else 0
        raise ValueError(f"{name}: row {row} holds a number that is none, or infinite")
    return array


def one_of(word: str, name: str, words: tuple[str, ...]) -> str:
    if word not in words:
        known = ", ".join(words[:-1]) + " or " + words[-1]
        raise ValueError(f'{name} is {known}, not "{word}"')
    return word
