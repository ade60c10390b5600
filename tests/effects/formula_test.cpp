// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The formula of a declared effect: values and derivatives against closed forms and differences,
/// units, and the messages for a text that is not a formula.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "model/effects/formula.hpp"

namespace chaintrue::model::effects::formulas {
namespace {

constexpr FormulaUnit kMm{.mm = 1.0};
const std::vector<FormulaName> kNames = {
    {"a_mm", kMm}, {"L", kMm}, {"phi", {}}, {"T", {.n = 1.0}}, {"k", {.mm = 1.0, .n = -1.0}}};

using Five = Dual<5>;

Formula formula(const std::string& text, const FormulaUnit& unit = kMm) {
  auto parsed = Formula::parse(text, kNames, unit);
  if (!parsed) {
    throw std::runtime_error(text + ": " + parsed.error().found + ", expected " +
                             parsed.error().expected);
  }
  return *parsed;
}

Five at(const Formula& f, const std::array<double, 5>& values) {
  std::array<Five, 5> variables;
  for (int i = 0; i < 5; ++i)
    variables[static_cast<std::size_t>(i)] = Five::variable(values[static_cast<std::size_t>(i)], i);
  return f.evaluate<5>(std::span<const Five>(variables));
}

double number(const std::string& text) { return at(formula(text, {}), {}).value; }

TEST(Formula, BindsAsArithmeticDoes) {
  // Exact: all values are small whole numbers and halves.
  EXPECT_EQ(number("1 + 2 * 3"), 7.0);
  EXPECT_EQ(number("10 - 3 - 2"), 5.0);
  EXPECT_EQ(number("8 / 4 / 2"), 1.0);
  EXPECT_EQ(number("2 ^ 3 ^ 2"), 512.0);
  EXPECT_EQ(number("-2 ^ 2"), -4.0);
  EXPECT_EQ(number("(-2) ^ 2"), 4.0);
  EXPECT_EQ(number("2 ^ -1"), 0.5);
  EXPECT_EQ(number("--3"), 3.0);
  EXPECT_EQ(number("+3 - -2"), 5.0);
  EXPECT_EQ(number("1.5e1 * .2e1"), 30.0);
  EXPECT_EQ(number("min(3, 2) + max(3, 2) * abs(-1)"), 5.0);
  EXPECT_EQ(number("step(0) + step(1) + step(-1)"), 2.0);
  EXPECT_EQ(number("ramp(2) + ramp(-2)"), 2.0);
  EXPECT_EQ(number("sqrt(16)"), 4.0);
  EXPECT_EQ(number("pi"), std::numbers::pi);
}

TEST(Formula, AgreesWithClosedFormsInValueAndSlope) {
  const std::array<double, 5> x = {0.3, 1800.0, 0.7, 55.0, 0.02};
  const Five creep = at(formula("a_mm * (1 - exp(-phi / 2))"), x);
  EXPECT_DOUBLE_EQ(creep.value, 0.3 * (1.0 - std::exp(-0.35)));
  EXPECT_DOUBLE_EQ(creep.d[0], 1.0 - std::exp(-0.35));
  EXPECT_DOUBLE_EQ(creep.d[2], 0.3 * 0.5 * std::exp(-0.35));
  const Five plane = at(formula("sqrt(L^2 + a_mm^2) - L"), x);
  EXPECT_NEAR(plane.value, std::hypot(1800.0, 0.3) - 1800.0, 1e-12);  // rounding of 1800 mm
  EXPECT_NEAR(plane.d[0], 0.3 / std::hypot(1800.0, 0.3), 1e-15);      // rounding of a slope of 2e-4
  const Five give = at(formula("k * T * ramp(phi - 0.5)"), x);
  EXPECT_DOUBLE_EQ(give.value, 0.02 * 55.0 * (0.7 - 0.5));
  EXPECT_DOUBLE_EQ(give.d[3], 0.02 * (0.7 - 0.5));
  EXPECT_DOUBLE_EQ(give.d[2], 0.02 * 55.0);
}

// Random formulas of every operation at random places, each slope against Richardson's
// extrapolation of central differences.
TEST(Formula, SlopesAgreeWithDifferences) {
  constexpr unsigned kSeed = 20;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> draw(0.5, 1.5);
  for (const char* text : {"a_mm * sin(phi) / cos(phi / 3)", "a_mm * exp(phi - 1) * log(phi + 2)",
                           "sqrt(a_mm * L) * phi^3", "abs(a_mm - 7) + L / (1 + phi^2)",
                           "min(a_mm, 9 * L) + max(L, a_mm / 99)", "k * T * (0.3 + phi)^(phi - 2)",
                           "L * 2^phi - a_mm * phi^-1.5", "ramp(a_mm - L / 9) + step(phi) * a_mm",
                           "-(a_mm - L)^3 / (a_mm + L)^2", "k^2 * T^2 / a_mm"}) {
    const Formula f = formula(text);
    for (int round = 0; round < 20; ++round) {
      std::array<double, 5> x;
      for (double& value : x) value = draw(random);
      const Five exact = at(f, x);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto slope = [&](double h) {
          std::array<double, 5> above = x;
          std::array<double, 5> below = x;
          above[i] += h;
          below[i] -= h;
          return (at(f, above).value - at(f, below).value) / (2.0 * h);
        };
        // Rounding 1e-16 / 1e-3, and 1e-3^4 times a fifth derivative below 1e3.
        EXPECT_NEAR((4.0 * slope(1e-3) - slope(2e-3)) / 3.0, exact.d[i],
                    1e-8 * (1.0 + std::abs(exact.d[i])))
            << text << " by " << kNames[i].name;
      }
    }
  }
}

TEST(Formula, KinksHaveTheSlopeOfOneSide) {
  const std::array<double, 5> x = {0.0, 1.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(at(formula("L * ramp(phi)"), x).d[2], 0.0);
  EXPECT_EQ(at(formula("L * max(0, phi)"), x).d[2], 0.0);
  EXPECT_EQ(at(formula("L * abs(phi)"), x).d[2], 0.0);
  EXPECT_EQ(at(formula("L * step(phi)"), x).value, 1.0);
}

TEST(Formula, AcceptsUnitsThatComeOut) {
  for (const char* text : {"a_mm", "k * T", "L * phi + 3", "a_mm^2 / L", "sqrt(a_mm * L)",
                           "max(0, a_mm)", "a_mm * step(T - 40)", "0.1", "L^(1/2) * a_mm^0.5",
                           "1 + L", "min(2, 3)", "a_mm * sin(L / (100 * mm)) * T / (3 * N)"})
    EXPECT_TRUE(Formula::parse(text, kNames, kMm).has_value()) << text;
}

struct Bad {
  const char* text;
  std::size_t offset;
  const char* found;
  const char* expected;
};

class NoFormula : public testing::TestWithParam<Bad> {};

TEST_P(NoFormula, AnInvalidFormulaIsRefusedAtItsPlace) {
  const Bad& bad = GetParam();
  const auto parsed = Formula::parse(bad.text, kNames, kMm);
  ASSERT_FALSE(parsed) << bad.text;
  EXPECT_EQ(parsed.error().offset, bad.offset) << bad.text;
  EXPECT_EQ(parsed.error().found, bad.found);
  EXPECT_EQ(parsed.error().expected, bad.expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, NoFormula,
    testing::Values(
        Bad{"", 0, "an empty formula", "a formula, such as 0.1 * a_mm"},
        Bad{"a_mm * L1", 7, "L1",
            "a name that this formula may use: a_mm, L, phi, T, k, mm, N, pi"},
        Bad{"a_mm * tan(phi)", 7, "tan(",
            "one of the functions sin, cos, exp, log, sqrt, abs, step, ramp, min, max"},
        Bad{"max(a_mm)", 0, "max with 1 argument", "max with two arguments, as in max(a, b)"},
        Bad{"a_mm * sin()", 7, "sin with 0 arguments", "sin with one argument"},
        Bad{"a_mm * sin(phi, 2)", 7, "sin with 2 arguments", "sin with one argument"},
        Bad{"a_mm + T", 5, "mm together with N", "two values with the same unit"},
        Bad{"sin(L)", 0, "sin of mm",
            "sin of a plain number; divide by a quantity with the same unit, as in sin(x / (100 * "
            "mm))"},
        Bad{"a_mm * L", 0, "a formula in mm^2", "one whose units come out as mm"},
        Bad{"phi", 0, "a formula in numbers without a unit", "one whose units come out as mm"},
        Bad{"a_mm ^ phi", 5, "mm to a power that varies",
            "a plain number after ^, so that the unit is known"},
        Bad{"phi ^ L", 4, "a power of mm", "a number after ^"},
        Bad{"(a_mm", 5, "the end", "a closing bracket )"},
        Bad{"a_mm)", 4, ")", "no unmatched closing bracket"},
        Bad{"a_mm L", 5, "L", "an operator + - * / ^, or the end"},
        Bad{"a_mm *", 6, "the end", "a number, a name, a function or an opening bracket"},
        Bad{"a_mm * 1e999", 7, "1", "a number within the range of the computer"},
        Bad{"a_mm \xC2\xB7 2", 5, "\xC2\xB7", "an operator + - * / ^, or the end"},
        Bad{"sin", 0, "sin", "a bracket after sin, as in sin(...)"}));

TEST(Formula, RefusesTenThousandNestedBrackets) {
  const std::string text = std::string(10000, '(') + "a_mm" + std::string(10000, ')');
  const auto parsed = Formula::parse(text, kNames, kMm);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().found, "brackets, signs and powers more than 32 deep");
  EXPECT_EQ(parsed.error().offset, 32U);
  for (const std::string& sign : {std::string(10000, '-') + "a_mm", "a_mm" + [] {
                                    std::string powers;
                                    for (int i = 0; i < 10000; ++i) powers += "^1";
                                    return powers;
                                  }()})
    EXPECT_FALSE(Formula::parse(sign, kNames, kMm));
}

TEST(Formula, RefusesMoreStepsThanItKeeps) {
  std::string text = "a_mm";
  for (int i = 0; i < 10000; ++i) text += " + 1";
  const auto parsed = Formula::parse(text, kNames, kMm);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().expected, "a shorter formula");
}

// The deepest accepted formula fits the stack of evaluate().
TEST(Formula, TheDeepestFormulaIsEvaluated) {
  std::string text = "1";
  for (std::size_t i = 0; i + 1 < Formula::kDeepest; ++i)
    text = "(1 + 1 * max(0, 1 * " + text + "))";
  while (!Formula::parse(text, kNames, {})) {
    ASSERT_GT(text.size(), 10U);
    text = text.substr(std::string("(1 + 1 * max(0, 1 * ").size(),
                       text.size() - std::string("(1 + 1 * max(0, 1 * ").size() - 2);
  }
  EXPECT_GT(number(text), 10.0);
}

TEST(Formula, ReportsWhereAValueIsNotFinite) {
  const Formula f = formula("a_mm * (1 + log(phi))");
  std::array<Five, 5> values;
  values[0] = 1.0;
  EXPECT_EQ(f.first_not_finite<5>(std::span<const Five>(values)), 12U);
  values[2] = 1.0;
  EXPECT_EQ(f.first_not_finite<5>(std::span<const Five>(values)), f.text().size());
}

}  // namespace
}  // namespace chaintrue::model::effects::formulas
