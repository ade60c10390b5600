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
class CFormula {
 public:
  CFormula(std::string_view text, const AskedName& is_enabled, const AskedName& is_defined)
      : code_{text}, is_enabled_(is_enabled), is_defined_(is_defined) {}

  FormulaValue value() {
    if (code_.rest.size() > kLongestFormula) return {};
    FormulaValue found;
    const double whole = any().value;
    if (is_formula_ && code_.is_at_end()) found.value = whole;
    found.cut = cut_;
    return found;
  }

 private:
  CNumber any() {
    CNumber own = all();
    while (code_.takes("||")) {
      const CNumber other = all();
      own = truth(own.value != 0.0 || other.value != 0.0);
    }
    return own;
  }

  CNumber all() {
    CNumber own = sum();
    while (code_.takes("&&")) {
      const CNumber other = sum();
      own = truth(own.value != 0.0 && other.value != 0.0);
    }
    return own;
  }

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
    CNumber own = one();
    for (;;) {
      const bool multiplies = code_.takes("*");
      if (!multiplies && !code_.takes("/")) return own;
      const CNumber other = one();
      own = {multiplies ? own.value * other.value : own.value / other.value,
             own.is_whole && other.is_whole};
      if (own.is_whole && own.value != std::trunc(own.value)) cut_ = own.value;
    }
  }

  CNumber one() {
    if (code_.takes("!")) return truth(one().value == 0.0);
    if (code_.takes("+")) return one();
    if (code_.takes("-")) {
      const CNumber own = one();
      return {-own.value, own.is_whole};
    }
    code_.rest = trimmed(code_.rest);
    if (!code_.rest.empty() && begins_a_number(code_.rest.front())) return number();
    const std::string word = code_.word();
    const bool is_of_numbers = word.empty() || word == "sq" || word == "sqrt";
    const bool has_bracket = code_.takes("(");
    is_formula_ = is_formula_ && (has_bracket || word == "defined");
    if (!is_formula_) return {};
    const CNumber own = is_of_numbers ? any() : truth(is_so(word, has_bracket));
    is_formula_ = (!has_bracket || code_.takes(")")) && is_formula_;
    if (word == "sq") return {own.value * own.value, own.is_whole};
    return word == "sqrt" ? CNumber{std::sqrt(own.value), false} : own;
  }

  /// What `macro` asks of the names that follow.
  bool is_so(const std::string& macro, bool has_bracket) {
    const AskedName& asked = macro == "defined" ? is_defined_ : is_enabled_;
    bool are_all = true, is_any = false;
    do {
      const bool own = asked(code_.word());
      are_all = are_all && own;
      is_any = is_any || own;
    } while (has_bracket && code_.takes(","));
    const auto is = [&](std::initializer_list<const char*> names) {
      return contains(names, macro);
    };
    if (is({"defined", "ENABLED", "ALL", "BOTH"})) return are_all;
    if (is({"ANY", "EITHER"})) return is_any;
    is_formula_ = is_formula_ && is({"DISABLED", "NONE"});
    return !is_any;
  }

  CNumber number() {
    const std::string_view rest = code_.rest;
    std::size_t end = 0;
    while (end < rest.size() && (begins_a_number(rest[end]) || is_of_a_name(rest[end]) ||
                                 ((rest[end] == '-' || rest[end] == '+') &&
                                  (rest[end - 1] == 'e' || rest[end - 1] == 'E'))))
      ++end;
    std::string_view digits = rest.substr(0, end);
    code_.rest = rest.substr(end);
    const bool is_whole = digits.find_first_of(".eE") == npos;
    digits = digits.substr(0, digits.find_last_not_of("fFlLuU") + 1);
    const auto value = number_of(digits);
    is_formula_ = value && is_formula_;
    return {value.value_or(0.0), is_whole};
  }

  CodeReader code_;
  const AskedName& is_enabled_;
  const AskedName& is_defined_;
  bool is_formula_ = true;
  std::optional<double> cut_;
};

}  // namespace

FormulaValue value_of_formula(std::string_view text, const AskedName& is_enabled,
                              const AskedName& is_defined) {
  return CFormula(text, is_enabled, is_defined).value();
}

}  // namespace chaintrue::grid::files
