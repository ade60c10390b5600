// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What cannot be done with sound input, on its way to chaintrue.Failure and chaintrue.GcodeError:
/// the sentence for a person, and the reason by the name that the library has for it.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/options.hpp"
#include "grid/map/check.hpp"
#include "grid/map/fit.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "tools/gcode/problem.hpp"

namespace chaintrue::python {

[[nodiscard]] std::string_view name_of(grid::FitFailure::Reason reason);
[[nodiscard]] std::string_view name_of(grid::BeltsFitFailure::Reason reason);
[[nodiscard]] std::string_view name_of(grid::diagnosis::DiagnosisFailure::Reason reason);
[[nodiscard]] std::string_view name_of(grid::CheckFailure::Reason reason);
[[nodiscard]] std::string_view name_of(grid::PlanFailure::Reason reason);

struct Failure : std::runtime_error {
  Failure(std::string_view why, const std::string& sentence)
      : std::runtime_error(sentence), reason(why) {}
  std::string reason;
};

/// A program that is refused, with every line that has a problem.
struct GcodeFailure : std::runtime_error {
  GcodeFailure(const std::string& sentence, std::vector<gcode::Problem> found)
      : std::runtime_error(sentence), problems(std::move(found)) {}
  std::vector<gcode::Problem> problems;
};

template <class Expected>
auto value_or_throw(Expected result) {
  if (!result) throw Failure(name_of(result.error().reason), result.error().sentence());
  return *std::move(result);
}

/// From here on a Failure, a GcodeFailure and an InputError arrive in Python as the exceptions of
/// chaintrue/_errors.py.
void translate_failures();

}  // namespace chaintrue::python
