// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/option_checks.hpp"

#include <utility>
#include <vector>

#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"

namespace chaintrue::cli {
namespace {

struct OptionCheck {
  Verb verb;
  std::function<void(OptionProblems&)> check;
};

/// Of the current command line.
std::vector<OptionCheck>& checks() {
  static std::vector<OptionCheck> all;
  return all;
}

}  // namespace

void add_option_check(Verb verb, std::function<void(OptionProblems&)> check) {
  checks().push_back({verb, std::move(check)});
}

void begin_command_line() {
  checks().clear();
  forget_option_rules();
  forget_numbers();
  forget_places();
}

void check_command_line() {
  OptionProblems problems;
  problems.take_from(check_numbers);
  for (const OptionCheck& one : checks()) {
    if (one.verb.is_chosen()) one.check(problems);
  }
  problems.take_from(check_places);
  problems.throw_if_any();
}

}  // namespace chaintrue::cli
