// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/marlin_formula.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {
namespace {

/// The condition of an #if.
class Condition {
 public:
  using Asked = std::function<bool(const std::string& name)>;
  Condition(std::string_view text, Asked is_enabled, Asked is_defined)
      : code_{text}, is_enabled_(std::move(is_enabled)), is_defined_(std::move(is_defined)) {}

  Truth value() {
    if (code_.rest.size() > kLongestFormula) return std::nullopt;
    const Truth holds = any();
    return is_known_ && code_.is_at_end() ? holds : std::nullopt;
  }

 private:
  Truth any() {
    Truth holds = all();
    while (code_.takes("||")) holds = one_holds(holds, all());
    return holds;
  }
  Truth all() {
    Truth holds = one();
    while (code_.takes("&&")) holds = both_hold(holds, one());
    return holds;
  }
  Truth one() {
    if (code_.takes("!")) return negated(one());
    if (code_.takes("(")) {
      const Truth holds = any();
      is_known_ = code_.takes(")") && is_known_;
      return holds;
    }
    const std::string word = code_.word();
    if (word == "0" || word == "1") return word == "1";
    const bool has_bracket = code_.takes("(");
    if (word == "defined") {
      const bool holds = is_defined_(code_.word());
      is_known_ = (!has_bracket || code_.takes(")")) && is_known_;
      return holds;
    }
    return has_bracket ? of_options(word) : unknown();
  }
  Truth of_options(const std::string& macro) {
    bool are_all = true, is_any = false;
    do {
      const bool is_enabled = is_enabled_(code_.word());
      are_all = are_all && is_enabled;
      is_any = is_any || is_enabled;
    } while (code_.takes(","));
    if (!code_.takes(")")) return unknown();
    if (macro == "ENABLED" || macro == "ALL" || macro == "BOTH") return are_all;
    if (macro == "ANY" || macro == "EITHER") return is_any;
    if (macro == "DISABLED" || macro == "NONE") return !is_any;
    return unknown();
  }
  Truth unknown() {
    is_known_ = false;
    return std::nullopt;
  }

  CodeReader code_;
  Asked is_enabled_, is_defined_;
  bool is_known_ = true;
};

struct CNumber {
  double value = 0.0;
  bool is_whole = false;  ///< int, which the compiler divides as such
};

/// sum = product {(+ | -) product}; product = factor {(* | /) factor};
/// factor = (+ | -) factor | number | [sq | sqrt] (sum)
class CFormula {
 public:
  explicit CFormula(std::string_view text) : code_{text} {}

  /// NaN if the text is not a formula.
  double value() {
    const CNumber whole = sum();
    return is_formula_ && code_.is_at_end() ? whole.value
                                            : std::numeric_limits<double>::quiet_NaN();
  }
  /// A quotient of whole numbers that is not whole.
  std::optional<double> cut() const { return cut_; }

 private:
  CNumber sum() {
    CNumber own = product();
    for (;;) {
      const bool adds = code_.takes("+");
      if (!adds && !code_.takes("-")) return own;
      const CNumber other = product();
      own = {own.value + (adds ? other.value : -other.value), own.is_whole && other.is_whole};
    }
  }
  CNumber product() {
    CNumber own = factor();
    for (;;) {
      const bool multiplies = code_.takes("*");
      if (!multiplies && !code_.takes("/")) return own;
      const CNumber other = factor();
      own = {multiplies ? own.value * other.value : own.value / other.value,
             own.is_whole && other.is_whole};
      if (own.is_whole && own.value != std::trunc(own.value)) cut_ = own.value;
    }
  }
  CNumber factor() {
    if (code_.takes("-")) {
      const CNumber own = factor();
      return {-own.value, own.is_whole};
    }
    if (code_.takes("+")) return factor();
    if (!trimmed(code_.rest).empty() && begins_a_number(trimmed(code_.rest).front()))
      return number();
    const std::string function = code_.word();
    is_formula_ = (function.empty() || function == "sq" || function == "sqrt") &&
                  code_.takes("(") && is_formula_;
    if (!is_formula_) return {};
    const CNumber own = sum();
    is_formula_ = code_.takes(")") && is_formula_;
    if (function == "sq") return {own.value * own.value, own.is_whole};
    return function.empty() ? own : CNumber{std::sqrt(own.value), false};
  }
  CNumber number() {
    const std::string_view rest = trimmed(code_.rest);
    std::size_t end = 0;
    while (end < rest.size() && (begins_a_number(rest[end]) || is_of_a_name(rest[end]) ||
                                 ((rest[end] == '-' || rest[end] == '+') &&
                                  (rest[end - 1] == 'e' || rest[end - 1] == 'E'))))
      ++end;
    std::string_view digits = rest.substr(0, end);
    code_.rest = rest.substr(end);
    const bool is_whole = digits.find_first_of(".eE") == std::string_view::npos;
    digits = digits.substr(0, digits.find_last_not_of("fFlLuU") + 1);
    const auto value = number_of(digits);
    is_formula_ = value && is_formula_;
    return {value.value_or(0.0), is_whole};
  }

  CodeReader code_;
  bool is_formula_ = true;
  std::optional<double> cut_;
};

}  // namespace

Truth truth_of(std::string_view condition, std::function<bool(const std::string& name)> is_enabled,
               std::function<bool(const std::string& name)> is_defined) {
  return Condition(condition, std::move(is_enabled), std::move(is_defined)).value();
}

FormulaValue value_of_formula(std::string_view text) {
  CFormula formula(text);
  const double value = formula.value();
  return {value, formula.cut()};
}

}  // namespace chaintrue::grid::files
