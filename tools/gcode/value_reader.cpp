// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Recursive descent over one line.
#include "tools/gcode/value_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "grid/files/parse_double.hpp"

namespace chaintrue::gcode {
namespace {

constexpr int kDeepest = 64;
/// LinuxCNC's TOLERANCE_EQUAL.
constexpr double kEqual = 0.0001;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

using Outcome = tl::expected<double, std::string_view>;

tl::unexpected<std::string_view> fails(std::string_view why) { return tl::unexpected(why); }

struct Function {
  std::string_view name;
  Outcome (*apply)(double);
};

Outcome arc_function(double x, double (*apply)(double)) {
  if (x < -1.0 || x > 1.0) return fails("asin and acos take values from -1 to 1");
  return apply(x) / kRadiansPerDegree;
}

/// Longer names before their prefixes.
constexpr Function kFunctions[] = {
    {"abs", [](double x) -> Outcome { return std::fabs(x); }},
    {"acos", [](double x) { return arc_function(x, [](double y) { return std::acos(y); }); }},
    {"asin", [](double x) { return arc_function(x, [](double y) { return std::asin(y); }); }},
    {"cos", [](double x) -> Outcome { return std::cos(x * kRadiansPerDegree); }},
    {"exp", [](double x) -> Outcome { return std::exp(x); }},
    {"fix", [](double x) -> Outcome { return std::floor(x); }},
    {"fup", [](double x) -> Outcome { return std::ceil(x); }},
    {"ln",
     [](double x) -> Outcome {
       if (!(x > 0.0)) return fails("ln takes values above zero");
       return std::log(x);
     }},
    {"round", [](double x) -> Outcome { return std::trunc(x + (x < 0.0 ? -0.5 : 0.5)); }},
    {"sin", [](double x) -> Outcome { return std::sin(x * kRadiansPerDegree); }},
    {"sqrt",
     [](double x) -> Outcome {
       if (x < 0.0) return fails("sqrt takes no value below zero");
       return std::sqrt(x);
     }},
    {"tan", [](double x) -> Outcome { return std::tan(x * kRadiansPerDegree); }},
};

double truth(bool value) { return value ? 1.0 : 0.0; }

Outcome divide(double a, double b) {
  if (b == 0.0) return fails("a division by zero");
  return a / b;
}

Outcome modulo(double a, double b) {
  if (b == 0.0) return fails("mod by zero");
  const double rest = std::fmod(a, b);
  return rest < 0.0 ? rest + std::fabs(b) : rest;
}

Outcome power(double a, double b) {
  if (a < 0.0 && std::floor(b) != b) return fails("a negative number has no such power");
  return std::pow(a, b);
}

struct Operator {
  std::string_view name;
  int precedence;
  Outcome (*apply)(double, double);
};

/// `**` before `*`.
constexpr Operator kOperators[] = {
    {"**", 5, power},
    {"*", 4, [](double a, double b) -> Outcome { return a * b; }},
    {"/", 4, divide},
    {"mod", 4, modulo},
    {"+", 3, [](double a, double b) -> Outcome { return a + b; }},
    {"-", 3, [](double a, double b) -> Outcome { return a - b; }},
    {"eq", 2, [](double a, double b) -> Outcome { return truth(std::fabs(a - b) < kEqual); }},
    {"ne", 2, [](double a, double b) -> Outcome { return truth(std::fabs(a - b) >= kEqual); }},
    {"gt", 2, [](double a, double b) -> Outcome { return truth(a > b); }},
    {"ge", 2, [](double a, double b) -> Outcome { return truth(a >= b); }},
    {"lt", 2, [](double a, double b) -> Outcome { return truth(a < b); }},
    {"le", 2, [](double a, double b) -> Outcome { return truth(a <= b); }},
    {"and", 1, [](double a, double b) -> Outcome { return truth(a != 0.0 && b != 0.0); }},
    {"or", 1, [](double a, double b) -> Outcome { return truth(a != 0.0 || b != 0.0); }},
    {"xor", 1, [](double a, double b) -> Outcome { return truth((a != 0.0) != (b != 0.0)); }},
};

const Operator* operator_at(std::string_view text) {
  for (const Operator& candidate : kOperators) {
    if (text.starts_with(candidate.name)) return &candidate;
  }
  return nullptr;
}

Result<double> finite(const Outcome& outcome, Place place) {
  if (!outcome) return refuse(ProblemName::arithmetic, place, std::string(outcome.error()));
  if (!std::isfinite(*outcome)) {
    return refuse(ProblemName::arithmetic, place, "the result is too large for a number");
  }
  return *outcome;
}

#ifdef __cpp_lib_to_chars

void append_fixed(std::string& text, double value) {
  // The longest double in fixed notation has 1077 characters.
  std::array<char, 1100> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  text.append(digits.data(), end.ptr);
}

#else

/// The fewest decimals that read back as the value: the digits of std::to_chars, which libc++
/// supports only from version 14 on.
void append_fixed(std::string& text, double value) {
  constexpr int kMostDecimals = 1074;  // of the smallest double
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
    const std::string digits = fmt::format("{:.{}f}", value, decimals);
    double read = 0.0;
    grid::files::parse_double(digits.data(), digits.data() + digits.size(), read);
    if (read != value && decimals < kMostDecimals) continue;
    text += digits;
    return;
  }
}

#endif

}  // namespace

