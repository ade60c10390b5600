// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/marlin_formula.hpp"

#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {
namespace {

struct CNumber {
  double value = 0.0;
  bool is_whole = false;  ///< int, which the compiler divides as such
};

CNumber truth(bool holds) { return {holds ? 1.0 : 0.0, true}; }

/// any = all {|| all}; all = sum {&& sum}; sum = product {(+ | -) product};
/// product = one {(* | /) one}; one = (! | + | -) one | number | [sq | sqrt] (any)
/// | ENABLED(name, ...) | defined name
struct CFormula {
  CodeReader code;
  const AskedName& is_enabled;
  const AskedName& is_defined;
  bool is_formula = true;
  std::optional<double> cut = std::nullopt;

  FormulaValue value() {
    if (code.rest.size() > kLongestFormula) return {};
    FormulaValue found;
    const double whole = any().value;
    if (is_formula && code.is_at_end()) found.value = whole;
    found.cut = cut;
    return found;
  }

  CNumber any() {
    CNumber own = all();
    while (code.takes("||")) {
      const CNumber other = all();
      own = truth(own.value != 0.0 || other.value != 0.0);
    }
    return own;
  }

  CNumber all() {
    CNumber own = sum();
    while (code.takes("&&")) {
      const CNumber other = sum();
      own = truth(own.value != 0.0 && other.value != 0.0);
    }
    return own;
  }

  CNumber sum() {
    CNumber own = product();
    for (;;) {
      const bool adds = code.takes("+");
      if (!adds && !code.takes("-")) return own;
      const CNumber other = product();
      own = {own.value + (adds ? other.value : -other.value), own.is_whole && other.is_whole};
    }
  }

  CNumber product() {
    CNumber own = one();
    for (;;) {
      const bool multiplies = code.takes("*");
      if (!multiplies && !code.takes("/")) return own;
      const CNumber other = one();
      own = {multiplies ? own.value * other.value : own.value / other.value,
             own.is_whole && other.is_whole};
      if (own.is_whole && own.value != std::trunc(own.value)) cut = own.value;
    }
  }

  CNumber one() {
    if (code.takes("!")) return truth(one().value == 0.0);
    if (code.takes("+")) return one();
    if (code.takes("-")) {
      const CNumber own = one();
      return {-own.value, own.is_whole};
    }
    code.rest = trimmed(code.rest);
    if (!code.rest.empty() && begins_a_number(code.rest.front())) return number();
    const std::string word = code.word();
    const bool is_of_numbers = word.empty() || word == "sq" || word == "sqrt";
    const bool has_bracket = code.takes("(");
    is_formula = is_formula && (has_bracket || word == "defined");
    if (!is_formula) return {};
    const CNumber own = is_of_numbers ? any() : truth(is_so(word, has_bracket));
    is_formula = (!has_bracket || code.takes(")")) && is_formula;
    if (word == "sq") return {own.value * own.value, own.is_whole};
    return word == "sqrt" ? CNumber{std::sqrt(own.value), false} : own;
  }

  /// What `macro` asks of the names that follow.
  bool is_so(const std::string& macro, bool has_bracket) {
    const AskedName& asked = macro == "defined" ? is_defined : is_enabled;
    bool are_all = true, is_any = false;
    do {
      const bool own = asked(code.word());
      are_all = are_all && own;
      is_any = is_any || own;
    } while (has_bracket && code.takes(","));
    const auto is = [&](std::initializer_list<const char*> names) {
      return contains(names, macro);
    };
    if (is({"defined", "ENABLED", "ALL", "BOTH"})) return are_all;
    if (is({"ANY", "EITHER"})) return is_any;
    is_formula = is_formula && is({"DISABLED", "NONE"});
    return !is_any;
  }

  CNumber number() {
    const std::string_view rest = code.rest;
    std::size_t end = 0;
    while (end < rest.size() && (begins_a_number(rest[end]) || is_of_a_name(rest[end]) ||
                                 ((rest[end] == '-' || rest[end] == '+') &&
                                  (rest[end - 1] == 'e' || rest[end - 1] == 'E'))))
      ++end;
    std::string_view digits = rest.substr(0, end);
    code.rest = rest.substr(end);
    const bool is_whole = digits.find_first_of(".eE") == npos;
    digits = digits.substr(0, digits.find_last_not_of("fFlLuU") + 1);
    const auto value = number_of(digits);
    is_formula = value && is_formula;
    return {value.value_or(0.0), is_whole};
  }
};

}  // namespace

FormulaValue value_of_formula(std::string_view text, const AskedName& is_enabled,
                              const AskedName& is_defined) {
  return CFormula{{text}, is_enabled, is_defined}.value();
}

}  // namespace chaintrue::grid::files
