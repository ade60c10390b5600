// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A formula as a user writes it: parsed once with its units checked, evaluated with exact
/// derivatives.
///
///   sum      = term { (+ | -) term }
///   term     = factor { (* | /) factor }
///   factor   = (+ | -) factor | power
///   power    = atom [ ^ factor ]                  2^3^2 = 2^9, -x^2 = -(x^2), 2^-1 = 0.5
///   atom     = number | name | function(sum, ...) | (sum)
///   function = sin cos exp log sqrt abs step ramp (one argument), min max (two)
///
/// pi is known, and mm and N, which are 1 with their unit: x / (100 * mm) is a number. step(a) is 1 for a >= 0 and 0 below, with the derivative 0; ramp(a) = max(a, 0),
/// with the derivative 0 at a = 0.
///
/// Units: powers of mm and N; radians, visits and counts are numbers. A bare number takes the unit
/// of what it is added to or compared with. A function of a number takes a number.
///
/// Domain: at most 400 steps, brackets and signs at most 32 deep. Thread safe, does not allocate
/// when evaluated. Not modelled: conversion of units, conditions.
///
/// \code
///   const FormulaName names[] = {{"a_mm", {.mm = 1}}, {"phi", {}}};
///   const auto formula = Formula::parse("a_mm * sin(phi)", names, {.mm = 1});
///   if (!formula) say(formula.error().offset, formula.error().expected);
///   const Dual<1> values[] = {0.3, Dual<1>::variable(0.5, 0)};
///   formula->evaluate<1>(values);   // 0.3 sin(0.5), derivative 0.3 cos(0.5)
/// \endcode
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "model/dual.hpp"

namespace chaintrue::model::effects {

/// mm^mm N^n.
struct FormulaUnit {
  double mm = 0.0;
  double n = 0.0;
  friend bool operator==(const FormulaUnit&, const FormulaUnit&) = default;
};
/// "mm", "mm/N", "mm^2", "a number".
std::string words(const FormulaUnit& unit);

struct FormulaName {
  std::string name;
  FormulaUnit unit;
};

/// Why a text is not a formula.
struct FormulaProblem {
  std::size_t offset = 0;  ///< into the text, in bytes
  std::string found;
  std::string expected;
};

class Formula {
 public:
  /// `names` are the values that it may use; `wanted` is the required unit of the result.
  [[nodiscard]] static tl::expected<Formula, FormulaProblem> parse(
      std::string_view text, std::span<const FormulaName> names, const FormulaUnit& wanted);

  bool uses(std::size_t name) const;
  /// The value for these values of the names, in the order given to parse().
  template <int N>
  Dual<N> evaluate(std::span<const Dual<N>> values) const {
    return run<N>(values, nullptr);
  }
  /// The offset in the text at which the first value that is not finite arises; the end of the text
  /// if all are finite.
  template <int N>
  std::size_t first_not_finite(std::span<const Dual<N>> values) const {
    std::size_t offset = text_.size();
    (void)run<N>(values, &offset);
    return offset;
  }
  const std::string& text() const { return text_; }

  static constexpr std::size_t kMostSteps = 400;
  static constexpr std::size_t kDeepest = 32;

 private:
  friend class FormulaParser;
  enum class Kind {
    number,
    name,
    add,
    subtract,
    multiply,
    divide,
    power,
    negate,
    sine,
    cosine,
    exponential,
    logarithm,
    root,
    absolute,
    step,
    ramp,
    least,
    greatest
  };
  /// One operation on a stack of values.
  struct Step {
    Kind kind = Kind::number;
    double number = 0.0;
    std::size_t name = 0;
    std::size_t offset = 0;
  };
  /// A sum of terms of products holds two values at each of the levels of brackets, at most.
  static constexpr std::size_t kMostValues = 4 * kDeepest;

  template <int N>
  static Dual<N> unary(Kind kind, const Dual<N>& a) {
    switch (kind) {
      case Kind::negate:
        return -a;
      case Kind::sine:
        return sin(a);
      case Kind::cosine:
        return cos(a);
      case Kind::exponential:
        return exp(a);
      case Kind::logarithm:
        return log(a);
      case Kind::root:
        return sqrt(a);
      case Kind::absolute:
        return abs(a);
      case Kind::step:
        return {a.value >= 0.0 ? 1.0 : 0.0};
      case Kind::ramp:
        return a.value > 0.0 ? a : Dual<N>{};
      default:
        throw std::logic_error("a formula's step is no function of one value");
    }
  }
  template <int N>
  static Dual<N> binary(Kind kind, const Dual<N>& a, const Dual<N>& b) {
    switch (kind) {
      case Kind::add:
        return a + b;
      case Kind::subtract:
        return a - b;
      case Kind::multiply:
        return a * b;
      case Kind::divide:
        return a / b;
      case Kind::power:
        return pow(a, b);
      case Kind::least:
        return min(a, b);
      case Kind::greatest:
        return max(a, b);
      default:
        throw std::logic_error("a formula's step is no function of two values");
    }
  }
  static bool takes_two(Kind kind) {
    return (kind >= Kind::add && kind <= Kind::power) || kind >= Kind::least;
  }

  template <int N>
  Dual<N> run(std::span<const Dual<N>> values, std::size_t* not_finite) const {
    std::array<Dual<N>, kMostValues> stack;
    std::size_t top = 0;
    for (const Step& step : steps_) {
      if (step.kind == Kind::number) {
        stack[top++] = Dual<N>(step.number);
      } else if (step.kind == Kind::name) {
        stack[top++] = values[step.name];
      } else if (takes_two(step.kind)) {
        --top;
        stack[top - 1] = binary(step.kind, stack[top - 1], stack[top]);
      } else {
        stack[top - 1] = unary(step.kind, stack[top - 1]);
      }
      if (not_finite != nullptr && !is_finite(stack[top - 1])) {
        *not_finite = step.offset;
        break;
      }
    }
    return stack[top - 1];
  }

  std::string text_;
  std::vector<Step> steps_;
};

}  // namespace chaintrue::model::effects
