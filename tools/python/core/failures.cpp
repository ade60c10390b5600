// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/input_error.hpp"
#include "tools/cli/gcode_job.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {
namespace {

template <class... Arguments>
void raise(const char* name, const Arguments&... arguments) {
  const py::object type = py::module_::import("chaintrue._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(arguments...).ptr());
}

py::list problems_of(const grid::files::InputError& error) {
  py::list problems;
  for (const grid::files::InputProblem& problem : error.problems()) {
    problems.append(py::make_tuple(
        problem.file, problem.place, problem.value, problem.expected, problem.message()));
  }
  return problems;
}

py::list problems_of(const cli::GcodeRefused& failure) {
  py::list problems;
  for (const gcode::Problem& problem : failure.problems) {
    problems.append(py::make_tuple(
        problem.place.line, problem.place.column, gcode::name(problem.name), problem.sentence));
  }
  return problems;
}

}  // namespace

void translate_failures() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    if (!thrown) return;
    try {
      std::rethrow_exception(thrown);
    } catch (const grid::files::InputError& error) {
      raise("InputError", std::string(error.what()), problems_of(error));
    } catch (const cli::GcodeRefused& failure) {
      raise("GcodeError", std::string(failure.what()), problems_of(failure));
    } catch (const cli::Failed& failed) {
      raise("Failure", std::string(failed.what()), failed.reason());
    }
  });
}

}  // namespace chaintrue::python
