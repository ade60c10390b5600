// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Effects on the command line: `id:side:key=value,key=value`, `-` for no side.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/machine.hpp"
#include "tools/cli/names.hpp"
#include "tools/cli/option_checks.hpp"

namespace chaintrue::cli {

/// The effects that `--effect` named, one for each argument, not checked against any catalogue. An
/// argument of another form is a problem, as is an effect without a name.
std::vector<AppliedEffect> parse_effect_words(const Words& arguments, OptionProblems& problems);

/// The effects that `--effect` named, checked against the catalogue as effects of `machine` in addition to
/// its own.
std::vector<AppliedEffect> parse_effects(const Words& arguments, const Machine& machine,
                                         OptionProblems& problems);

struct NamedNumber {
  std::string name;
  double value = 0.0;
};
/// `name=number`; empty for any other text.
std::optional<NamedNumber> named_number(std::string_view text);

}  // namespace chaintrue::cli
