// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "grid/files/map_file.hpp"
#include "grid/map/fit.hpp"

namespace chaintrue {
namespace {

/// The surface of seeds/001, there called z: 7 x 5 points over 2400 x 1200 mm.
double seed_length_mm(double x_mm, double y_mm) {
  return (2.0 * std::cos(x_mm / 4800.0 * std::numbers::pi) -
          std::sin(y_mm / 4800.0 * std::numbers::pi) + 0.8) *
         1000.0;
}

grid::MeasuredGrid seed_grid(int rows) {
  grid::MeasuredGrid grid;
  for (int iy = 0; iy < rows; ++iy) {
    for (int ix = 0; ix < 7; ++ix) {
      const double x = 400.0 * ix;
      const double y = 1200.0 * iy / (rows - 1);
      grid.points.push_back(
          {{x, y},
           model::ChainLengths{seed_length_mm(2400.0 - x, y), seed_length_mm(x, y)},
           std::nullopt,
           std::nullopt});
    }
  }
  return grid;
}

grid::FitOptions direct() {
  grid::FitOptions options;
  options.surface = grid::SurfaceKind::direct;
  return options;
}

TEST(DirectFit, GivesTheNumberOfTheFirstProposal) {
  const auto map = grid::fit(seed_grid(5), direct());
  ASSERT_TRUE(map);
  const auto answer = map->query({100.0, 200.0});
  ASSERT_TRUE(answer);
  // seeds/001 states 2665.4 and -0.23; the digits are those of Octave's interp2 'spline' on the
  // same grid.
  EXPECT_NEAR(answer->lengths.right_mm, 2665.422998, 1e-6);
  EXPECT_NEAR(seed_length_mm(100.0, 200.0) - answer->lengths.right_mm, -0.231343, 1e-6);
}

TEST(DirectFit, MeetsItsPointsAndRefusesToLeaveThem) {
  const auto map = grid::fit(seed_grid(4), direct());
  ASSERT_TRUE(map);
  for (const auto& point : map->contents().points)
    EXPECT_LT(point.mapped_mm.norm(), 1e-9);  // interpolation
  EXPECT_EQ(map->query({-1.0, 200.0}).error(), grid::MapReason::outside_map);
}

TEST(DirectFit, EstimatesTheErrorBetweenItsLines) {
  const auto map = grid::fit(seed_grid(5), direct());
  const double sigma =
      std::get<grid::DirectSurface>(map->contents().surface).interpolation_sigma_mm;
  // The true error over the bed is 0.263 mm at most and 0.080 mm rms; an estimate within a factor
  // of three is acceptable.
  EXPECT_GT(sigma, 0.027);
  EXPECT_LT(sigma, 0.24);
}

TEST(DirectFit, AcceptsEveryBoundaryCondition) {
  for (const auto end : {interp::EndCondition::not_a_knot, interp::EndCondition::natural,
                         interp::EndCondition::parabolic, interp::EndCondition::clamped}) {
    SCOPED_TRACE(static_cast<int>(end));
    grid::FitOptions options = direct();
    options.ends = {{end, end}, {end, end}};
    const auto map = grid::fit(seed_grid(5), options);
    ASSERT_TRUE(map);
    const auto read = grid::files::parse_map(grid::files::write_map(*map), "map.json");
    // With natural ends, the worst of the four, the error on this grid is 7.15 mm at most.
    EXPECT_NEAR(read.query({100.0, 200.0})->lengths.right_mm, seed_length_mm(100.0, 200.0), 7.2);
  }
}

TEST(DirectFit, RefusesPointsOffTheGrid) {
  auto grid = seed_grid(5);
  grid.points[8].mark.x_mm += 3.0;
  const auto map = grid::fit(grid, direct());
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().reason, grid::FitFailure::Reason::not_a_grid);
  EXPECT_THAT(map.error().sentence(), testing::HasSubstr("full rows and columns"));
}

}  // namespace
}  // namespace chaintrue
