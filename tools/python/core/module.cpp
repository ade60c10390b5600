// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue._core: the libraries for Python. The user interface and its documentation are in the
/// package's Python.
#include "tools/python/core/bind.hpp"

PYBIND11_MODULE(_core, module) {
  module.attr("__version__") = CHAINTRUE_VERSION;
  chaintrue::python::translate_failures();
  chaintrue::python::add_measured(module);
  chaintrue::python::add_maps(module);
  chaintrue::python::add_plans(module);
  chaintrue::python::add_run(module);
}
