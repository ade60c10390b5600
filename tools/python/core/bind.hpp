// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue._core, part by part: each function adds its functions to the module. Private to
/// tools/python; what a user sees is the package's Python.
///
/// Verbs run as the command runs them (run.cpp). Beside them are the readers, and what takes and gives arrays.
/// Everything that has a file is the text of this file, both ways. Arrays are float64 of shape (n, 2); NaN if there is
/// no answer, which Python masks.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "grid/files/holes_file.hpp"

namespace chaintrue::python {

namespace py = pybind11;
using namespace py::literals;  // NOLINT(google-build-using-namespace): "key"_a

using Pairs = py::array_t<double, py::array::c_style | py::array::forcecast>;
/// (n, columns), without an answer yet: NaN.
[[nodiscard]] Pairs new_rows(std::size_t count, std::size_t columns = 2);

/// Texts of chaintrue_grid, chaintrue_holes and chaintrue_belts files, grids first.
using Texts = std::vector<std::string>;
/// As written by this module: a few points or distances are enough for a check.
[[nodiscard]] grid::MeasuredGrid grid_of(const std::string& text);
[[nodiscard]] grid::files::ReadHoles holes_of(const std::string& text);
/// From here on files::InputError, cli::Failed and cli::GcodeRefused arrive in Python as the exceptions of
/// chaintrue/_errors.py.
void translate_failures();

void add_measured(py::module_& module);
void add_maps(py::module_& module);
void add_plans(py::module_& module);
void add_run(py::module_& module);

}  // namespace chaintrue::python
