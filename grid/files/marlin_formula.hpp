// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Conditions and formulas of C, as far as Marlin's Configuration.h has them. Private to grid/files.
#pragma once

#include <cctype>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "grid/files/blanks.hpp"

namespace chaintrue::grid::files {

/// No formula of a Configuration.h is longer, once its names are replaced.
inline constexpr std::size_t kLongestFormula = 500;

inline bool is_of_a_name(char c) {
  return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
}
inline bool begins_a_number(char c) {
  return c == '.' || std::isdigit(static_cast<unsigned char>(c)) != 0;
}

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

/// Empty if the file does not state it.
using Truth = std::optional<bool>;

inline Truth negated(Truth a) { return a ? Truth(!*a) : a; }
inline Truth both_hold(Truth a, Truth b) {
  if (a == Truth(false) || b == Truth(false)) return false;
  return a && b ? Truth(true) : std::nullopt;
}
inline Truth one_holds(Truth a, Truth b) { return negated(both_hold(negated(a), negated(b))); }

/// Evaluates the condition of an #if.
Truth truth_of(std::string_view condition, std::function<bool(const std::string& name)> is_enabled,
               std::function<bool(const std::string& name)> is_defined);

struct FormulaValue {
  double value = 0.0;         ///< NaN if the text is not a formula
  std::optional<double> cut;  ///< a quotient of whole numbers that is not whole
};
FormulaValue value_of_formula(std::string_view text);

}  // namespace chaintrue::grid::files
