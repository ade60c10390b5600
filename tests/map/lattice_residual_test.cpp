// SPDX-License-Identifier: GPL-3.0-or-later
// Readings without noise on full rows and columns: the map interpolates them, and reports it.
#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "grid/files/input_error.hpp"
#include "grid/map/fit.hpp"
#include "grid/random.hpp"
#include "model/reading_model.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue {
namespace {

using grid::CompensationMap;
using model::MarkPoint;
using testing::Contains;
using testing::HasSubstr;

/// The default machine plus a smooth term that no setting explains.
model::ChainLengths truth_at(MarkPoint p) {
  static const model::ReadingModel kModel{model::Machine{}};
  const model::ChainLengths machine = kModel.at(model::identity_placement(p)).value().lengths;
  return {machine.left_mm + 0.8 * std::sin(p.x_mm / 500.0) * std::cos(p.y_mm / 400.0),
          machine.right_mm + 0.8 * std::cos(p.x_mm / 450.0) * std::sin(p.y_mm / 420.0)};
}

grid::MeasuredGrid lattice() {
  grid::MeasuredGrid grid;
  grid.machine = model::Machine{};
  for (double y : {-609.6, -300.0, 0.0, 280.0, 609.6}) {
    for (double x : {-1219.2, -850.0, -400.0, 0.0, 400.0, 800.0, 1219.2}) {
      grid.points.push_back({{x, y}, truth_at({x, y}), std::nullopt, std::nullopt});
    }
  }
  return grid;
}

CompensationMap fitted_lattice(const grid::MeasuredGrid& grid) { return grid::fit(grid).value(); }

const grid::ModelSurface& surface_of(const CompensationMap& map) {
  return std::get<grid::ModelSurface>(map.contents().surface);
}

TEST(LatticeResidual, TheMapPassesThroughEveryReading) {
  const auto grid = lattice();
  const CompensationMap map = fitted_lattice(grid);
  ASSERT_TRUE(surface_of(map).lattice);
  EXPECT_THAT(map.contents().notes, Contains(HasSubstr("passes through every one")));
  for (const auto& point : grid.points) {
    const auto here = map.lengths(point.mark).value().lengths;
    EXPECT_NEAR(here.left_mm, point.lengths->left_mm, 1e-9);  // rounding of 3000 mm, some 2000 ulp
    EXPECT_NEAR(here.right_mm, point.lengths->right_mm, 1e-9);
  }
  testing_support::expect_derivatives_are_differences(map);
}

TEST(LatticeResidual, AnEmptyNodeIsFilledNamedAndDoubted) {
  auto grid = lattice();
  const MarkPoint empty = grid.points[17].mark;
  grid.points.erase(grid.points.begin() + 17);
  const CompensationMap map = fitted_lattice(grid);
  ASSERT_TRUE(surface_of(map).lattice);
  EXPECT_THAT(map.contents().notes, Contains(HasSubstr("No reading at (0, 0)")));
  const auto there = map.query(empty).value();
  const auto measured = map.query(grid.points[16].mark).value();
  EXPECT_GT(there.sigma.left_mm, 1.5 * measured.sigma.left_mm);
  EXPECT_LE(std::abs(there.lengths.left_mm - truth_at(empty).left_mm), 3.0 * there.sigma.left_mm);
  EXPECT_LE(std::abs(there.lengths.right_mm - truth_at(empty).right_mm),
            3.0 * there.sigma.right_mm);
}

TEST(LatticeResidual, SigmaGrowsBeyondTheLattice) {
  auto grid = lattice();
  grid.machine->bed.width_mm += 300.0;
  const CompensationMap map = fitted_lattice(grid);
  ASSERT_TRUE(surface_of(map).lattice);
  double before = map.query({1219.2, 0.0}).value().sigma.left_mm;
  for (double x : {1260.0, 1300.0, 1350.0}) {
    const double here = map.query({x, 0.0}).value().sigma.left_mm;
    EXPECT_GT(here, before) << x;
    before = here;
  }
}

TEST(LatticeResidual, NoisyReadingsUseThePenalisedSurface) {
  grid::Random random(1);
  auto grid = lattice();
  for (auto& point : grid.points) {
    point.lengths->left_mm += 0.3 * random.normal();
    point.lengths->right_mm += 0.3 * random.normal();
  }
  EXPECT_FALSE(surface_of(fitted_lattice(grid)).lattice) << "seed 1";
}

TEST(LatticeResidual, StatedNoiseRepeatsAndPointsBesideTheLinesKeepThePenalisedSurface) {
  auto stated = lattice();
  stated.noise = grid::StatedNoise{0.1, 0.1, 10.0};
  EXPECT_FALSE(surface_of(fitted_lattice(stated)).lattice);
  auto repeated = lattice();
  repeated.points.push_back(repeated.points.front());
  EXPECT_FALSE(surface_of(fitted_lattice(repeated)).lattice);
  auto alongside = lattice();
  alongside.points[8].mark.x_mm += 5.0;
  alongside.points[8].lengths = truth_at(alongside.points[8].mark);
  EXPECT_FALSE(surface_of(fitted_lattice(alongside)).lattice);
}

TEST(LatticeResidual, RoundTrips) {
  auto grid = lattice();
  grid.points.erase(grid.points.begin() + 17);
  const CompensationMap map = fitted_lattice(grid);
  ASSERT_TRUE(surface_of(map).lattice);
  testing_support::expect_round_trip(map, 0.0);
}

TEST(LatticeResidual, RefusesUnorderedNodes) {
  std::string text = grid::files::write_map(fitted_lattice(lattice()));
  const std::size_t at = text.find("-850", text.find("\"lattice\""));
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 4, "+850" + std::string());
  text[at] = ' ';
  try {
    static_cast<void>(grid::files::parse_map(text, "map.json"));
    FAIL() << "nodes out of order were taken";
  } catch (const grid::files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/on_machine/lattice/x_nodes_mm"));
    EXPECT_THAT(error.what(), HasSubstr("increasing numbers"));
  }
}

}  // namespace
}  // namespace chaintrue
