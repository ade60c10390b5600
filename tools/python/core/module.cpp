// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue._core: the libraries for Python. The user interface and its documentation are in the
/// package's Python.
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {

PYBIND11_MODULE(_core, module) {
  module.attr("__version__") = CHAINTRUE_VERSION;
  translate_failures();
  add_measured(module);
  add_maps(module);
  add_plans(module);
  add_run(module);
}

}  // namespace chaintrue::python
