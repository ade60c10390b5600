# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers as records and as columns for pandas, if it is installed."""

from __future__ import annotations

import importlib
from html import escape
from typing import Any, Callable, Iterable, Iterator, Optional

from ._errors import MissingPackage


class Record(dict):
    """A dictionary whose keys are attributes too: record.rms_mm is record["rms_mm"]."""

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no {name} here, but {', '.join(self)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]

    @classmethod
    def of(cls, value: Any) -> Any:
        """The same with every dictionary in it a record; this class for the outermost."""
        if isinstance(value, dict):
            return cls({key: Record.of(one) for key, one in value.items()})
        if isinstance(value, list):
            return [cls.of(one) for one in value]
        return value


class Tabled:
    """What has columns()."""

    columns: Callable[[], dict[str, list[Any]]]

    def to_frame(self) -> Any:
        """A pandas.DataFrame of columns(). Raises MissingPackage where pandas is not installed."""
        return needed("pandas", "A data frame").DataFrame(self.columns())

    def _repr_html_(self) -> str:
        return table(self.columns())


class Records(Tabled, list):
    """A list of records, one after the other."""

    def columns(self) -> dict[str, list[Any]]:
        """A list for each key, a value for each record, None where a record lacks it. What lies
        deeper has the keys on the way joined by dots: parameters.elongation.value."""
        rows = [dict(_flat(record)) for record in self]
        keys = list(dict.fromkeys(key for row in rows for key in row))
        return {key: [row.get(key) for row in rows] for key in keys}


def records(values: Optional[Iterable[dict]], kind: type[Record] = Record) -> Records:
    return Records(kind.of(value) for value in values or ())


def needed(package: str, purpose: str, module: str = "") -> Any:
    """The module, or MissingPackage."""
    try:
        return importlib.import_module(module or package)
    except ModuleNotFoundError as missing:
        if (missing.name or "").partition(".")[0] != package:  # it is there, and lacks something itself
            raise
        raise MissingPackage(package, purpose) from None


def table(columns: dict[str, Any]) -> str:
    """These columns as a table for a notebook; numbers to five digits."""
    head = "".join(f"<th>{escape(str(key))}</th>" for key in columns)
    rows = "".join(
        "<tr>" + "".join(f"<td>{escape(_short(value))}</td>" for value in row) + "</tr>"
        for row in zip(*columns.values())
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _short(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def _flat(record: dict, before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in record.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{key}.")
        else:
            yield before + key, value
