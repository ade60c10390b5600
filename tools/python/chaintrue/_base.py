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

    def _become(self, contents: dict[str, Any], sources: Sources, few: bool = False) -> None:
        """The object that a file with these contents describes; keys without a value are dropped."""
        kind = type(self).__name__.lower()
        text = text_of(contents, f"chaintrue_{kind}")
        self._text, _ = _core.parse(kind, text, "arrays", "", few)
        self._sources = tuple(sources)

    @classmethod
    def from_dict(cls, contents: dict[str, Any]) -> Any:
        """The object with this to_dict(), checked as a file is."""
        return told(cls, parsed(cls, json.dumps(contents), "the dictionary"))

    @property
    def _file(self) -> File:
        return File(f"{type(self).__name__.lower()}.json", self._text)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self._text, self._sources)

    def __repr__(self) -> str:
        return f"<chaintrue.{type(self).__name__} {self.name!r}: {in_words(self._facts())}>"

    def _facts(self) -> dict[str, Any]:
        """The values that repr and a notebook show, by label."""
        return {}

    def _repr_html_(self) -> str:
        return facts_table(f"{type(self).__name__} {self.name}", self._facts())


class Made(Filed):
    """A result with its sources and an HTML report, which a notebook shows."""

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
        result = cls.__name__.lower() + ".json"
        files, _, _ = run(*words, "-o", result, out=[result], sources=sources)
        return cls._of(files[result])

    def _page(self, source: str, *options: str) -> str:
        """The page that `chaintrue report` writes for a file of that name."""
        page = "page.html"
        file = File(pathlib.PurePath(source).name or "Python", self._text)
        return run("report", file, "-o", page, *options, out=[page])[0][page]

    def _repr_html_(self) -> str:
        return framed(self._page("Python"))


def inputs(things: Iterable[Filed]) -> list[Union[str, File]]:
    """The arguments that pass these objects' files to a verb."""
    words = [word for thing in things for word in ("--with", thing._file)]
    return words[1:]


def parsed(kind: type[Filed], text: str, file: str) -> tuple[str, list[str]]:
    """A file's text in this version's form, and the assumptions made in reading it."""
    return _core.parse(kind.__name__.lower(), text, file, "", True)


def from_file(
    kind: type[Filed], path: PathLike, machine: Optional[Filed] = None, few: bool = False
) -> tuple[str, list[str], Sources]:
    """The same for a file, with that machine, and the files that were read for it."""
    stated = "" if machine is None else machine._text
    return _core.read(kind.__name__.lower(), os.fspath(path), stated, few)


def _again(kind: type[Filed], text: str, sources: Sources) -> Any:
    """Restores a pickled object."""
    return told(kind, (*parsed(kind, text, f"the stored {kind.__name__}"), sources))


def sources_of(*things: Optional[Filed]) -> list[tuple[str, str]]:
    """The files of all objects, each once."""
    return list(dict.fromkeys(source for thing in things if thing is not None for source in thing._sources))


def facts_table(title: str, facts: dict[str, Any]) -> str:
    """A table with one row per value; "mm error" is shown as "error, mm"."""
    names = [f"{key[3:]}, mm" if key.startswith("mm ") else key for key in facts]
    values = [str(fact) for fact in facts.values()]
    return f"<b>{html.escape(title)}</b>" + table({"": names, " ": values})


def framed(page: str, height: int = 640) -> str:
    """A page in a frame of the notebook, so that their styles stay apart."""
    return (
        f'<iframe sandbox="allow-scripts" srcdoc="{html.escape(page)}" '
        f'style="width:100%;height:{height}px;border:0"></iframe>'
    )


def told(kind: type[Filed], read: tuple[Any, ...], machine: Optional[Filed] = None) -> Any:
    """What was read, on that machine; what was assumed of it is a warning where the reading was asked
    for."""
    text, sentences, *sources = read
    for sentence in sentences:
        warnings.warn(sentence, stacklevel=3)
    return kind._of(text, [*(sources[0] if sources else ()), *sources_of(machine)])


def in_words(facts: dict[str, Any]) -> str:
    return ", ".join(f"{value} {key}" for key, value in facts.items())


def text_of(contents: dict[str, Any], file_type: str) -> str:
    """The text of a file with these contents; keys without a value are dropped."""
    head = {"file_type": file_type, "format_version": _core.format_version(file_type)}
    return json.dumps({**head, **{k: v for k, v in contents.items() if v is not None}})


def rows(numbers: Any, name: str, columns: int = 2) -> numpy.ndarray:
    """Returns an (n, columns) float64 array of finite numbers; raises ValueError otherwise."""
    array = numpy.asarray(numbers, dtype=numpy.float64)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}")
    bad = numpy.flatnonzero(~numpy.isfinite(array).all(axis=1))
    if bad.size:
        raise ValueError(f"{name}: row {bad[0]} holds a number that is none, or infinite")
    return array


def same_count(counts: dict[str, Optional[int]]) -> None:
    """Raises ValueError unless all arrays have as many rows as the first; None is skipped."""
    first, *others = counts
    for name in others:
        if counts[name] is not None and counts[name] != counts[first]:
            raise ValueError(f"{counts[first]} {first}, but {counts[name]} {name}")


def one_of(word: str, name: str, words: tuple[str, ...]) -> str:
    if word not in words:
        known = ", ".join(words[:-1]) + " or " + words[-1]
        raise ValueError(f'{name} is {known}, not "{word}"')
    return word
