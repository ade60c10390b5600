// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/option_checks.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/containers.hpp"
#include "tools/cli/places.hpp"

namespace chaintrue::cli {

void OptionProblems::add(std::string_view option, std::string value, std::string expected,
                         ProblemKind kind) {
  problems_.push_back(
      {"command line", std::string(option), std::move(value), std::move(expected), {}, kind});
}

void OptionProblems::require(std::string_view option, double value, double least, double most) {
  if (value >= least && value <= most) return;
  add(option, fmt::format("{}", value), fmt::format("a number from {} to {}", least, most),
      ProblemKind::out_of_range);
}

void OptionProblems::take_from(const std::function<void()>& check) {
  try {
    check();
  } catch (const InputError& error) {
    grid::append_all(problems_, error.problems());
  }
}

void OptionProblems::throw_if_any() const {
  if (!problems_.empty()) throw InputError(problems_);
}

Declared& declared() {
  static Declared all;
  return all;
}

void add_option_check(Verb verb, std::function<void(OptionProblems&)> check) {
  declared().checks.push_back({verb, std::move(check)});
}

void check_command_line() {
  OptionProblems problems;
  problems.take_from([] { declared().misread.throw_if_any(); });
  for (const DeclaredCheck& one : declared().checks) {
    if (one.verb.is_chosen()) one.check(problems);
  }
  problems.take_from(check_places);
  problems.throw_if_any();
}

}  // namespace chaintrue::cli
