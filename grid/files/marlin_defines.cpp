// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/marlin_defines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/marlin_formula.hpp"

namespace chaintrue::grid::files {
namespace {

/// Marlin's own has some two thousand names, and conditions five deep.
constexpr std::size_t kMostNames = 20'000;
constexpr std::size_t kMostConditions = 100;

/// Empty if the file does not state it.
using Truth = std::optional<bool>;

Truth negated(Truth a) { return a ? Truth(!*a) : a; }
Truth both_hold(Truth a, Truth b) {
  if (a == Truth(false) || b == Truth(false)) return false;
  return a && b ? Truth(true) : std::nullopt;
}

class Defines {
 public:
  Defines(const std::string& text, Problems& problems) : problems_(problems) {
    std::istringstream lines(without_comments(text));
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t first = ++number;
      for (std::string next; trimmed(line).ends_with('\\') && std::getline(lines, next); ++number)
        line.replace(line.rfind('\\'), npos, next);
      const std::string place = line_place(first);
      take(line, place);
      if (branches_.size() <= kMostConditions && defined_.size() <= kMostNames) continue;
      problems_.add(place, "more names or conditions", ProblemKind::too_many,
                    "at most {} names, and {} nested conditions", kMostNames, kMostConditions);
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
    for (std::size_t i = 0; !value.empty(); ++i)
      evaluate(take_until(value, ','), name, fmt::format("{}/{}", name, i), *own, texts);
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
      own.held = negated(both_hold(negated(own.held), negated(own.holds)));
    } else if (directive == "define" || directive == "undef") {
      const std::string name = code.word();
      define(name, {std::string(trimmed(code.rest)), place}, directive == "undef");
    }
  }

  void open(Truth holds) { branches_.push_back({holds, holds}); }

  void define(const std::string& name, SettingText own, bool is_undefined) {
    const bool may_hold = none_of(branches_, having(&Branch::holds, Truth(false)));
    Definition& all = defined_[name];
    std::vector<SettingText>& texts = may_hold ? all.in_force : all.others;
    if (is_undefined) {
      if (may_hold) texts.clear();
    } else if (texts.empty() || (texts.size() == 1 && texts.front().text != own.text)) {
      texts.push_back(std::move(own));
    }
  }

  bool is_defined(const std::string& name) const {
    const auto own = defined_.find(name);
    return own != defined_.end() && !own->second.in_force.empty();
  }
  FormulaValue value_of(std::string_view formula) const {
    return value_of_formula(
        formula,
        [this](const std::string& name) {
          if (!is_defined(name)) return false;
          const std::string& value = defined_.at(name).in_force.back().text;
          return value.empty() || value == "1" || value == "true";
        },
        [this](const std::string& name) { return is_defined(name); });
  }

  Truth condition(std::string_view text) const {
    const double value = value_of(text).value;
    return std::isnan(value) ? std::nullopt : Truth(value != 0.0);
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
          ProblemKind::repeated_key,
          "one #define of it; which #if applies is unknown here, so keep only the one in force");
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
  void evaluate(std::string_view formula, const std::string& name, const std::string& key,
                const SettingText& own, SettingTexts& texts) {
    const auto [value, cut] = value_of(formula);
    if (std::isfinite(value) && !cut) {
      texts[key] = {fmt::format("{}", value), own.place};
      return;
    }
    const std::string_view hint =
        looks_like_decimal_comma(formula) ? ", with a decimal point, not a comma" : "";
    problems_.add(
        own.place, own.text.empty() ? "nothing" : own.text, kind_of_bad_number(formula),
        std::isfinite(value)
            ? fmt::format("a whole quotient, or .0 after one of its numbers: the compiler "
                          "truncates {} ({})",
                          *cut, name)
            : fmt::format("a number, or a sum of numbers and of defined names ({}){}", name, hint));
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
    code.append(count_equal(text.substr(i, end - i), '\n'), '\n');
    i = is_block ? std::min(end + 2, text.size()) : end;
  }
  return code;
}

SettingTexts marlin_texts(const std::string& text, const Words& names, Problems& problems) {
  Defines defines(text, problems);
  SettingTexts texts;
  for (const std::string& name : names) defines.read(name, texts);
  return texts;
}

}  // namespace chaintrue::grid::files
