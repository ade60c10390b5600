// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a four-belt router, today and with fitted anchors, on machines with a known truth.
#include "grid/belts/belts_error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "grid/belts/anchor_fit.hpp"
#include "grid/belts/belts_fit.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid {
namespace {
namespace belts_error_tests {

constexpr double kShare = 0.5;

MeasuredBelts measured(double noise_mm, std::uint64_t seed) {
  return testing_support::belts_session({.columns = 6,
                                         .rows = 6,
                                         .width_share = kShare,
                                         .height_share = kShare,
                                         .noise_mm = noise_mm,
                                         .seed = seed});
}

/// Over the part of the frame that was measured: the tool of `truth` for commands of a controller
/// with `believed`, without the shift and turn that place the sheet.
double true_error_mm(const model::BeltMachine& believed, const model::BeltMachine& truth) {
  constexpr int kColumns = 20;
  constexpr int kRows = 12;
  const auto& a = testing_support::stated().anchors;
  const double width = kShare * 0.5 * (a.br.x_mm + a.tr.x_mm - a.tl.x_mm);
  const double height = kShare * 0.5 * (a.tl.y_mm + a.tr.y_mm);
  Eigen::Matrix2Xd commands(2, kColumns * kRows);
  Eigen::Matrix2Xd tools(2, kColumns * kRows);
  for (int i = 0; i < kColumns * kRows; ++i) {
    const model::BedPoint command{width * ((i % kColumns + 0.5) / kColumns - 0.5),
                                  height * ((i / kColumns + 0.5) / kRows - 0.5)};
    const auto paid_out = lengths_at(believed, model::to_frame(believed, command)).value();
    const model::FramePoint tool = place_of_upper(truth, paid_out.tl, paid_out.tr).value();
    commands.col(i) << command.x_mm, command.y_mm;
    tools.col(i) << tool.x_mm, tool.y_mm;
  }
  const Eigen::Matrix3d laid = Eigen::umeyama(tools, commands, false);
  const Eigen::Matrix2Xd off =
      (laid.topLeftCorner<2, 2>() * tools).colwise() + laid.topRightCorner<2, 1>() - commands;
  return std::sqrt(off.squaredNorm() / static_cast<double>(off.cols()));
}

TEST(BeltsError, TodayIsTheErrorOfTheTrueMachine) {
  const auto fit = fit_belts(measured(0.001, 1)).value();
  const auto error = error_of_belts(fit);
  ASSERT_TRUE(error);
  ASSERT_TRUE(error->today);
  const double true_mm = true_error_mm(testing_support::stated(), testing_support::truth());
  EXPECT_GT(true_mm, 1.0) << "12 and 9 mm at two anchors";
  // Two rasters over one area, whose outer rows lie up to a tenth of it apart; the effect of wrong
  // anchors grows at most with the square of the distance from the middle: 1 - 0.9^2.
  EXPECT_NEAR(error->today->rms_mm, true_mm, 0.19 * true_mm);
  EXPECT_GE(error->today->maximum_mm, error->today->rms_mm);
}

// To first order the error is the sum of the shifts by each principal axis of the anchors'
// covariance.
TEST(BeltsError, ExpectedFollowsFromTheAnchorCovariance) {
  const auto fit = fit_belts(measured(0.5, 1)).value();
  const auto error = error_of_belts(fit);
  ASSERT_TRUE(error);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(fit.covariance_mm2);
  double square = 0.0;
  for (Eigen::Index k = 0; k < axes.eigenvalues().size(); ++k) {
    const Eigen::VectorXd moved = belts::anchors_of(fit.machine) +
                                  std::sqrt(axes.eigenvalues()[k]) * axes.eigenvectors().col(k);
    square += std::pow(true_error_mm(belts::with_anchors(fit.machine, moved), fit.machine), 2);
  }
  // Two rasters, as above.
  EXPECT_NEAR(error->expected.rms_mm, std::sqrt(square), 0.19 * std::sqrt(square)) << "seed 1";
  EXPECT_GE(error->expected.maximum_mm, error->expected.rms_mm);
}

TEST(BeltsError, TodayNeedsTheAnchorsInForce) {
  MeasuredBelts belts = measured(0.5, 3);
  const auto known = error_of_belts(fit_belts(belts).value());
  belts.machine.anchors_known = false;
  const auto error = error_of_belts(fit_belts(belts).value());
  ASSERT_TRUE(known && error);
  EXPECT_TRUE(known->today);
  EXPECT_FALSE(error->today);
  // The sheet is laid by other anchors, 12 mm away of 2000: a per cent of what is uncertain.
  EXPECT_NEAR(error->expected.rms_mm, known->expected.rms_mm, 0.05 * known->expected.rms_mm);
}

TEST(BeltsError, IsUnknownForTooFewPlaces) {
  BeltsFit fit = fit_belts(measured(0.5, 4)).value();
  fit.places.resize(2);
  EXPECT_FALSE(error_of_belts(fit));
}

}  // namespace belts_error_tests
}  // namespace
}  // namespace chaintrue::grid
