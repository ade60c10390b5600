#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the include graph: layers include downwards only, and folders of grid/ in no circle. And dense matrices of
any size are decomposed in interp/linear_algebra.cpp alone, and extremes taken by grid/containers.hpp, which knows that
nothing has none.

    layers.py SOURCE        prints every include that breaks a layer, every circle, every decomposition and every extreme
                            elsewhere; 1 where there is one
"""

import pathlib
import re
import sys
import tempfile

# What each layer may include besides itself, lowest layers first.
LAYERS = {
    "interp": set(),
    "model": set(),
    "grid": {"interp", "model"},
    "tools": {"interp", "model", "grid"},
}
# One header a library, for users: nothing in the project includes them.
FOR_USERS = ("interp/interp.hpp", "model/model.hpp", "grid/grid.hpp")
# Libraries of tools/ that are independent of the command line.
WITHOUT_COMMAND_LINE = ("tools/gcode", "tools/report")
# Decompositions are templates that take seconds to compile, and code for one processor (linear_algebra_kernels.hpp).
DECOMPOSING = ("interp/linear_algebra.hpp", "interp/linear_algebra.cpp", "interp/linear_algebra_kernels.cpp")
DECOMPOSITION = re.compile(
    r"\b(LLT|LDLT|PartialPivLU|FullPivLU|HouseholderQR|ColPivHouseholderQR|FullPivHouseholderQR|Tridiagonalization"
    r"|CompleteOrthogonalDecomposition|BDCSVD|JacobiSVD|(?:Generalized)?SelfAdjointEigenSolver|EigenSolver)<([^<>]*(?:<[^<>]*>)?[^<>]*)>")
DECOMPOSING_CALL = re.compile(
    r"\.(llt|ldlt|lu|partialPivLu|fullPivLu|householderQr|colPivHouseholderQr|fullPivHouseholderQr"
    r"|completeOrthogonalDecomposition|bdcSvd|jacobiSvd|selfadjointView)\b")
# Of a size known to the compiler, or of one with a bound.
SMALL = re.compile(r"Matrix[234]d|Matrix<double, \d+, \d+>|FewByFew")
EXTREME = re.compile(r"\bstd::(?:ranges::)?(?:min|max|minmax)_element\b")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def sources(root):
    for layer in LAYERS:
        for path in sorted((root / layer).rglob("*")):
            if path.suffix in (".cpp", ".hpp", ".def", ".inc"):
                yield path.relative_to(root)


def folder_of(path):
    """A folder of grid/, "grid" for what lies in grid/ itself, or the layer."""
    parts = pathlib.PurePosixPath(path).parts
    if parts[0] == "grid":
        return "/".join(parts[:2]) if len(parts) > 2 else "grid"
    return parts[0]


def broken_layer(path, included):
    if included in FOR_USERS:
        return "it is for users"
    layer, of_included = path.parts[0], pathlib.PurePosixPath(included).parts[0]
    if of_included in LAYERS and of_included != layer and of_included not in LAYERS[layer]:
        return f"{layer} must not include {of_included}"
    folder = "/".join(path.parts[:2])
    if folder in WITHOUT_COMMAND_LINE and included.startswith("tools/cli/"):
        return f"{folder} must not include tools/cli"
    if str(path) not in FOR_USERS and folder_of(path) == "grid" and folder_of(included).startswith("grid/"):
        return "what lies in grid/ itself must not include its folders"
    return ""


def decompositions(path, text):
    """What decomposes matrices of any size where it must not."""
    if path.parts[0] not in ("interp", "grid") or str(path) in DECOMPOSING:
        return
    for number, line in enumerate(text.splitlines(), 1):
        code = line.split("//")[0]
        for found in DECOMPOSITION.finditer(code):
            if not SMALL.search(found[2]):
                yield f"{path}:{number} {found[0]}: take interp/linear_algebra.hpp"
        for found in DECOMPOSING_CALL.finditer(code):
            yield f"{path}:{number} {found[0]}: take interp/linear_algebra.hpp, or name the fixed size"


def extremes(path, text):
    """Iterators to the largest, dereferenced where there may be none."""
    if path.parts[0] in ("grid", "tools") and str(path) != "grid/containers.hpp":
        for number, line in enumerate(text.splitlines(), 1):
            if EXTREME.search(line.split("//")[0]):
                yield f"{path}:{number} an extreme: take grid/containers.hpp, which refuses an empty range"


def circle(graph):
    """One circle of folders, in the order of includes; empty where there is none."""
    done = set()

    def visit(folder, way):
        if folder in way:
            return way[way.index(folder):] + [folder]
        if folder in done:
            return []
        for other in sorted(graph.get(folder, {})):
            found = visit(other, way + [folder])
            if found:
                return found
        done.add(folder)
        return []

    for folder in sorted(graph):
        found = visit(folder, [])
        if found:
            return found
    return []


def failures_of(root):
    failures = []
    graph = {}  # folder -> included folder -> the first include
    count = 0
    for path in sources(root):
        text = (root / path).read_text(encoding="utf-8")
        failures += decompositions(path, text)
        failures += extremes(path, text)
        for included in INCLUDE.findall(text):
            count += 1
            why = broken_layer(path, included)
            if why:
                failures.append(f'{path} includes "{included}": {why}')
            a, b = folder_of(path), folder_of(included)
            if a.startswith("grid/") and b.startswith("grid/") and a != b:
                graph.setdefault(a, {}).setdefault(b, f'{path} includes "{included}"')
    way = circle(graph)
    if way:
        failures.append("folders of grid/ include each other in a circle: " + " -> ".join(way))
        failures += ["  " + graph[a][b] for a, b in zip(way, way[1:])]
    return failures, count


def finds_what_is_broken():
    """A small tree with one of each fault."""
    files = {
        "interp/spline.hpp": '#include "model/machine.hpp"\n',
        "model/machine.hpp": "",
        "grid/progress.hpp": '#include "grid/map/fit.hpp"\n',
        "grid/map/fit.hpp": '#include "grid/estimation/estimate.hpp"\n',
        "grid/estimation/estimate.hpp": '#include "grid/observation/observation.hpp"\n',
        "grid/observation/observation.hpp": '#include "grid/map/fit.hpp"\n',
        "tools/cli/chart.cpp": "const double most = *std::max_element(all.begin(), all.end());\n",
        "tools/report/page.hpp": '#include "tools/cli/verb.hpp"\n#include "model/model.hpp"\n',
        "grid/map/covariance.cpp": "const Eigen::LLT<Eigen::MatrixXd> factor(m);\nauto x = m.ldlt().solve(b);\n"
                                   "const Eigen::LLT<Eigen::Matrix2d> small(n);\n",
    }
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        found = "\n".join(failures_of(root)[0])
    return "Matrix2d" not in found and all(word in found for word in (
        "chart.cpp:1 an extreme", "covariance.cpp:1 LLT<Eigen::MatrixXd>", "covariance.cpp:2 .ldlt",
        "interp must not include model", "tools/report must not include tools/cli",
        "it is for users",
        "what lies in grid/ itself", "grid/estimation -> grid/observation -> grid/map -> grid/estimation"))


def main():
    failures, count = failures_of(pathlib.Path(sys.argv[1]))
    if count < 1000:
        failures.append(f"only {count} includes were found: is {sys.argv[1]} the source?")
    if not finds_what_is_broken():
        failures.append("the script does not find the faults of a tree that has them")
    print("\n".join(failures) if failures else f"{count} includes, no layer broken, no circle")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
