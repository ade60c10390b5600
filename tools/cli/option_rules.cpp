// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/option_rules.hpp"

#include <string>

#include "tools/cli/effect_argument.hpp"

namespace chaintrue::cli {

void refuse_what_does_nothing(Verb verb, Facts facts) {
  const std::string path = verb.path();
  OptionProblems problems;
  std::string_view refused;
  for (const OptionRule& rule : kOptionRules) {
    if (rule.verb != path || (rule.acts_on & facts) != 0 || rule.option == refused) continue;
    const std::string option(rule.option);
    if (!verb.is_given(option)) continue;
    const std::string value = verb.value_of(option);
    if (!rule.harmless.empty() && value == rule.harmless) continue;
    problems.add(option, value, std::string(rule.otherwise), grid::ProblemKind::option_without_use);
    refused = rule.option;
  }
  problems.throw_if_any();
}

}  // namespace chaintrue::cli
