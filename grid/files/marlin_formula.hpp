// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Conditions and formulas of C, as far as Marlin's Configuration.h has them. Private to grid/files.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "grid/files/blanks.hpp"
#include "grid/files/parse_double.hpp"

namespace chaintrue::grid::files {

/// No formula of a Configuration.h is longer, once its names are replaced.
inline constexpr std::size_t kLongestFormula = 500;

inline bool is_of_a_name(char c) { return c == '_' || is_letter(c) || is_digit(c); }
inline bool begins_a_number(char c) { return c == '.' || is_digit(c); }

/// Words and signs, one after another.
struct CodeReader {
  std::string_view rest;

  bool takes(std::string_view sign) {
    rest = trimmed(rest);
    if (!rest.starts_with(sign)) return false;
    rest.remove_prefix(sign.size());
    return true;
  }
  std::string word() {
    rest = trimmed(rest);
    std::size_t end = 0;
    while (end < rest.size() && is_of_a_name(rest[end])) ++end;
    std::string own(rest.substr(0, end));
    rest.remove_prefix(end);
    return own;
  }
  bool is_at_end() const { return trimmed(rest).empty(); }
};

/// The value of a formula or of the condition of an #if, in which 1 is true and 0 is false.
struct FormulaValue {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< if the text is neither
  std::optional<double> cut;  ///< a quotient of whole numbers that is not whole
};
/// Whether a name is so.
using AskedName = std::function<bool(const std::string& name)>;
FormulaValue value_of_formula(std::string_view text, const AskedName& is_enabled,
                              const AskedName& is_defined);

}  // namespace chaintrue::grid::files
