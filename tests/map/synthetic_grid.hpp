// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Grids with a known truth for the tests of the map.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "grid/files/map_file.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/synthetic/generator.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::testing_support {

/// A 7 x 4 grid as usual: sled up to 8 mm from the marks, 0.2 mm and 0.3 mm noise, six repeats,
/// motors and zeros drawn from their stated uncertainties.
inline grid::synthetic::SyntheticSpec usual_spec(std::uint64_t seed) {
  grid::synthetic::SyntheticSpec spec;
  spec.jitter_mm = 8.0;
  spec.noise.length_mm = 0.2;
  spec.noise.position_mm = 0.3;
  spec.repeats = 6;
  spec.draw_settings = true;
  spec.seed = seed;
  return spec;
}

/// The map of such a grid of a machine whose chains are a third heavier than stated: with a surface.
inline const grid::CompensationMap& sagging_map() {
  static const grid::CompensationMap map = [] {
    grid::synthetic::SyntheticSpec spec = usual_spec(5);
    spec.hidden = {{"chain_sag", "", {{"relative_weight", 0.3}}}};
    return grid::joint_fit(grid::synthetic::generate(model::Machine{}, spec)->grid).value().map;
  }();
  return map;
}

/// Commands over the bed but for its margin, row by row.
inline std::vector<model::BedPoint> commands(int columns, int rows) {
  std::vector<model::BedPoint> all;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      all.push_back({2160.0 * column / (columns - 1) - 1080.0, 1020.0 * row / (rows - 1) - 510.0});
  }
  return all;
}

/// Root mean square of a map's tool error, over a raster of the bed within the points.
template <class Map>
double true_tool_rms_mm(const Map& map, const grid::synthetic::SyntheticAnswer& answer) {
  const model::ReadingModel truth(answer.machine);
  double squares = 0.0;
  int count = 0;
  for (double x = -1200.0; x <= 1200.0; x += 100.0) {
    for (double y = -600.0; y <= 600.0; y += 100.0) {
      const auto reply = map.query({x, y});
      const auto reading = truth.at(answer.sheet.to_bed({x, y}));
      if (!reply || !reading) continue;
      const Eigen::Vector2d chain(reply->lengths.left_mm - reading->lengths.left_mm,
                                  reply->lengths.right_mm - reading->lengths.right_mm);
      squares += (reply->mark_jacobian.inverse() * chain).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

/// Its file is read as the same map and written again to the byte.
inline void expect_round_trip(const grid::CompensationMap& map, double relative_sigma = 1e-6) {
  const std::string text = grid::files::write_map(map);
  const grid::CompensationMap read = grid::files::parse_map(text, "map.json");
  EXPECT_EQ(grid::files::write_map(read), text);
  for (const model::MarkPoint p : {model::MarkPoint{-700.0, 333.0}, {0.0, 0.0}, {1200.0, -600.0}}) {
    const auto a = map.query(p), b = read.query(p);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    EXPECT_EQ(a->lengths.left_mm, b->lengths.left_mm);
    EXPECT_EQ(a->lengths.right_mm, b->lengths.right_mm);
    EXPECT_NEAR(a->sigma.left_mm, b->sigma.left_mm, relative_sigma * a->sigma.left_mm);
  }
}

/// For a map's lengths, at places within the points.
template <class Map>
void expect_derivatives_are_differences(const Map& map) {
  constexpr double kStepMm = 0.01;
  const auto at = [&](double x, double y) {
    const auto lengths = map.lengths({x, y})->lengths;
    return Eigen::Vector2d(lengths.left_mm, lengths.right_mm);
  };
  for (const auto& [x, y] : {std::pair(12.0, 34.0), std::pair(-700.0, -500.0),
                             std::pair(650.0, 550.0), std::pair(333.0, -77.0)}) {
    Eigen::Matrix2d difference;
    difference << at(x + kStepMm, y) - at(x - kStepMm, y), at(x, y + kStepMm) - at(x, y - kStepMm);
    // Central differences: step^2 / 6 times a third derivative of 1e-6, and rounding of 1e-12 / step.
    EXPECT_LT(
        (map.lengths({x, y})->mark_jacobian - difference / (2.0 * kStepMm)).cwiseAbs().maxCoeff(),
        1e-8)
        << x << " " << y;
  }
}

}  // namespace chaintrue::testing_support
