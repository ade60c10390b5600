// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Recursive descent over one line.
#include "tools/gcode/value_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/files/parse_double.hpp"

namespace chaintrue::gcode {
namespace {

constexpr int kDeepest = 32;
/// LinuxCNC's TOLERANCE_EQUAL.
constexpr double kEqual = 0.0001;

using grid::files::is_digit;

struct Function {
  std::string_view name;
  double (*apply)(double);
  const char* refusal = "";  ///< where the result is not a number
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kArcDomain = "asin and acos need values from -1 to 1";

/// Longer names before their prefixes.
constexpr Function kFunctions[] = {
    {"abs", [](double x) { return std::fabs(x); }},
    {"acos", [](double x) { return std::acos(x) / kRadiansPerDegree; }, kArcDomain},
    {"asin", [](double x) { return std::asin(x) / kRadiansPerDegree; }, kArcDomain},
    {"cos", [](double x) { return std::cos(x * kRadiansPerDegree); }},
    {"exp", [](double x) { return std::exp(x); }},
    {"fix", [](double x) { return std::floor(x); }},
    {"fup", [](double x) { return std::ceil(x); }},
    {"ln", [](double x) { return x > 0.0 ? std::log(x) : kNone; }, "ln needs values above zero"},
    {"round", [](double x) { return std::trunc(x + (x < 0.0 ? -0.5 : 0.5)); }},
    {"sin", [](double x) { return std::sin(x * kRadiansPerDegree); }},
    {"sqrt", [](double x) { return std::sqrt(x); }, "sqrt needs values of at least zero"},
    {"tan", [](double x) { return std::tan(x * kRadiansPerDegree); }},
};

double truth(bool value) { return value ? 1.0 : 0.0; }

double modulo(double a, double b) {
  const double rest = std::fmod(a, b);
  return rest < 0.0 ? rest + std::fabs(b) : rest;
}

struct Operator {
  std::string_view name;
  int precedence;
  double (*apply)(double, double);
  const char* refusal = "";
};

/// `**` before `*`.
constexpr Operator kOperators[] = {
    {"**", 5, [](double a, double b) { return std::pow(a, b); },
     "a negative number has no such power"},
    {"*", 4, [](double a, double b) { return a * b; }},
    {"/", 4, [](double a, double b) { return b == 0.0 ? kNone : a / b; }, "a division by zero"},
    {"mod", 4, modulo, "mod by zero"},
    {"+", 3, [](double a, double b) { return a + b; }},
    {"-", 3, [](double a, double b) { return a - b; }},
    {"eq", 2, [](double a, double b) { return truth(std::fabs(a - b) < kEqual); }},
    {"ne", 2, [](double a, double b) { return truth(std::fabs(a - b) >= kEqual); }},
    {"gt", 2, [](double a, double b) { return truth(a > b); }},
    {"ge", 2, [](double a, double b) { return truth(a >= b); }},
    {"lt", 2, [](double a, double b) { return truth(a < b); }},
    {"le", 2, [](double a, double b) { return truth(a <= b); }},
    {"and", 1, [](double a, double b) { return truth(a != 0.0 && b != 0.0); }},
    {"or", 1, [](double a, double b) { return truth(a != 0.0 || b != 0.0); }},
    {"xor", 1, [](double a, double b) { return truth((a != 0.0) != (b != 0.0)); }},
};

const Operator* operator_at(std::string_view text) {
  for (const Operator& candidate : kOperators) {
    if (text.starts_with(candidate.name)) return &candidate;
  }
  return nullptr;
}

double finite(double value, const char* refusal, Place place) {
  if (std::isfinite(value)) return value;
  refuse(arithmetic, place, std::isnan(value) ? refusal : "the result is too large for a number");
}

/// The fewest decimals that read back as the value.
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

}  // namespace

Parameters::Parameters(State state)
    : values_(parameter::kCount, 0.0), frames_(1), state_(std::move(state)) {
  values_[parameter::kSystem] = 1.0;
}

double Parameters::get(int index) const {
  if (index == parameter::kTool) return state_("_current_tool").value();
  constexpr std::string_view kPosition[] = {"_x", "_y", "_z", "_a", "_b", "_c"};
  const auto axis = static_cast<std::size_t>(index - parameter::kPosition);
  return axis < std::size(kPosition) ? state_(kPosition[axis]).value() : stored(index);
}

void Parameters::set(int index, double value) { values_[static_cast<std::size_t>(index)] = value; }

bool Parameters::writable(int index) const {
  // 5400 to 5428 are the tool and the position.
  return index < parameter::kTool || index > 5428;
}

std::optional<double> Parameters::get(std::string_view name) const {
  if (const auto value = state_(name)) return value;
  const Names& names = name.starts_with('_') ? global_ : frames_.back().names;
  const auto found = names.find(name);
  if (found == names.end()) return std::nullopt;
  return found->second;
}

void Parameters::set(std::string_view name, double value) {
  if (state_(name)) return;
  Names& names = name.starts_with('_') ? global_ : frames_.back().names;
  names.insert_or_assign(std::string(name), value);
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

bool ValueReader::accept(std::string_view text) {
  if (!std::string_view(line_.text).substr(at_).starts_with(text)) return false;
  at_ += text.size();
  return true;
}

double ValueReader::real() {
  // No line can overflow the stack.
  if (++depth_ > kDeepest) refuse(bad_expression, place(), "the expression is nested too deeply");
  const double value = operand();
  --depth_;
  return value;
}

double ValueReader::operand() {
  const char c = peek();
  if (c == '\0') refuse(bad_number, place(), "a number is missing at the end of the line");
  if (c == '#') return parameter();
  if (c == '[') return bracketed();
  if (c == '+' || c == '-') {
    const char after = line_.text[at_ + 1];
    if (after != '\0' && !is_digit(after) && after != '.') {
      ++at_;
      const double value = real();
      return c == '-' ? -value : value;
    }
  }
  if (c >= 'a' && c <= 'z') return function();
  return number();
}

double ValueReader::number() {
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
  const auto [stop, error] = grid::files::parse_double(digits.data(), digits.data() + digits.size(),
                                                       value, grid::files::NumberForm::fixed);
  if (digits.empty() || error == std::errc::invalid_argument) {
    refuse(bad_number, start, "a number was expected here");
  }
  if (stop != digits.data() + digits.size()) {
    refuse(bad_number, start, "'{}' is not a number", digits);
  }
  if (error != std::errc{} || !std::isfinite(value)) {
    refuse(number_out_of_range, start, "'{}' is out of range", digits);
  }
  at_ = end;
  return value;
}

long ValueReader::integer() {
  const Place start = place();
  const auto value = real();
  const double rounded = std::round(value);
  if (std::fabs(value - rounded) > 0.0001 || std::fabs(rounded) > 1e9) {
    refuse(bad_number, start, "a whole number was expected, found {}", value);
  }
  return static_cast<long>(rounded);
}

std::string ValueReader::angle_name() {
  const Place start = place();
  if (!accept("<")) refuse(bad_parameter, start, "a name in <> was expected");
  const std::size_t close = line_.text.find('>', at_);
  if (close == std::string::npos || close == at_) {
    refuse(bad_parameter, start, "the name is empty or its '>' is missing");
  }
  std::string name = line_.text.substr(at_, close - at_);
  at_ = close + 1;
  return name;
}

double ValueReader::parameter() {
  const Place start = place();
  ++at_;
  if (peek() == '<') {
    const auto name = angle_name();
    if (const auto value = parameters_.get(name)) return *value;
    refuse(bad_parameter, start, "#<{}> has no value yet", name);
  }
  const auto index = integer();
  if (index < 1 || index >= parameter::kCount) {
    refuse(bad_parameter, start, "#{} does not exist: parameters are numbered 1 to {}", index,
           parameter::kCount - 1);
  }
  return parameters_.get(static_cast<int>(index));
}

double ValueReader::exists() {
  const Place start = place();
  if (!accept("[#")) refuse(bad_expression, start, "exists needs [#<name>]");
  const auto name = angle_name();
  if (!accept("]")) refuse(bad_expression, place(), "']' was expected");
  return truth(parameters_.get(name).has_value());
}

double ValueReader::function() {
  const Place start = place();
  if (accept("exists")) return exists();
  if (accept("atan")) {
    const double y = bracketed();
    if (!accept("/")) refuse(bad_expression, place(), "atan needs [y]/[x]");
    return std::atan2(y, bracketed()) / kRadiansPerDegree;
  }
  for (const Function& candidate : kFunctions) {
    if (!accept(candidate.name)) continue;
    return finite(candidate.apply(bracketed()), candidate.refusal, start);
  }
  refuse(bad_number, start, "a number was expected here, not a letter");
}

double ValueReader::bracketed() {
  if (!accept("[")) refuse(bad_expression, place(), "'[' was expected");
  const double value = operand_chain(1);
  if (!accept("]")) {
    refuse(bad_expression, place(), "an operator or ']' was expected");
  }
  return value;
}

double ValueReader::operand_chain(int lowest_precedence) {
  double left = real();
  for (;;) {
    const Operator* found = operator_at(std::string_view(line_.text).substr(at_));
    if (found == nullptr || found->precedence < lowest_precedence) return left;
    const Place start = place();
    at_ += found->name.size();
    // Operators that bind tighter belong to the right operand: operators group from the left.
    const double right = operand_chain(found->precedence + 1);
    left = finite(found->apply(left, right), found->refusal, start);
  }
}

std::string with_value(std::string_view word, double value) {
  std::string text(word);
  append_fixed(text, value == 0.0 ? 0.0 : value);
  return text;
}

}  // namespace chaintrue::gcode
