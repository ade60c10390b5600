// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How each verb is called: the one table for the tests of inputs, the option matrix and the campaign of
/// tests/lab/torture. "@" begins the name of a file of the folder (input_folder.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/cli/arguments.hpp"

namespace chaintrue::inputs {

/// A verb on one kind of input: a row of invocations.tsv.
struct Invocation {
  std::string verb;  ///< "fit", "gcode check"
  std::string name;  ///< of the kind of input
  cli::Facts facts;  ///< what options depend on (tools/cli/arguments.hpp)
  std::string line;
};
const std::vector<Invocation>& invocations();

/// The rules of all verbs, in the order in which the verbs are made.
const std::vector<cli::OptionRule>& rules();

/// The first rule of the command that refuses the option there; null where it acts.
inline const cli::OptionRule* refusal_of(std::string_view verb, std::string_view option,
                                         cli::Facts facts) {
  for (const cli::OptionRule& rule : rules()) {
    if (rule.verb == verb && rule.option == option && (rule.acts_on & facts) == 0) return &rule;
  }
  return nullptr;
}

/// The option's row of values.tsv; empty without one.
const std::vector<std::string>& values_of(const std::string& option);

}  // namespace chaintrue::inputs
