// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a machine in use: a known error is reproduced.
#include "grid/map/controller_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grid/map/fit.hpp"
#include "model/controllers/payout.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue::grid::misses {
namespace {

using model::BedPoint;
using model::ChainLengths;

/// A machine that uses its file but has its motors elsewhere; the sheet is `shift_mm` to the right
/// of its nominal position.
struct Session {
  model::Machine file{};
  model::Machine truth{};
  double shift_mm = 0.0;

  Session(double left_x_mm, double both_y_mm, double shift) : shift_mm(shift) {
    truth.motors.left.x_mm += left_x_mm;
    truth.motors.left.y_mm += both_y_mm;
    truth.motors.right.y_mm += both_y_mm;
  }

  /// The tool's position in the sheet's numbers when sent to `command`.
  BedPoint reached(BedPoint command) const {
    const ChainLengths paid_out = *model::make_controller_kinematics(file)->lengths(command);
    const BedPoint on_bed = *model::make_controller_kinematics(truth)->command(paid_out);
    return {on_bed.x_mm - shift_mm, on_bed.y_mm};
  }

  MeasuredGrid readings() const {
    MeasuredGrid grid;
    grid.machine = file;
    grid.noise = StatedNoise{0.05, 0.05, 15.0};
    for (const BedPoint& command : testing_support::commands(9, 5)) {
      const BedPoint mark = reached(command);
      grid.points.push_back({{mark.x_mm, mark.y_mm}, std::nullopt, command, std::nullopt});
    }
    return grid;
  }
};

class ErrorInUse : public testing::TestWithParam<Session> {};

TEST_P(ErrorInUse, EqualsTheMachinesError) {
  const Session& session = GetParam();
  const auto map = fit(session.readings());
  ASSERT_TRUE(map) << map.error().sentence();
  const auto found = error_in_use(*map);
  ASSERT_TRUE(found);
  double squares_mm2 = 0.0;
  int within = 0;
  for (const MeasuredPlace& place : measured_places(*map, MapFrame::marks)) {
    if (place.is_on_edge) continue;
    ++within;
    const BedPoint reached = session.reached(place.commanded);
    squares_mm2 += std::pow(reached.x_mm - place.commanded.x_mm, 2) +
                   std::pow(reached.y_mm - place.commanded.y_mm, 2);
  }
  const double true_rms_mm = std::sqrt(squares_mm2 / within);
  // Three sigmas of the map's own error, and its first order: a thousandth of the error.
  EXPECT_NEAR(found->rms_mm, true_rms_mm,
              3.0 * map->contents().accuracy.expected_tool.rms_mm + 1e-3 * true_rms_mm);
}

INSTANTIATE_TEST_SUITE_P(Machines, ErrorInUse,
                         testing::Values(Session(0.0, 0.0, 0.0), Session(5.0, 0.0, 0.0),
                                         Session(3.0, -4.0, 0.0), Session(0.0, 0.0, 6.0),
                                         Session(-2.0, 3.0, 4.0)));

// Splines through lengths have no machine, so no error in use.
TEST(ErrorInUse, NeedsAMachine) {
  MeasuredGrid grid;
  const auto kinematics = model::make_controller_kinematics(model::Machine{});
  for (double x = -1000.0; x <= 1000.0; x += 250.0) {
    for (double y = -500.0; y <= 500.0; y += 250.0)
      grid.points.push_back({{x, y}, *kinematics->lengths({x, y}), std::nullopt, std::nullopt});
  }
  FitOptions options;
  options.surface = SurfaceKind::direct;
  const auto map = fit(grid, options);
  ASSERT_TRUE(map) << map.error().sentence();
  EXPECT_FALSE(error_in_use(*map));
}

}  // namespace
}  // namespace chaintrue::grid::misses
