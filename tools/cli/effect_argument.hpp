// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Effects on the command line: `id:side:key=value,key=value`, `-` for no side.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/input_error.hpp"
#include "model/machine.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Collects all problems of a command's values and throws them together.
class OptionProblems {
 public:
  void add(std::string_view option, std::string value, std::string expected, ProblemKind kind);
  /// `value` is finite and within [least, most].
  void require(std::string_view option, double value, double least, double most);
  /// Adds the problems of an InputError thrown by `check`.
  void take_from(const std::function<void()>& check);
  void throw_if_any() const;

 private:
  std::vector<files::InputProblem> problems_;
};

/// The effects that `--effect` named, one for each argument, not checked against any catalogue. An
/// argument of another form is a problem, as is an effect without a name.
[[nodiscard]] std::vector<AppliedEffect> parse_effect_words(const Words& arguments,
                                                            OptionProblems& problems);

/// The effects that `--effect` named, checked against the catalogue as effects of `machine` in addition to
/// its own.
[[nodiscard]] std::vector<AppliedEffect> parse_effects(const Words& arguments,
                                                       const Machine& machine,
                                                       OptionProblems& problems);

struct NamedNumber {
  std::string name;
  double value = 0.0;
};
/// `name=number`; empty for any other text.
[[nodiscard]] std::optional<NamedNumber> named_number(std::string_view text);

}  // namespace chaintrue::cli
