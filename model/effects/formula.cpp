// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/formula.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <numbers>
#include <optional>
#include <sstream>

namespace chaintrue::model::effects {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Length of the number at the start of the text: digits, a point, and an exponent if digits follow
/// the e.
std::size_t number_length(std::string_view text) {
  std::size_t end = 0;
  const auto skip_digits = [&] {
    while (end < text.size() && is_digit(text[end])) ++end;
  };
  skip_digits();
  if (end < text.size() && text[end] == '.') ++end;
  skip_digits();
  std::size_t exponent = end;
  if (exponent < text.size() && (text[exponent] == 'e' || text[exponent] == 'E')) {
    ++exponent;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    if (exponent < text.size() && is_digit(text[exponent])) {
      end = exponent;
      skip_digits();
    }
  }
  return end;
}

struct Operand {
  FormulaUnit unit;
  /// Consists of numbers alone, so it takes the unit of the term to which it is added.
  bool bare = false;
  /// Its value, if it consists of numbers without functions.
  std::optional<double> constant;
};

Operand number_of(double value) { return {{}, true, value}; }

}  // namespace

std::string words(const FormulaUnit& unit) {
  const auto power = [](std::string_view base, double exponent) {
    return exponent == 1.0 ? std::string(base) : fmt::format("{}^{:g}", base, exponent);
  };
  std::string above;
  std::string below;
  for (const auto& [base, exponent] : {std::pair{"mm", unit.mm}, std::pair{"N", unit.n}}) {
    std::string& list = exponent > 0.0 ? above : below;
    if (exponent != 0.0)
      list += fmt::format("{}{}", list.empty() ? "" : " ", power(base, std::abs(exponent)));
  }
  if (above.empty() && below.empty()) return "a number";
  if (below.empty()) return above;
  return fmt::format("{}/{}", above.empty() ? "1" : above, below);
}

/// Thrown inside the parser alone; parse() returns it.
struct FormulaStop {
  FormulaProblem problem;
};

/// Recursive descent: each operation is written behind its operands, with its unit checked.
class FormulaParser {
 public:
  FormulaParser(std::string_view text, std::span<const FormulaName> names)
      : text_(text), names_(names) {
    formula_.text_ = text;
  }

  Formula parse(const FormulaUnit& wanted) {
    skip_blanks();
    if (at_ == text_.size()) stop(0, "an empty formula", "a formula, such as " + example());
    sum();
    if (at_ < text_.size()) {
      stop(
          at_, found_here(),
          text_[at_] == ')' ? "no unmatched closing bracket" : "an operator + - * / ^, or the end");
    }
    const Operand& whole = operands_.back();
    if (!whole.bare && !(whole.unit == wanted)) {
      stop(0, fmt::format("a formula in {}", describe(whole.unit)),
           fmt::format("one whose units come out as {}", words(wanted)));
    }
    return std::move(formula_);
  }

 private:
  using Kind = Formula::Kind;
  using Step = Formula::Step;

