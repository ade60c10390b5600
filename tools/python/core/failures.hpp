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

#include "tools/gcode/problem.hpp"

namespace chaintrue::python {

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

/// An enumerator as the compiler spells it: "[with auto kReason = chaintrue::grid::FitReason::no_machine;".
template <auto kReason>
[[nodiscard]] constexpr std::string_view spelled() {
  std::string_view text = __PRETTY_FUNCTION__;
  text.remove_prefix(text.find("kReason = "));
  text = text.substr(0, text.find_first_of(";]"));
  return text.substr(text.rfind(':') + 1);
}

static_assert(spelled<gcode::ProblemName::outside_map>() == "outside_map");

/// Of an enumeration that counts from 0 to at most 15: the name of its enumerator.
template <class Reason, int... kValues>
[[nodiscard]] std::string_view name_of(Reason reason, std::integer_sequence<int, kValues...>) {
  constexpr std::string_view kNames[] = {spelled<static_cast<Reason>(kValues)>()...};
  return kNames[static_cast<std::size_t>(reason)];
}

template <class Expected>
auto value_or_throw(Expected result) {
  if (result) return *std::move(result);
  throw Failure(name_of(result.error().reason, std::make_integer_sequence<int, 16>()),
                result.error().sentence());
}

/// From here on a Failure, a GcodeFailure and an InputError arrive in Python as the exceptions of
/// chaintrue/_errors.py.
void translate_failures();

}  // namespace chaintrue::python
