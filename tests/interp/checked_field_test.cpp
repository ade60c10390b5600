// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/checked_field.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/interp/truths.hpp"

namespace chaintrue::interp {
namespace {

using Value = CheckedField::Value;

constexpr std::uint64_t kFieldSeed = 20261122;
constexpr double kBound = 1e-4;

CheckedField::Function waves(double length) {
  return [length](double x, double y) -> std::optional<Value> {
    return Value{3.0 * std::sin(x / length) * std::cos(y / length),
                 2.0 * std::cos((x - y) / length)};
  };
}

// Waves from far longer than a cell to shorter than the finest cell.
class FieldOfWaves : public testing::TestWithParam<double> {};

TEST_P(FieldOfWaves, KeepsToItsBound) {
  SCOPED_TRACE(kFieldSeed);
  truths::Random random(kFieldSeed);
  const auto exact = waves(GetParam());
  CheckedField field(exact, {16.0, kBound, 2});
  int tabulated = 0;
  constexpr int kPlaces = 20000;
  for (int i = 0; i < kPlaces; ++i) {
    const double x = random.uniform(-240.0, 240.0);
    const double y = random.uniform(-120.0, 120.0);
    const auto z = field.value(x, y);
    if (!z) continue;
    ++tabulated;
    const Value truth = *exact(x, y);
    // The checked places have half the bound; a bicubic's error elsewhere is below twice that in
    // its middle.
    ASSERT_LE(std::hypot((*z)[0] - truth[0], (*z)[1] - truth[1]), kBound) << x << ' ' << y;
  }
  EXPECT_TRUE(GetParam() < 10.0 ? tabulated < kPlaces / 10 : tabulated == kPlaces) << tabulated;
}
INSTANTIATE_TEST_SUITE_P(Lengths, FieldOfWaves, testing::Values(3.0, 40.0, 150.0, 600.0));

TEST(CheckedField, IsExactForBicubicsAndKnowsTheirCurvature) {
  CheckedField field(
      [](double x, double y) {
        return Value{0.01 * x * x, x * y * y * y};
      },
      {2.0, 1e-9});
  const Value z = field.value(3.3, -1.2).value();
  EXPECT_NEAR(z[0], 0.01 * 3.3 * 3.3, 1e-12);  // rounding
  EXPECT_NEAR(z[1], 3.3 * -1.2 * 1.2 * 1.2, 1e-12);
  CheckedField parabola([](double x, double) { return Value{0.01 * x * x, 0.0}; }, {2.0, 1e-9});
  EXPECT_NEAR(parabola.curvature(0.5, 0.5), 0.02, 1e-12);
}

TEST(CheckedField, IsUndefinedNextToMissingNodes) {
  const auto half_plane = [](double x, double) -> std::optional<Value> {
    return x > 0.0 ? std::optional(Value{1.0, 2.0}) : std::nullopt;
  };
  CheckedField field(half_plane, {16.0, kBound, 1});
  EXPECT_FALSE(field.value(-5.0, 3.0));
  EXPECT_FALSE(field.value(1.0, 3.0));
  EXPECT_TRUE(field.value(20.0, 3.0));  // in a cell of half the size
  EXPECT_TRUE(field.value(50.0, 3.0));
  EXPECT_FALSE(field.value(1e9, 3.0));
  EXPECT_FALSE(field.value(NAN, 3.0));
  EXPECT_TRUE(std::isinf(field.curvature(-5.0, 3.0)));
}

TEST(CheckedField, CostsNoMoreThanItLeaves) {
  std::int64_t evaluated = 0;
  constexpr std::int64_t kFirst = 500;
  CheckedField field(
      [&](double x, double y) {
        ++evaluated;
        return waves(300.0)(x, y);
      },
      {16.0, kBound, 0, kFirst});
  std::int64_t left = 0;
  truths::Random random(kFieldSeed);
  for (int i = 0; i < 20000; ++i) {
    left += field.value(random.uniform(-480.0, 480.0), random.uniform(-240.0, 240.0)) ? 0 : 1;
    ASSERT_LE(evaluated, left < kFirst ? 0 : left + 18);  // 18 are those of one cell
  }
  EXPECT_LT(left, 8000);
}

TEST(CheckedField, RefusesMeaninglessOptions) {
  EXPECT_THROW(CheckedField(waves(1.0), {0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(CheckedField(waves(1.0), {1.0, NAN}), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::interp
