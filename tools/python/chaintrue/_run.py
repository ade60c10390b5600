# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the command's verbs in this process: files in, files out."""

from __future__ import annotations

import pathlib
import re
import tempfile
from typing import NamedTuple, Optional, Sequence, Union

from . import _core
from ._errors import Failure, InputError

_CHECK_FAILED = 1
"""The exit code of a verb that did its work, and whose answer is no."""


class File(NamedTuple):
    """An input of a run."""

    name: str
    text: str


def run(
    *words: Union[str, File],
    out: Sequence[str] = (),
    sources: Optional[Sequence[tuple[str, str]]] = None,
) -> tuple[dict[str, str], str, str]:
    """Runs `chaintrue WORDS` in a folder of its own, with the Files among the words in it.

    out      words that name a file that the run writes
    sources  names and SHA-256 of the files that a result is made from, in place of the run's Files

    Returns these files' texts by name, standard output and standard error. Raises InputError and Failure.
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

        def by_name(text: str) -> str:
            return re.sub(rf"{re.escape(scratch)}/(\d+/)?", "", text)

        try:
            code, printed, said = _core.run(line, sources)
        except InputError as error:
            problems = [tuple(map(by_name, problem)) for problem in error.problems]
            raise InputError(by_name(str(error)), problems) from None
        if code > _CHECK_FAILED:
            raise Failure(by_name(said).strip())
        texts = {name: (folder / name).read_bytes().decode("utf-8", "surrogateescape") for name in out}
        return texts, printed, said
