// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/marlin_defines.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "grid/files/blanks.hpp"
#include "model/effects/formula.hpp"

namespace chaintrue::grid::files {
namespace {

using model::effects::Formula;

bool is_of_a_name(char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; }

class Defines {
 public:
  Defines(const std::string& text, Problems& problems) : problems_(problems) {
    std::istringstream lines(text);
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) take(line, ++number);
  }

  /// One number, or the list within braces.
  void read(const std::string& name, SettingTexts& texts) {
    const SettingText* own = find(name);
    if (own == nullptr) return;
    std::string_view value = own->text;
    if (!value.starts_with('{')) {
      if (const auto number = value_of(name, 0)) texts[name] = {*number, own->place};
      return;
    }
    value = value.substr(1, value.find('}') - 1);
    for (std::size_t i = 0; !value.empty(); ++i) {
      const std::size_t end = value.find(',');
      if (const auto number = evaluated(value.substr(0, end), name, *own, 0))
        texts[fmt::format("{}/{}", name, i)] = {*number, own->place};
      value.remove_prefix(end == std::string_view::npos ? value.size() : end + 1);
    }
  }

 private:
  void take(std::string_view line, std::size_t number) {
    line = trimmed(line.substr(0, line.find("//")));
    const auto word = [&line] {
      std::size_t end = 0;
      while (end < line.size() && (is_of_a_name(line[end]) || line[end] == '#')) ++end;
      const std::string_view own = line.substr(0, end);
      line = trimmed(line.substr(end));
      return std::string(own);
    };
    const std::string directive = word();
    if (directive != "#define" && directive != "#undef") return;
    const std::string name = word();
    if (directive == "#undef") {
      texts_.erase(name);
      return;
    }
    const std::string value(trimmed(line.substr(0, line.find("/*"))));
    const auto [own, is_new] =
        texts_.emplace(name, SettingText{value, fmt::format("line {}", number)});
    if (!is_new && own->second.text != value)
      others_.emplace(name, fmt::format("line {}, {}", number, value));
  }

  /// Null where it is not defined, or is reported.
  const SettingText* find(const std::string& name) {
    const auto own = texts_.find(name);
    if (own == texts_.end()) return nullptr;
    const auto other = others_.find(name);
    if (other == others_.end()) return &own->second;
    if (reported_.insert(name).second) {
      problems_.add(own->second.place,
                    fmt::format("{} {}, and at {}", name, own->second.text, other->second),
                    "one #define of it: which #if holds is not known here, so leave the one in force",
                    ProblemKind::repeated_key);
    }
    return nullptr;
  }

  std::optional<std::string> value_of(const std::string& name, int depth) {
    const SettingText* own = find(name);
    return own == nullptr ? std::nullopt : evaluated(own->text, name, *own, depth);
  }

  /// What the text is worth, in digits; reported where it is not a number.
  std::optional<std::string> evaluated(std::string_view text,
                                       const std::string& name,
                                       const SettingText& own,
                                       int depth) {
    constexpr int kDeepest = 20;
    const std::size_t known = problems_.list().size();
    std::string formula;
    for (std::size_t i = 0; i < text.size();) {
      std::size_t end = i;
      while (end < text.size() && is_of_a_name(text[end])) ++end;
      const std::string word(text.substr(i, end - i));
      if (word.empty()) {
        formula += text[i++];
        continue;
      }
      const bool is_name = std::isdigit(static_cast<unsigned char>(word.front())) == 0 &&
                           (i == 0 || text[i - 1] != '.');
      const auto value = is_name && depth < kDeepest ? value_of(word, depth + 1) : std::nullopt;
      formula += value ? "(" + *value + ")" : word;
      i = end;
    }
    const auto parsed = Formula::parse(formula, {}, {});
    const double value = parsed ? parsed->evaluate<0>({}).value : NAN;
    if (problems_.list().size() > known) return std::nullopt;
    const bool is_whole = formula.find('.') == std::string::npos;
    if (std::isfinite(value) && (!is_whole || value == std::trunc(value)))
      return fmt::format("{}", value);
    const std::string_view hint =
        looks_like_decimal_comma(text) ? ", with a decimal point, not a comma" : "";
    problems_.add(own.place,
                  own.text.empty() ? "nothing" : own.text,
                  std::isfinite(value)
                      ? fmt::format("a quotient that comes out whole, or .0 behind one of its numbers: "
                                    "the compiler cuts {} down ({})",
                                    value,
                                    name)
                      : fmt::format("a number, or a sum of numbers and of defined names ({}){}",
                                    name,
                                    hint),
                  kind_of_bad_number(text));
    return std::nullopt;
  }

  Problems& problems_;
  SettingTexts texts_;
  std::map<std::string, std::string> others_;  ///< where a name is defined otherwise
  std::set<std::string> reported_;
};

}  // namespace

SettingTexts marlin_texts(const std::string& text,
                          const std::vector<std::string>& names,
                          Problems& problems) {
  Defines defines(text, problems);
  SettingTexts texts;
  for (const std::string& name : names) defines.read(name, texts);
  return texts;
}

}  // namespace chaintrue::grid::files
