# SPDX-License-Identifier: GPL-3.0-or-later
"""What everything that has a file shares: its contents, equality, pickle, and a notebook's view."""

from __future__ import annotations

import html
import json
import os
import warnings
from typing import Any, Callable, ClassVar, Optional, Sequence, Union

import numpy

from . import _core
from ._records import Record, table

PathLike = Union[str, "os.PathLike[str]"]
"""A path of a file."""
Sources = Sequence[tuple[str, str]]
"""Files that were read, by name without folders and SHA-256."""


class Filed:
    """A thing of the library, with the text of its file. It does not change."""

    _core: Any
    _sources: Sources
    _parse: ClassVar[Callable[[str, str], tuple[Any, list[str]]]]

    def __init__(self, core: Any, sources: Sources = ()):
        self._core = core
        self._sources = tuple(sources)

    @classmethod
    def _of(cls, core: Any, sources: Sources = ()) -> Any:
        thing = cls.__new__(cls)
        Filed.__init__(thing, core, sources)
        return thing

    def to_dict(self) -> dict[str, Any]:
        """The contents of its JSON file (docs/formats) as dictionaries and lists."""
        return json.loads(self._text())

    def write(self, path: PathLike) -> None:
        """Writes its JSON file, whole or not at all; the same object gives the same bytes."""
        _core.write(os.fspath(path), self._text())

    @property
    def name(self) -> str:
        """What it is called in its file."""
        return self._core.name

    @classmethod
    def from_dict(cls, contents: dict[str, Any]) -> Any:
        """The thing whose to_dict() this is, held to what a file is held to."""
        text = json.dumps(contents)
        made_by = _core.made_by(text) if issubclass(cls, Made) else None
        return told((*cls._parse(text, "the dictionary"), (), made_by), cls)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self._text(), self._sources)

    def _text(self) -> str:
        """Of its file."""
        return self._core.text()

    def _content(self) -> str:
        """The same without where it comes from: what makes two of them equal."""
        return self._core.text()

    def __repr__(self) -> str:
        facts = ", ".join(f"{value} {key}" for key, value in self._facts().items())
        return f"<chaintrue.{type(self).__name__} {self.name!r}: {facts}>"

    def _facts(self) -> dict[str, Any]:
        """What repr and a notebook tell, a value for each word."""
        return {}

    def _repr_html_(self) -> str:
        return facts_table(f"{type(self).__name__} {self.name}", self._facts())


MadeBy = Optional[tuple[str, str, list[str], Sources]]
"""Version, verb, options and inputs of where a result comes from."""


class Made(Filed):
    """A result, which knows what it was made from, and has a page of its own, which a notebook shows."""

    _made_by: MadeBy = None

    @classmethod
    def _made(cls, core: Any, verb: str, options: dict[str, Any], sources: Sources) -> Any:
        """The result of such a call; options as those of the command, without what was not given."""
        thing = cls._of(core)
        given = [
            option if value is True else f"{option} {value}"
            for option, value in options.items()
            if value is not None and value is not False
        ]
        thing._made_by = (_core.__version__, verb, given, list(sources))
        return thing

    @property
    def made_by(self) -> Optional[Record]:
        """version, verb, options, and inputs with name and sha256 of each file that was read; None
        where that is not known."""
        if self._made_by is None:
            return None
        version, verb, options, sources = self._made_by
        inputs = [{"name": name, "sha256": sha256} for name, sha256 in sources]
        return Record.of({"version": version, "verb": verb, "options": options, "inputs": inputs})

    def _text(self) -> str:
        return self._core.text(self._made_by)

    def _content(self) -> str:
        return self._core.text(None)

    def _page(self, source: str) -> str:
        return self._core.page(source, self._made_by)

    def _repr_html_(self) -> str:
        return framed(self._page("Python"))


def _again(kind: type[Filed], text: str, sources: Sources) -> Any:
    """What was pickled."""
    made_by = _core.made_by(text) if issubclass(kind, Made) else None
    return told((*kind._parse(text, f"the stored {kind.__name__}"), sources, made_by), kind)


def read_made(path: PathLike, kind: type[Made]) -> tuple[Any, list[str], Sources, MadeBy]:
    """For told()."""
    text, sources = _core.read_text(os.fspath(path))
    return (*kind._parse(text, os.fspath(path)), sources, _core.made_by(text))


def sources_of(*things: Optional[Filed]) -> list[tuple[str, str]]:
    """The files of all of them, each once."""
    return list(dict.fromkeys(source for thing in things if thing is not None for source in thing._sources))


def facts_table(title: str, facts: dict[str, Any]) -> str:
    """A table with a row for each fact; "mm error" is called "error, mm"."""
    names = [f"{key[3:]}, mm" if key.startswith("mm ") else key for key in facts]
    values = [str(fact) for fact in facts.values()]
    return f"<b>{html.escape(title)}</b>" + table({"": names, " ": values})


def framed(page: str, height: int = 640) -> str:
    """A whole page inside a notebook's: neither sees the other's style."""
    return (
        f'<iframe sandbox="allow-scripts" srcdoc="{html.escape(page)}" '
        f'style="width:100%;height:{height}px;border:0"></iframe>'
    )


def told(read: tuple[Any, ...], kind: type[Filed], machine: Optional[Filed] = None) -> Any:
    """What was read, on that machine; what was assumed of it is a warning where the reading was asked
    for."""
    core, sentences, sources, *made_by = read
    for sentence in sentences:
        warnings.warn(sentence, stacklevel=3)
    thing = kind._of(core, [*sources, *sources_of(machine)])
    if isinstance(thing, Made):
        thing._made_by = made_by[0]
    return thing


def text_of(contents: dict[str, Any], file_type: str) -> str:
    """A file's text of contents made here; keys without a value are left out."""
    head = {"file_type": file_type, "format_version": _core.format_version(file_type)}
    return json.dumps({**head, **{k: v for k, v in contents.items() if v is not None}})


def rows(numbers: Any, name: str, columns: int = 2) -> numpy.ndarray:
    """An (n, columns) float64 array of finite numbers, or ValueError."""
    array = numpy.asarray(numbers, dtype=numpy.float64)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name} must have the shape (n, {columns}), not {array.shape}")
    bad = numpy.flatnonzero(~numpy.isfinite(array).all(axis=1))
    if bad.size:
        raise ValueError(f"{name}: row {bad[0]} holds a number that is none, or infinite")
    return array


def same_count(counts: dict[str, Optional[int]]) -> None:
    """That all have as many rows as the first, None where there is no such list; or ValueError."""
    first, *others = counts
    for name in others:
        if counts[name] is not None and counts[name] != counts[first]:
            raise ValueError(f"{counts[first]} {first}, but {counts[name]} {name}")


def in_range(value: Any, name: str, least: float, most: float) -> Any:
    """The number, or ValueError that says its range."""
    if not least <= value <= most:
        raise ValueError(f"{name} is {value}, but must be {least} to {most}")
    return value


def one_of(word: str, name: str, words: tuple[str, ...]) -> str:
    if word not in words:
        known = ", ".join(words[:-1]) + " or " + words[-1]
        raise ValueError(f'{name} is {known}, not "{word}"')
    return word
