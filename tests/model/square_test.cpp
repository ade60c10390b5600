// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/square.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace chaintrue::model {
namespace {

// The squares that were traced: at the lower left corner of the bed, and a metre higher, below the
// point.
constexpr SquareTask kLow{.size_mm = 100.0, .corner = {-1040.0, -465.0}};
constexpr SquareTask kHigh{.size_mm = 100.0, .corner = {-1040.0, 535.0}, .below = true};

TEST(Square, AControllerThatKnowsTheMachineCutsASquare) {
  Machine machine;
  machine.chain_zero = {2.0, -1.0};
  for (const SquareTask& task : {kLow, kHigh}) {
    const auto square = predict_square(machine, machine, task);
    ASSERT_TRUE(square);
    // Newton of ReadingModel::find, 1e-9 mm.
    for (const SquareSide side : kSquareSides) {
      EXPECT_NEAR(square->side(side).length_mm, 100.0, 4e-9);
      EXPECT_NEAR(square->side(side).bow_mm, 0.0, 4e-9);
    }
    EXPECT_NEAR(square->rising_diagonal_mm, 100.0 * std::sqrt(2.0), 4e-9);
    EXPECT_NEAR(square->falling_diagonal_mm, 100.0 * std::sqrt(2.0), 4e-9);
    EXPECT_NEAR(square->offset.x_mm, 0.0, 4e-9);
    EXPECT_NEAR(square->rotation_rad, 0.0, 1e-10);
    EXPECT_EQ(square->cut.size(), 404u);
  }
}

TEST(Square, RunsClockwiseFromTheLowerLeftCorner) {
  const auto square = predict_square(Machine{}, Machine{}, kHigh);
  ASSERT_TRUE(square);
  EXPECT_EQ(square->commanded.front().x_mm, -1040.0);
  EXPECT_EQ(square->commanded.front().y_mm, 435.0);
  EXPECT_EQ(square->commanded[100].y_mm, 535.0);   // up the left side
  EXPECT_EQ(square->commanded[201].x_mm, -940.0);  // along the top
  EXPECT_EQ(square->commanded.back().x_mm, -1040.0);
}

TEST(Square, AMovedMachineOnlyMovesTheSquare) {
  Machine moved;
  for (const Side side : kSides) {
    moved.motors[side].x_mm += 4.0;
    moved.motors[side].y_mm -= 7.0;
  }
  const auto square = predict_square(moved, Machine{}, kLow);
  ASSERT_TRUE(square);
  EXPECT_NEAR(square->offset.x_mm, 4.0, 4e-9);  // as above
  EXPECT_NEAR(square->offset.y_mm, -7.0, 4e-9);
  EXPECT_NEAR(square->side(SquareSide::top).length_mm, 100.0, 4e-9);
  EXPECT_NEAR(square->side(SquareSide::top).bow_mm, 0.0, 4e-9);
}

// Straight chains to points, with every true dimension and the chain's links larger by the factor 1
// + e: the square is larger by the same factor.
TEST(Square, LongerLinksOnALargerMachineCutALargerSquare) {
  constexpr double kElongation = 0.002;
  Machine believed;
  believed.controller.kind = ControllerKind::fluidnc_wallplotter;
  Machine truth;
  for (const Side side : kSides) {
    truth.motors[side].x_mm *= 1.0 + kElongation;
    truth.motors[side].y_mm *= 1.0 + kElongation;
  }
  truth.attachment = Ring{139.1 * (1.0 + kElongation)};
  truth.effects = {{"chain_pitch_error", "both", {{"elongation", kElongation}}}};
  const auto square = predict_square(truth, believed, kLow, Model::straight);
  ASSERT_TRUE(square);
  for (const SquareSide side : kSquareSides) {
    EXPECT_NEAR(square->side(side).length_mm, 100.0 * (1.0 + kElongation), 4e-9);  // as above
    EXPECT_NEAR(square->side(side).bow_mm, 0.0, 4e-9);
  }
  EXPECT_NEAR(square->offset.x_mm, -990.0 * kElongation, 4e-9);
  EXPECT_NEAR(square->offset.y_mm, -415.0 * kElongation, 4e-9);
}

// A rotated beam turns the square by its own angle, to the first order in the angle.
TEST(Square, ARotatedMachineRotatesTheSquare) {
  constexpr double kAngle = 1e-3;
  Machine truth;
  for (const Side side : kSides) {
    const MotorPosition m = Machine{}.motors[side];
    truth.motors[side] = {m.x_mm * std::cos(kAngle) - m.y_mm * std::sin(kAngle),
                          m.x_mm * std::sin(kAngle) + m.y_mm * std::cos(kAngle)};
  }
  Machine believed;
  believed.controller.kind = ControllerKind::fluidnc_wallplotter;
  truth.controller = believed.controller;
  const auto square = predict_square(truth, believed, kLow, Model::straight);
  ASSERT_TRUE(square);
  EXPECT_NEAR(square->rotation_rad, kAngle, 1e-10);
  EXPECT_NEAR(square->side(SquareSide::left).length_mm, 100.0, 4e-9);
}

// The formula without a sprocket: the square in the upper corner is skewed and bowed, which the
// wrap corrects.
TEST(Square, AControllerWithoutWrapBendsTheUpperSquare) {
  Machine truth;
  Machine believed;
  believed.controller.kind = ControllerKind::fluidnc_wallplotter;
  const auto straight = predict_square(truth, believed, kHigh);
  believed.controller.kind = ControllerKind::maslow_classic;
  const auto wrapped = predict_square(truth, believed, kHigh);
  ASSERT_TRUE(straight && wrapped);
  const auto worst = [](const CutSquare& square) {
    double most = 0.0;
    for (const SquareSide side : kSquareSides)
      most = std::max(most, std::abs(square.side(side).length_mm - 100.0));
    return most;
  };
  EXPECT_GT(worst(*straight), 0.3);  // visible with a ruler
  EXPECT_LT(worst(*wrapped), 0.5 * worst(*straight));
}

TEST(Square, NamesAnUncuttablePoint) {
  const auto square =
      predict_square(Machine{}, Machine{}, {.size_mm = 100.0, .corner = {-50.0, 1040.0}});
  ASSERT_FALSE(square);
  EXPECT_TRUE(square.error().place.of_controller);
  EXPECT_EQ(square.error().reason, PoseReason::above_sprockets);
  EXPECT_GE(square.error().place.commanded.y_mm, 1072.6);
}

TEST(Square, RefusesInvalidSizes) {
  for (const double size : {0.0, -5.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(std::ignore = predict_square(Machine{}, Machine{}, {.size_mm = size}),
                 std::invalid_argument);
  }
}

}  // namespace
}  // namespace chaintrue::model
