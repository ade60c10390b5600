// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/python/core/failures.hpp"

#include "tools/python/core/bind.hpp"

namespace chaintrue::python {

// No switch has a default: a reason without a name is a warning of the compiler.
#define CHAINTRUE_REASON(name) \
  case Reason::name:           \
    return #name

std::string_view name_of(grid::FitFailure::Reason reason) {
  using Reason = grid::FitFailure::Reason;
  switch (reason) {
    CHAINTRUE_REASON(no_machine);
    CHAINTRUE_REASON(not_a_grid);
    CHAINTRUE_REASON(no_lengths);
    CHAINTRUE_REASON(point_unreachable);
    CHAINTRUE_REASON(rank_deficient);
    CHAINTRUE_REASON(impossible_readings);
    CHAINTRUE_REASON(not_converged);
  }
  return "";
}

std::string_view name_of(grid::BeltsFitFailure::Reason reason) {
  using Reason = grid::BeltsFitFailure::Reason;
  switch (reason) {
    CHAINTRUE_REASON(too_few_points);
    CHAINTRUE_REASON(not_determined);
    CHAINTRUE_REASON(no_frame);
    CHAINTRUE_REASON(hole_without_anchors);
    CHAINTRUE_REASON(too_many_distances);
    CHAINTRUE_REASON(tape_contradicts);
  }
  return "";
}

std::string_view name_of(grid::diagnosis::DiagnosisFailure::Reason reason) {
  using Reason = grid::diagnosis::DiagnosisFailure::Reason;
  switch (reason) {
    CHAINTRUE_REASON(no_machine);
    CHAINTRUE_REASON(no_lengths);
    CHAINTRUE_REASON(too_few_points);
    CHAINTRUE_REASON(no_noise);
    CHAINTRUE_REASON(point_unreachable);
    CHAINTRUE_REASON(contradictory_settings);
  }
  return "";
}

std::string_view name_of(grid::CheckFailure::Reason reason) {
  using Reason = grid::CheckFailure::Reason;
  switch (reason) {
    CHAINTRUE_REASON(too_many_readings);
    CHAINTRUE_REASON(no_machine);
    CHAINTRUE_REASON(no_lengths);
    CHAINTRUE_REASON(unreachable);
    CHAINTRUE_REASON(no_noise);
    CHAINTRUE_REASON(nowhere);
  }
  return "";
}

std::string_view name_of(grid::PlanFailure::Reason reason) {
  using Reason = grid::PlanFailure::Reason;
  switch (reason) {
    CHAINTRUE_REASON(no_machine);
    CHAINTRUE_REASON(unreachable);
    CHAINTRUE_REASON(too_few_places);
    CHAINTRUE_REASON(no_map);
  }
  return "";
}

#undef CHAINTRUE_REASON

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

py::list problems_of(const GcodeFailure& failure) {
  py::list problems;
  for (const gcode::Problem& problem : failure.problems) {
    problems.append(py::make_tuple(problem.place.line,
                                   problem.place.column,
                                   std::string(gcode::name(problem.name)),
                                   problem.sentence));
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
    } catch (const GcodeFailure& failure) {
      raise("GcodeError", std::string(failure.what()), problems_of(failure));
    } catch (const Failure& failure) {
      raise("Failure", std::string(failure.what()), failure.reason);
    }
  });
}

}  // namespace chaintrue::python
