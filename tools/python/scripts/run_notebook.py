#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the cells of a notebook one after the other, without Jupyter, and prints what each shows.

    run_notebook.py NOTEBOOK...     where a cell fails, the error shows its number
"""

import ast
import json
import pathlib
import sys


def cells(path):
    """The code of each code cell, with its number among all cells from 1."""
    notebook = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    for number, cell in enumerate(notebook["cells"], start=1):
        if cell["cell_type"] == "code":
            yield number, "".join(cell["source"])


def run_cell(code, name, names):
    """Runs a cell; its value is that of its last line where this is an expression."""
    tree = ast.parse(code, name)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, name, "exec"), names)
    if last is None:
        return None
    return eval(compile(ast.Expression(last.value), name, "eval"), names)


def shown(value):
    """What a notebook shows of a value: its own HTML, or its repr."""
    if hasattr(value, "_repr_html_"):
        return f"{value!r}\n[{len(value._repr_html_())} characters of HTML]"
    return repr(value)


def run(path):
    """The names that the notebook leaves behind. Raises what a cell raises."""
    names = {"__name__": "__main__"}
    for number, code in cells(path):
        value = run_cell(code, f"{path}, cell {number}", names)
        if value is not None:
            print(f"[{number}] {shown(value)}")
    return names


if __name__ == "__main__":
    for notebook in sys.argv[1:]:
        run(notebook)
