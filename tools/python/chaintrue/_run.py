# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the command's verbs in this process: files in, files out."""

from __future__ import annotations

import pathlib
import tempfile
from typing import NamedTuple, Sequence, Union

from . import _core
from ._errors import Failure, InputError

_CHECK_FAILED = 1
"""The exit code of a verb that did its work, and whose answer is no."""


class File(NamedTuple):
    """An input of a run."""

    name: str
    text: str


def run(*words: Union[str, File], out: Sequence[str]) -> tuple[dict[str, str], str]:
    """Runs `chaintrue WORDS` in a folder of its own, with the Files among the words in it.

    out  words that name a file that the run writes

    Returns these files' texts by name, and what the run printed. Raises InputError and Failure.
    """
    with tempfile.TemporaryDirectory(prefix="chaintrue-") as scratch:
        folder = pathlib.Path(scratch)
        line = []
        for number, word in enumerate(words):
            if isinstance(word, File):
                path = folder / str(number) / word.name
                path.parent.mkdir()
                path.write_bytes(word.text.encode("utf-8", "surrogateescape"))
                line.append(str(path))
            else:
                line.append(str(folder / word) if word in out else word)
        try:
            code, printed = _core.run(line)
        except InputError as error:
            raise _named_by_name(error, scratch) from None
        if code > _CHECK_FAILED:
            raise Failure(printed.replace(f"{scratch}/", "").strip())
        return {name: (folder / name).read_text("utf-8") for name in out}, printed


def _named_by_name(error: InputError, folder: str) -> InputError:
    """The same error; files in the run's folder by their names alone."""

    def named(text: str) -> str:
        begin = text.find(f"{folder}/")
        if begin < 0:
            return text
        _, _, rest = text[begin + len(folder) + 1 :].partition("/")
        return named(text[:begin] + rest)

    return InputError(named(str(error)), [tuple(map(named, problem)) for problem in error.problems])
