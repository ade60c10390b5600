// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/marlin_defines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"

namespace chaintrue::grid::files {
namespace {

/// No formula of a Configuration.h is longer, once its names are replaced.
constexpr std::size_t kLongestFormula = 500;
/// Marlin's own has some two thousand names, and conditions five deep.
constexpr std::size_t kMostNames = 20'000;
constexpr std::size_t kMostConditions = 100;

bool is_of_a_name(char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; }
bool begins_a_number(char c) {
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
  [[nodiscard]] bool is_at_end() const { return trimmed(rest).empty(); }
};

/// Empty if the file does not state it.
using Truth = std::optional<bool>;

Truth negated(Truth a) { return a ? Truth(!*a) : a; }
Truth both_hold(Truth a, Truth b) {
  if (a == Truth(false) || b == Truth(false)) return false;
  return a && b ? Truth(true) : std::nullopt;
}
Truth one_holds(Truth a, Truth b) { return negated(both_hold(negated(a), negated(b))); }

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
  [[nodiscard]] std::optional<double> cut() const { return cut_; }

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

class Defines {
 public:
  Defines(const std::string& text, Problems& problems) : problems_(problems) {
    std::istringstream lines(without_comments(text));
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t first = ++number;
      for (std::string next; trimmed(line).ends_with('\\') && std::getline(lines, next); ++number)
        line.replace(line.rfind('\\'), std::string::npos, next);
      const std::string place = fmt::format("line {}", first);
      take(line, place);
      if (branches_.size() <= kMostConditions && defined_.size() <= kMostNames) continue;
      problems_.add(
          place,
          "more names or conditions",
          fmt::format(
              "at most {} names, and {} nested conditions", kMostNames, kMostConditions),
          ProblemKind::too_many);
      return;
    }
  }

  /// One number, or the list within braces.
  void read(const std::string& name, SettingTexts& texts) {
    const std::size_t known = problems_.list().size();
    const SettingText* own = find(name);
    if (own == nullptr) return;
    std::string formula;
    std::size_t words_left = kLongestFormula;
    expand(own->text, formula, words_left);
    if (problems_.list().size() > known) return;
    if (words_left == 0 || formula.size() > kLongestFormula) formula.clear();  // circular
    std::string_view value = trimmed(formula);
    if (!value.starts_with('{')) {
      evaluate(value, name, name, *own, texts);
      return;
    }
    value = value.substr(1, value.find('}') - 1);
    for (std::size_t i = 0; !value.empty(); ++i) {
      const std::size_t end = value.find(',');
      evaluate(value.substr(0, end), name, fmt::format("{}/{}", name, i), *own, texts);
      value.remove_prefix(end == std::string_view::npos ? value.size() : end + 1);
    }
  }

 private:
  /// At most two texts of each, which is one too many.
  struct Definition {
    std::vector<SettingText> in_force;
    std::vector<SettingText> others;
  };
  /// An #if and its #elif and #else.
  struct Branch {
    Truth holds;
    Truth held;  ///< one of those so far
  };

  void take(std::string_view line, const std::string& place) {
    CodeReader code{line};
    if (!code.takes("#")) return;
    const std::string directive = code.word();
    if (directive == "if") {
      open(condition(code.rest));
    } else if (directive == "ifdef" || directive == "ifndef") {
      const bool is_defined_here = is_defined(code.word());
      open(is_defined_here == (directive == "ifdef"));
    } else if (directive == "endif") {
      if (!branches_.empty()) branches_.pop_back();
    } else if (directive == "elif" || directive == "else") {
      if (branches_.empty()) return;
      Branch& own = branches_.back();
      own.holds =
          both_hold(negated(own.held), directive == "else" ? Truth(true) : condition(code.rest));
      own.held = one_holds(own.held, own.holds);
    } else if (directive == "define" || directive == "undef") {
      const std::string name = code.word();
      define(name, {std::string(trimmed(code.rest)), place}, directive == "undef");
    }
  }

  void open(Truth holds) { branches_.push_back({holds, holds}); }

  void define(const std::string& name, SettingText own, bool is_undefined) {
    const bool may_hold =
        none_of(branches_, [](const Branch& branch) { return branch.holds == Truth(false); });
    Definition& all = defined_[name];
    std::vector<SettingText>& texts = may_hold ? all.in_force : all.others;
    if (is_undefined) {
      if (may_hold) texts.clear();
    } else if (texts.empty() || (texts.size() == 1 && texts.front().text != own.text)) {
      texts.push_back(std::move(own));
    }
  }

