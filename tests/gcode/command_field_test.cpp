// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tabulated commands equal the exact ones within the bound, and fail where those fail.
#include "tools/gcode/command_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/gcode/formula_target.hpp"

namespace chaintrue::gcode {
namespace {

constexpr double kBoundMm = 1e-4;

double difference(const tl::expected<model::BedPoint, CorrectionFailure>& a,
                  const tl::expected<model::BedPoint, CorrectionFailure>& b) {
  return std::hypot(a->x_mm - b->x_mm, a->y_mm - b->y_mm);
}

/// The largest difference over random places, the tables made; counts agreement in failures.
double worst_difference(const Corrector& corrector, interp::Rectangle area, unsigned seed) {
  CommandField field(corrector, kBoundMm);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> x(area.x_min, area.x_max);
  std::uniform_real_distribution<double> y(area.y_min, area.y_max);
  double worst = 0.0;
  // More points than the tables of this area cost, so that most are interpolated.
  for (int i = 0; i < 60000; ++i) {
    const model::BedPoint target{x(random), y(random)};
    const auto found = field.command(target);
    const auto exact = corrector.command(target);
    EXPECT_EQ(found.has_value(), exact.has_value()) << target.x_mm << ' ' << target.y_mm;
    if (found && exact) worst = std::max(worst, difference(found, exact));
  }
  return worst;
}

class CommandFields : public testing::TestWithParam<double> {
 protected:
  PlainKinematics kinematics_;
};

/// Waves of the correction from far longer than a cell to shorter than the finest cell.
TEST_P(CommandFields, KeepToTheirBound) {
  const double wave = GetParam();
  const FormulaMap map([wave](model::BedPoint p) {
    return model::BedPoint{3.0 * std::sin(p.x_mm / wave) * std::cos(p.y_mm / wave),
                           2.0 * std::cos((p.x_mm - p.y_mm) / wave)};
  });
  const Corrector corrector(map, kinematics_, firmware(model::ControllerKind::ideal));
  const unsigned seed = 20261122U;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  // The bound is that of five points in each cell plus a quarter; between them a bicubic's error is
  // at most 1.3 times that in its middle.
  EXPECT_LE(worst_difference(corrector, {-480.0, 480.0, -240.0, 240.0}, seed), 1.3 * kBoundMm);
}
INSTANTIATE_TEST_SUITE_P(Waves, CommandFields, testing::Values(10.0, 40.0, 150.0, 600.0));

TEST(CommandField, SaysWhatTheMapSaysBeyondItsBounds) {
  const FormulaMap map([](model::BedPoint p) { return model::BedPoint{0.001 * p.x_mm, 2.0}; });
  const PlainKinematics kinematics;
  const Corrector corrector(map, kinematics, firmware(model::ControllerKind::ideal));
  const interp::Rectangle area = map.domain();
  // Along the upper edge, on both sides of it.
  EXPECT_LE(worst_difference(
                corrector,
                {area.x_min - 5.0, area.x_min + 300.0, area.y_max - 200.0, area.y_max + 5.0},
                7U),
            1.3 * kBoundMm);
}

TEST(CommandField, GivesTheSameAnswersForTheSameQuestions) {
  const FormulaMap map([](model::BedPoint p) {
    return model::BedPoint{std::sin(p.x_mm / 200.0), std::cos(p.y_mm / 300.0)};
  });
  const PlainKinematics kinematics;
  const Corrector corrector(map, kinematics, firmware(model::ControllerKind::ideal));
  CommandField one(corrector, kBoundMm);
  CommandField other(corrector, kBoundMm);
  for (int i = 0; i < 2000; ++i) {
    const model::BedPoint target{std::fmod(17.3 * i, 240.0), std::fmod(5.9 * i, 230.0)};
    const auto a = one.command(target);
    const auto b = other.command(target);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->x_mm, b->x_mm);
    EXPECT_EQ(a->y_mm, b->y_mm);
  }
}

}  // namespace
}  // namespace chaintrue::gcode
