// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numeric options, with the rules of numbers in files (grid/files/number_text.hpp): the same
/// ranges and messages, all problems at once, exit code 3. NaN and infinity are rejected.
///
/// \code
///   add_number(verb, "--noise-dof", input.noise_dof, files::kNoiseDof, "How well known");
/// \endcode
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "grid/files/number_text.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

namespace detail {
/// `take` gets a number in the range.
Option add_number(Verb verb,
                  const std::string& names,
                  const files::Range& range,
                  bool is_whole,
                  const std::string& help,
                  std::function<void(double)> take,
                  std::optional<double> shown_default = {});
}  // namespace detail

/// `value` is double, a whole number, or optional of either; a default is shown.
template <class T>
Option add_number(Verb verb,
                  const std::string& names,
                  T& value,
                  const files::Range& range,
                  const std::string& help) {
  return detail::add_number(
      verb,
      names,
      range,
      std::is_integral_v<T>,
      help,
      [&value](double number) { value = static_cast<T>(number); },
      static_cast<double>(value));
}
template <class T>
Option add_number(Verb verb,
                  const std::string& names,
                  std::optional<T>& value,
                  const files::Range& range,
                  const std::string& help) {
  return detail::add_number(
      verb, names, range, std::is_integral_v<T>, help, [&value](double number) {
        value = static_cast<T>(number);
      });
}

/// One of several numbers.
Option add_numbers(Verb verb,
                   const std::string& names,
                   std::vector<double>& values,
                   const files::Range& range,
                   const std::string& help);

/// After parsing. \throws InputError with every invalid or out-of-range number.
void check_numbers();
/// Before another command line in this process.
void forget_numbers();

}  // namespace chaintrue::cli
