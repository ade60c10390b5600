// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue._core, part by part: each function adds its functions to the module. Private to
/// tools/python; what a user sees is the package's Python.
///
/// Verbs run as the command runs them (run.cpp). Beside them are the readers, and what takes and gives arrays.
/// Everything that has a file is the text of this file, both ways. Arrays are float64 of shape (n, 2); NaN if there is
/// no answer, which Python masks.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace chaintrue::python {

namespace py = pybind11;
using namespace py::literals;  // NOLINT(google-build-using-namespace): "key"_a

/// From here on files::InputError, cli::Failed and cli::GcodeRefused arrive in Python as the exceptions of
/// chaintrue/_errors.py.
void translate_failures();

void add_measured(py::module_& module);
void add_maps(py::module_& module);
void add_plans(py::module_& module);
void add_run(py::module_& module);

}  // namespace chaintrue::python