Parameters::Parameters() : values_(parameter::kCount, 0.0), frames_(1) {
  values_[parameter::kSystem] = 1.0;
}

void Parameters::follow(StateByNumber by_number, StateByName by_name) {
  state_by_number_ = std::move(by_number);
  state_by_name_ = std::move(by_name);
}

double Parameters::get(int index) const {
  if (index >= parameter::kPosition && state_by_number_) {
    if (const auto value = state_by_number_(index)) return *value;
  }
  return stored(index);
}

void Parameters::set(int index, double value) { values_[static_cast<std::size_t>(index)] = value; }

bool Parameters::writable(int index) const {
  // 5400 to 5428 are the tool and the position.
  return exists(index) && (index < 5400 || index > 5428);
}

std::optional<double> Parameters::get(std::string_view name) const {
  if (state_by_name_) {
    if (const auto value = state_by_name_(name)) return value;
  }
  const Names& names = name.starts_with('_') ? global_ : frames_.back().names;
  const auto found = names.find(name);
  if (found == names.end()) return std::nullopt;
  return found->second;
}

bool Parameters::set(std::string_view name, double value) {
  if (state_by_name_ && state_by_name_(name)) return false;
  Names& names = name.starts_with('_') ? global_ : frames_.back().names;
  names.insert_or_assign(std::string(name), value);
  return true;
}

void Parameters::enter(const std::vector<double>& arguments) {
  Frame frame;
  std::copy_n(values_.begin() + 1, kArguments, frame.saved.begin());
  std::fill_n(values_.begin() + 1, kArguments, 0.0);
  std::copy_n(arguments.begin(), std::min(arguments.size(), kArguments), values_.begin() + 1);
  frames_.push_back(std::move(frame));
}

void Parameters::leave() {
  std::copy(frames_.back().saved.begin(), frames_.back().saved.end(), values_.begin() + 1);
  frames_.pop_back();
}