  [[nodiscard]] bool is_defined(const std::string& name) const {
    const auto own = defined_.find(name);
    return own != defined_.end() && !own->second.in_force.empty();
  }
  [[nodiscard]] Truth condition(std::string_view text) const {
    return Condition(
               text,
               [this](const std::string& name) {
                 if (!is_defined(name)) return false;
                 const std::string& value = defined_.at(name).in_force.back().text;
                 return value.empty() || value == "1" || value == "true";
               },
               [this](const std::string& name) { return is_defined(name); })
        .value();
  }

  /// Null if it is not defined or has been reported.
  const SettingText* find(const std::string& name) {
    const auto own = defined_.find(name);
    if (own == defined_.end()) return nullptr;
    const std::vector<SettingText>& texts =
        own->second.in_force.empty() ? own->second.others : own->second.in_force;
    if (texts.size() == 1) return &texts.front();
    if (texts.size() > 1 && reported_.insert(name).second) {
      problems_.add(
          texts[0].place,
          fmt::format("{} {}, and at {}, {}", name, texts[0].text, texts[1].place, texts[1].text),
          "one #define of it; which #if applies is unknown here, so keep only the one in force",
          ProblemKind::repeated_key);
    }
    return nullptr;
  }

  /// Appends the text, with names replaced as long as there are any and room.
  void expand(std::string_view text, std::string& formula, std::size_t& words_left) {
    for (std::size_t i = 0;
         i < text.size() && words_left > 0 && formula.size() <= kLongestFormula;) {
      std::size_t end = i;
      while (end < text.size() && (is_of_a_name(text[end]) || text[end] == '.')) ++end;
      const std::string word(text.substr(i, end - i));
      const bool is_name = !word.empty() && !begins_a_number(word.front());
      const SettingText* own = is_name ? find(word) : nullptr;
      if (own != nullptr) {
        --words_left;
        expand(own->text, formula, words_left);
      } else if (word.empty()) {
        formula += text[end++];
      } else {
        formula += word;
      }
      i = end;
    }
  }

  /// The formula's value as text; reported if it is not a number.
  void evaluate(std::string_view formula,
                const std::string& name,
                const std::string& key,
                const SettingText& own,
                SettingTexts& texts) {
    CFormula parsed(formula);
    const double value = parsed.value();
    if (std::isfinite(value) && !parsed.cut()) {
      texts[key] = {fmt::format("{}", value), own.place};
      return;
    }
    const std::string_view hint =
        looks_like_decimal_comma(formula) ? ", with a decimal point, not a comma" : "";
    problems_.add(
        own.place,
        own.text.empty() ? "nothing" : own.text,
        std::isfinite(value)
            ? fmt::format("a whole quotient, or .0 after one of its numbers: the compiler "
                          "truncates {} ({})",
                          *parsed.cut(),
                          name)
            : fmt::format("a number, or a sum of numbers and of defined names ({}){}", name, hint),
        kind_of_bad_number(formula));
  }

  Problems& problems_;
  std::vector<Branch> branches_;
  std::map<std::string, Definition> defined_;
  std::set<std::string> reported_;
};

}  // namespace

std::string without_comments(std::string_view text) {
  std::string code;
  for (std::size_t i = 0; i < text.size();) {
    const bool is_block = text.substr(i, 2) == "/*";
    if (!is_block && text.substr(i, 2) != "//") {
      code += text[i++];
      continue;
    }
    const std::size_t end = std::min(text.find(is_block ? "*/" : "\n", i + 2), text.size());
    code.append(static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                                    text.begin() + static_cast<std::ptrdiff_t>(end),
                                                    '\n')),
                '\n');
    i = is_block ? std::min(end + 2, text.size()) : end;
  }
  return code;
}

SettingTexts marlin_texts(const std::string& text,
                          const std::vector<std::string>& names,
                          Problems& problems) {
  Defines defines(text, problems);
  SettingTexts texts;
  for (const std::string& name : names) defines.read(name, texts);
  return texts;
}

}  // namespace chaintrue::grid::files
