// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/follower/program_reader.hpp"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

namespace chaintrue::follower {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// In lower case, without blanks and comments.
std::string bare(const std::string& raw) {
  std::string text;
  bool comment = false;
  for (const char c : raw) {
    if (comment) {
      comment = c != ')';
    } else if (c == '(') {
      comment = true;
    } else if (c == ';') {
      break;
    } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  if (comment) throw std::runtime_error("a comment is not closed");
  return text;
}

double apply(const std::string& name, double a, double b) {
  if (name == "**") return std::pow(a, b);
  if (name == "*") return a * b;
  if (name == "/") return a / b;
  if (name == "mod") return a - std::fabs(b) * std::floor(a / std::fabs(b));
  if (name == "+") return a + b;
  if (name == "-") return a - b;
  if (name == "eq") return std::fabs(a - b) < 1e-4 ? 1.0 : 0.0;
  if (name == "ge") return a >= b ? 1.0 : 0.0;
  if (name == "le") return a <= b ? 1.0 : 0.0;
  if (name == "and") return a != 0.0 && b != 0.0 ? 1.0 : 0.0;
  if (name == "or") return a != 0.0 || b != 0.0 ? 1.0 : 0.0;
  throw std::runtime_error("unknown operation " + name);
}

}  // namespace

bool Reader::accept(const std::string& text) {
  if (text_.compare(at_, text.size(), text) != 0) return false;
  at_ += text.size();
  return true;
}

double Reader::real() {
  if (accept("[")) return expression();
  if (accept("#")) {
    const int index = static_cast<int>(std::lround(real()));
    return parameters_.contains(index) ? parameters_[index] : 0.0;
  }
  if (std::isalpha(static_cast<unsigned char>(peek())) != 0) return function();
  const std::size_t from = at_;
  std::size_t end = at_;
  if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
  if (end < text_.size() && end > from &&
      std::isdigit(static_cast<unsigned char>(text_[end])) == 0 && text_[end] != '.') {
    ++at_;
    return text_[from] == '-' ? -real() : real();
  }
  while (end < text_.size() &&
         (std::isdigit(static_cast<unsigned char>(text_[end])) != 0 || text_[end] == '.')) {
    ++end;
  }
  if (end == from) throw std::runtime_error("a number is missing in " + text_);
  at_ = end;
  return std::strtod(text_.substr(from, end - from).c_str(), nullptr);
}

double Reader::function() {
  static constexpr const char* kNames[] = {"atan", "abs", "acos",  "asin", "cos",  "exp", "fix",
                                           "fup",  "ln",  "round", "sin",  "sqrt", "tan"};
  for (const std::string name : kNames) {
    if (!accept(name)) continue;
    if (!accept("[")) throw std::runtime_error("'[' is missing behind " + name);
    const double x = expression();
    if (name == "atan") {
      if (!accept("/[")) throw std::runtime_error("atan has two values");
      return std::atan2(x, expression()) / kDegree;
    }
    if (name == "abs") return std::fabs(x);
    if (name == "acos") return std::acos(x) / kDegree;
    if (name == "asin") return std::asin(x) / kDegree;
    if (name == "cos") return std::cos(x * kDegree);
    if (name == "exp") return std::exp(x);
    if (name == "fix") return std::floor(x);
    if (name == "fup") return std::ceil(x);
    if (name == "ln") return std::log(x);
    if (name == "round") return std::round(x);
    if (name == "sin") return std::sin(x * kDegree);
    if (name == "sqrt") return std::sqrt(x);
    return std::tan(x * kDegree);
  }
  throw std::runtime_error("no function is known at the end of " + text_.substr(at_));
}

/// Powers first, then products, sums, comparisons, logic; each group from left to right.
std::string Reader::next_operator(int precedence) {
  static const std::vector<std::vector<std::string>> kGroups = {
      {"and", "or"}, {"eq", "ge", "le"}, {"+", "-"}, {"*", "/", "mod"}, {"**"}};
  for (const std::string& name : kGroups[static_cast<std::size_t>(precedence)]) {
    if (name == "*" && text_.compare(at_, 2, "**") == 0) continue;
    if (accept(name)) return name;
  }
  return {};
}

double Reader::operand(int precedence) {
  if (precedence == 5) return real();
  double value = operand(precedence + 1);
  for (std::string name = next_operator(precedence); !name.empty();
       name = next_operator(precedence))
    value = apply(name, value, operand(precedence + 1));
  return value;
}

double Reader::expression() {
  const double value = operand(0);
  if (!accept("]")) throw std::runtime_error("']' is missing in " + text_);
  return value;
}

Line Reader::read(const std::string& raw) {
  text_ = bare(raw);
  at_ = 0;
  Line line;
  std::vector<std::pair<int, double>> assignments;
  static_cast<void>(accept("/"));
  if (accept("n")) static_cast<void>(real());
  while (at_ < text_.size()) {
    const char letter = text_[at_++];
    if (letter == '#') {
      const int index = static_cast<int>(std::lround(real()));
      if (!accept("=")) throw std::runtime_error("'=' is missing in " + text_);
      assignments.emplace_back(index, real());
      continue;
    }
    const double value = real();
    if (letter == 'g') {
      line.g.push_back(static_cast<int>(std::lround(10.0 * value)));
    } else if (letter == 'm') {
      line.m.push_back(static_cast<int>(std::lround(value)));
    } else if (!line.words.emplace(letter, value).second) {
      throw std::runtime_error(std::string("a word stands twice: ") + letter);
    }
  }
  // Parameters take effect after the line that sets them.
  for (const auto& [index, value] : assignments) parameters_[index] = value;
  return line;
}

}  // namespace chaintrue::follower