/// Counts the depth of nesting, so that no line can overflow the stack.
struct ValueReader::Nesting {
  explicit Nesting(ValueReader& reader) : depth(reader.depth_) { ++depth; }
  ~Nesting() { --depth; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  [[nodiscard]] bool too_deep() const { return depth > kDeepest; }
  int& depth;
};

bool ValueReader::accept(std::string_view text) {
  if (!std::string_view(line_.text).substr(std::min(at_, line_.text.size())).starts_with(text))
    return false;
  at_ += text.size();
  return true;
}

Result<double> ValueReader::real() {
  const Nesting nesting(*this);
  if (nesting.too_deep()) {
    return refuse(ProblemName::bad_expression, place(), "the expression is nested too deeply");
  }
  const char c = peek();
  if (c == '\0')
    return refuse(ProblemName::bad_number, place(), "a number is missing at the end of the line");
  if (c == '#') return parameter();
  if (c == '[') return bracketed();
  if (c == '+' || c == '-') {
    const char after = at_ + 1 < line_.text.size() ? line_.text[at_ + 1] : '\0';
    if (after != '\0' && !is_digit(after) && after != '.') {
      ++at_;
      const auto value = real();
      if (!value) return value;
      return c == '-' ? -*value : *value;
    }
  }
  if (c >= 'a' && c <= 'z') return function();
  return number();
}

Result<double> ValueReader::number() {
  const Place start = place();
  const std::string_view text = line_.text;
  std::size_t end = at_;
  while (end < text.size() &&
         (is_digit(text[end]) || text[end] == '.' || text[end] == '+' || text[end] == '-')) {
    // A sign is allowed only before a number; inside an expression it is the next operator.
    if (end > at_ && !is_digit(text[end]) && text[end] != '.') break;
    ++end;
  }
  std::string_view digits = text.substr(at_, end - at_);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = grid::files::parse_double(
      digits.data(), digits.data() + digits.size(), value, grid::files::NumberForm::fixed);
  if (digits.empty() || error == std::errc::invalid_argument) {
    return refuse(ProblemName::bad_number, start, "a number was expected here");
  }
  if (stop != digits.data() + digits.size()) {
    return refuse(ProblemName::bad_number, start, fmt::format("'{}' is no number", digits));
  }
  if (error != std::errc{} || !std::isfinite(value)) {
    return refuse(
        ProblemName::number_out_of_range, start, fmt::format("'{}' is out of range", digits));
  }
  at_ = end;
  return value;
}

Result<long> ValueReader::integer() {
  const Place start = place();
  const auto value = real();
  CHAINTRUE_GCODE_TRY(value);
  const double rounded = std::round(*value);
  if (std::fabs(*value - rounded) > 0.0001 || std::fabs(rounded) > 1e9) {
    return refuse(ProblemName::bad_number,
                  start,
                  fmt::format("a whole number was expected, found {}", *value));
  }
  return static_cast<long>(rounded);
}

Result<std::string> ValueReader::angle_name() {
  const Place start = place();
  if (!accept("<")) return refuse(ProblemName::bad_parameter, start, "a name in <> was expected");
  const std::size_t close = line_.text.find('>', at_);
  if (close == std::string::npos || close == at_) {
    return refuse(ProblemName::bad_parameter, start, "the name is empty or its '>' is missing");
  }
  std::string name = line_.text.substr(at_, close - at_);
  at_ = close + 1;
  return name;
}

Result<double> ValueReader::parameter() {
  const Place start = place();
  ++at_;
  if (peek() == '<') {
    const auto name = angle_name();
    CHAINTRUE_GCODE_TRY(name);
    if (const auto value = parameters_.get(*name)) return *value;
    return refuse(ProblemName::bad_parameter, start, fmt::format("#<{}> has no value yet", *name));
  }
  const auto index = integer();
  CHAINTRUE_GCODE_TRY(index);
  if (*index < 1 || *index >= parameter::kCount) {
    return refuse(
        ProblemName::bad_parameter,
        start,
        fmt::format(
            "#{} does not exist: parameters are numbered 1 to {}", *index, parameter::kCount - 1));
  }
  return parameters_.get(static_cast<int>(*index));
}

Result<double> ValueReader::exists() {
  const Place start = place();
  if (!accept("[#")) return refuse(ProblemName::bad_expression, start, "exists takes [#<name>]");
  const auto name = angle_name();
  CHAINTRUE_GCODE_TRY(name);
  if (!accept("]")) return refuse(ProblemName::bad_expression, place(), "']' was expected");
  return truth(parameters_.get(*name).has_value());
}

Result<double> ValueReader::function() {
  const Place start = place();
  if (accept("exists")) return exists();
  if (accept("atan")) {
    const auto y = bracketed();
    if (!y) return y;
    if (!accept("/")) return refuse(ProblemName::bad_expression, place(), "atan takes [y]/[x]");
    const auto x = bracketed();
    if (!x) return x;
    return std::atan2(*y, *x) / kRadiansPerDegree;
  }
  for (const Function& candidate : kFunctions) {
    if (!accept(candidate.name)) continue;
    const auto value = bracketed();
    if (!value) return value;
    return finite(candidate.apply(*value), start);
  }
  return refuse(ProblemName::bad_number, start, "a number was expected here, not a letter");
}

Result<double> ValueReader::bracketed() {
  const Nesting nesting(*this);
  if (nesting.too_deep()) {
    return refuse(ProblemName::bad_expression, place(), "the expression is nested too deeply");
  }
  if (!accept("[")) return refuse(ProblemName::bad_expression, place(), "'[' was expected");
  const auto value = operand_chain(1);
  if (!value) return value;
  if (!accept("]")) {
    return refuse(ProblemName::bad_expression, place(), "an operator or ']' was expected");
  }
  return value;
}

Result<double> ValueReader::operand_chain(int lowest_precedence) {
  auto left = real();
  while (left) {
    const Operator* found =
        operator_at(std::string_view(line_.text).substr(std::min(at_, line_.text.size())));
    if (found == nullptr || found->precedence < lowest_precedence) return left;
    const Place start = place();
    at_ += found->name.size();
    // Operators that bind tighter belong to the right operand: operators group from the left.
    const auto right = operand_chain(found->precedence + 1);
    if (!right) return right;
    left = finite(found->apply(*left, *right), start);
  }
  return left;
}

std::string with_value(std::string_view word, double value) {
  std::string text(word);
  append_fixed(text, value == 0.0 ? 0.0 : value);
  return text;
}

}  // namespace chaintrue::gcode
