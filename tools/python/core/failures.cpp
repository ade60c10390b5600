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

py::tuple fields_of(const grid::files::InputProblem& problem) {
  return py::make_tuple(problem.file, problem.place, problem.value, problem.expected,
                        problem.message());
}

py::tuple fields_of(const gcode::Problem& problem) {
  return py::make_tuple(problem.place.line, problem.place.column, gcode::name(problem.name),
                        problem.sentence);
}

py::list list_of(const auto& problems) {
  py::list fields;
  for (const auto& problem : problems) fields.append(fields_of(problem));
  return fields;
}

}  // namespace

void translate_failures() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    if (!thrown) return;
    try {
      std::rethrow_exception(thrown);
    } catch (const grid::files::InputError& error) {
      raise("InputError", error.what(), list_of(error.problems()));
    } catch (const cli::GcodeRefused& failure) {
      raise("GcodeError", failure.what(), list_of(failure.problems));
    } catch (const cli::Failed& failed) {
      raise("Failure", failed.what(), failed.reason);
    }
  });
}

}  // namespace chaintrue::python