  [[noreturn]] static void stop(std::size_t offset, std::string found, std::string expected) {
    throw FormulaStop{{offset, std::move(found), std::move(expected)}};
  }
  std::string example() const {
    return names_.empty() ? "0.1" : fmt::format("0.1 * {}", names_.front().name);
  }
  static std::string describe(const FormulaUnit& unit) {
    return unit == FormulaUnit{} ? "numbers without a unit" : words(unit);
  }
  std::string found_here() const {
    if (at_ >= text_.size()) return "the end";
    std::size_t end = at_ + 1;
    if (is_letter(text_[at_])) {
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    }
    // The bytes of one UTF-8 character belong together.
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0U) == 0x80U) ++end;
    return std::string(text_.substr(at_, end - at_));
  }

  void skip_blanks() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
  }
  /// Consumes the character if it is next.
  bool take(char wanted) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    skip_blanks();
    return true;
  }

  /// One level of brackets, signs or exponents.
  class Level {
   public:
    Level(FormulaParser& parser, std::size_t offset) : parser_(parser) {
      if (++parser_.depth_ > Formula::kDeepest) {
        stop(offset, fmt::format("brackets, signs and powers more than {} deep", Formula::kDeepest),
             "a formula with fewer nested levels");
      }
    }
    ~Level() { --parser_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    FormulaParser& parser_;
  };

  struct Operation {
    char sign;
    Kind kind;
  };
  /// Operands joined from the left by either of two operations.
  template <class OneOperand>
  void joined_by(const Operation& first, const Operation& second, const OneOperand& operand) {
    operand();
    while (true) {
      const std::size_t offset = at_;
      const bool is_first = take(first.sign);
      if (!is_first && !take(second.sign)) return;
      operand();
      combine(is_first ? first.kind : second.kind, offset);
    }
  }

  void sum() {
    const Level level(*this, at_);
    joined_by({'+', Kind::add}, {'-', Kind::subtract}, [this] { term(); });
  }

  void term() {
    joined_by({'*', Kind::multiply}, {'/', Kind::divide}, [this] { factor(); });
  }

  void factor() {
    const std::size_t offset = at_;
    if (take('-')) {
      const Level level(*this, offset);
      factor();
      Operand& own = operands_.back();
      if (own.constant) own.constant = -*own.constant;
      write({Kind::negate, 0.0, 0, offset});
    } else if (take('+')) {
      const Level level(*this, offset);
      factor();
    } else {
      power();
    }
  }

  void power() {
    atom();
    const std::size_t offset = at_;
    if (!take('^')) return;
    const Level level(*this, offset);
    factor();
    combine(Kind::power, offset);
  }

  void atom() {
    skip_blanks();
    const std::size_t offset = at_;
    if (take('(')) {
      sum();
      if (!take(')')) stop(at_, found_here(), "a closing bracket )");
      return;
    }
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
    if (at_ < text_.size() && is_letter(text_[at_])) {
      const std::string word = found_here();
      at_ += word.size();
      if (take('(')) return call(word, offset);
      return name(word, offset);
    }
    stop(offset, found_here(), "a number, a name, a function or an opening bracket");
  }

  void number() {
    const std::size_t offset = at_;
    const std::string digits(text_.substr(at_, number_length(text_.substr(at_))));
    // libc++ 14 has no std::from_chars for double; the classic locale always uses a decimal point.
    std::istringstream stream(digits);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    stream >> value;
    const std::string_view mantissa =
        std::string_view(digits).substr(0, digits.find_first_of("eE"));
    const bool vanished = value == 0.0 && mantissa.find_first_of("123456789") != std::string::npos;
    if (stream.fail() || vanished || !std::isfinite(value))
      stop(offset, found_here(), "a number within the range of the computer");
    at_ += digits.size();
    skip_blanks();
    push(number_of(value), {Kind::number, value, 0, offset});
  }

  void name(const std::string& word, std::size_t offset) {
    skip_blanks();
    if (word == "pi")
      return push(number_of(std::numbers::pi), {Kind::number, std::numbers::pi, 0, offset});
    if (word == "mm") return push({{.mm = 1.0}, false, {}}, {Kind::number, 1.0, 0, offset});
    if (word == "N") return push({{.n = 1.0}, false, {}}, {Kind::number, 1.0, 0, offset});
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].name == word)
        return push({names_[i].unit, false, {}}, {Kind::name, 0.0, i, offset});
    }
    std::vector<std::string> known;
    for (const FormulaName& one : names_) known.push_back(one.name);
    known.insert(known.end(), {"mm", "N", "pi"});
    stop(offset, word,
         find_function(word) != nullptr
             ? fmt::format("a bracket after {}, as in {}(...)", word, word)
             : fmt::format("a name that this formula may use: {}", fmt::join(known, ", ")));
  }

  struct Function {
    std::string_view name;
    Kind kind;
    std::size_t arguments;
  };
  static constexpr std::array kFunctions = {
      Function{"sin", Kind::sine, 1},        Function{"cos", Kind::cosine, 1},
      Function{"exp", Kind::exponential, 1}, Function{"log", Kind::logarithm, 1},
      Function{"sqrt", Kind::root, 1},       Function{"abs", Kind::absolute, 1},
      Function{"step", Kind::step, 1},       Function{"ramp", Kind::ramp, 1},
      Function{"min", Kind::least, 2},       Function{"max", Kind::greatest, 2}};
  static const Function* find_function(std::string_view word) {
    const auto found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                    [&](const Function& f) { return f.name == word; });
    return found == kFunctions.end() ? nullptr : &*found;
  }

  void call(const std::string& word, std::size_t offset) {
    const Function* function = find_function(word);
    if (function == nullptr) {
      std::vector<std::string> known;
      for (const Function& one : kFunctions) known.emplace_back(one.name);
      stop(offset, word + "(", fmt::format("one of the functions {}", fmt::join(known, ", ")));
    }
    std::size_t arguments = 0;
    if (!take(')')) {
      do {
        sum();
        ++arguments;
      } while (take(','));
      if (!take(')')) stop(at_, found_here(), "a comma or a closing bracket )");
    }
    if (arguments != function->arguments) {
      stop(offset, fmt::format("{} with {} argument{}", word, arguments, arguments == 1 ? "" : "s"),
           fmt::format("{} with {}", word,
                       function->arguments == 1 ? "one argument"
                                                : "two arguments, as in " + word + "(a, b)"));
    }
    if (arguments == 2) return combine(function->kind, offset);
    of_one(function->kind, word, offset);
  }

  void of_one(Kind kind, const std::string& word, std::size_t offset) {
    Operand& own = operands_.back();
    own.constant.reset();
    const bool of_number = kind == Kind::sine || kind == Kind::cosine ||
                           kind == Kind::exponential || kind == Kind::logarithm;
    if (of_number && !(own.unit == FormulaUnit{})) {
      stop(offset, fmt::format("{} of {}", word, words(own.unit)),
           fmt::format(
               "{} of a plain number; divide by a quantity with the same unit, as in {}(x / (100 * "
               "mm))",
               word, word));
    }
    if (kind == Kind::root) own.unit = {0.5 * own.unit.mm, 0.5 * own.unit.n};
    // The constant 1 or 0, in any unit.
    if (kind == Kind::step) own = {{}, own.bare, {}};
    write({kind, 0.0, 0, offset});
  }

  /// Replaces the last two operands by the result.
  void combine(Kind kind, std::size_t offset) {
    const Operand b = operands_.back();
    operands_.pop_back();
    const Operand a = operands_.back();
    operands_.back() = combined(kind, a, b, offset);
    write({kind, 0.0, 0, offset});
  }

  static Operand combined(Kind kind, const Operand& a, const Operand& b, std::size_t offset) {
    Operand result{{}, a.bare && b.bare, {}};
    if (a.constant && b.constant && kind <= Kind::power)
      result.constant = Formula::binary<1>(kind, *a.constant, *b.constant).value;
    if (kind == Kind::multiply) {
      result.unit = {a.unit.mm + b.unit.mm, a.unit.n + b.unit.n};
    } else if (kind == Kind::divide) {
      result.unit = {a.unit.mm - b.unit.mm, a.unit.n - b.unit.n};
    } else if (kind == Kind::power) {
      result.unit = raised(a, b, offset);
    } else {
      if (!a.bare && !b.bare && !(a.unit == b.unit)) {
        stop(offset, fmt::format("{} together with {}", words(a.unit), words(b.unit)),
             "two values with the same unit");
      }
      result.unit = a.bare ? b.unit : a.unit;
    }
    return result;
  }

  static FormulaUnit raised(const Operand& a, const Operand& b, std::size_t offset) {
    if (!(b.unit == FormulaUnit{}))
      stop(offset, fmt::format("a power of {}", words(b.unit)), "a number after ^");
    if (a.unit == FormulaUnit{}) return {};
    if (!b.constant) {
      stop(offset, fmt::format("{} to a power that varies", words(a.unit)),
           "a plain number after ^, so that the unit is known");
    }
    return {a.unit.mm * *b.constant, a.unit.n * *b.constant};
  }

  void push(const Operand& operand, const Step& step) {
    operands_.push_back(operand);
    write(step);
  }
  void write(const Step& step) {
    if (formula_.steps_.size() == Formula::kMostSteps) {
      stop(step.offset,
           fmt::format("more than {} numbers, names and operations", Formula::kMostSteps),
           "a shorter formula");
    }
    formula_.steps_.push_back(step);
  }

  std::string_view text_;
  std::span<const FormulaName> names_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
  std::vector<Operand> operands_;
  Formula formula_;
};

tl::expected<Formula, FormulaProblem> Formula::parse(std::string_view text,
                                                     std::span<const FormulaName> names,
                                                     const FormulaUnit& wanted) {
  try {
    return FormulaParser(text, names).parse(wanted);
  } catch (const FormulaStop& stopped) {
    return tl::unexpected(stopped.problem);
  }
}

bool Formula::uses(std::size_t name) const {
  return std::any_of(steps_.begin(), steps_.end(), [&](const Step& step) {
    return step.kind == Kind::name && step.name == name;
  });
}

}  // namespace chaintrue::model::effects
