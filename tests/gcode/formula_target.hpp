// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Machines defined by formulas: "chain lengths" that are the coordinates of a displaced point, so
/// that every result is known in closed form.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/gcode/stub_map.hpp"

namespace chaintrue::gcode {

/// A controller whose lengths are coordinates.
class PlainKinematics final : public model::ControllerKinematics {
 public:
  [[nodiscard]] tl::expected<model::ChainLengths, model::PoseFailure> lengths(
      model::BedPoint command) const override {
    return model::ChainLengths{command.x_mm, command.y_mm};
  }
  [[nodiscard]] tl::expected<model::BedPoint, model::PoseFailure> command(
      model::ChainLengths lengths) const override {
    return model::BedPoint{lengths.left_mm, lengths.right_mm};
  }
};

/// lengths(p) = p + displacement(p).
class FormulaMap final : public StubMap {
 public:
  using Displacement = std::function<model::BedPoint(model::BedPoint)>;
  explicit FormulaMap(Displacement displacement)
      : StubMap({-1400.0, 1400.0, -800.0, 800.0}), displacement_(std::move(displacement)) {}

  [[nodiscard]] tl::expected<model::ChainLengths, grid::MapFailure> lengths(
      model::BedPoint p) const override {
    if (std::fabs(p.x_mm) > 1400.0 || std::fabs(p.y_mm) > 800.0)
      return tl::unexpected(grid::MapReason::outside_map);
    const model::BedPoint d = displacement_(p);
    return model::ChainLengths{p.x_mm + d.x_mm, p.y_mm + d.y_mm};
  }
  /// Fixed point: the displacement's gradient is a few percent, so 30 steps reach rounding.
  [[nodiscard]] tl::expected<model::BedPoint, grid::MapFailure> tool(
      model::ChainLengths lengths) const override {
    model::BedPoint p{lengths.left_mm, lengths.right_mm};
    for (int i = 0; i < 30; ++i) {
      const model::BedPoint d = displacement_(p);
      const model::BedPoint next{lengths.left_mm - d.x_mm, lengths.right_mm - d.y_mm};
      const double step = std::hypot(next.x_mm - p.x_mm, next.y_mm - p.y_mm);
      p = next;
      if (step < 1e-12) break;
    }
    return p;
  }

 private:
  Displacement displacement_;
};

/// A sum of waves no shorter than 700 mm: like the remaining error of a machine after a fit, a few
/// millimetres large.
inline FormulaMap::Displacement random_smooth_displacement(std::uint64_t seed) {
  struct Wave {
    double kx, ky, phase, ax, ay;
  };
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<Wave> waves;
  for (int i = 0; i < 6; ++i) {
    const double wavelength_mm = 700.0 + 2300.0 * uniform();
    const double direction = 2.0 * std::numbers::pi * uniform();
    const double k = 2.0 * std::numbers::pi / wavelength_mm;
    waves.push_back({k * std::cos(direction), k * std::sin(direction),
                     2.0 * std::numbers::pi * uniform(), 2.0 * uniform() - 1.0,
                     2.0 * uniform() - 1.0});
  }
  const double shift_x = 1.0 + 2.0 * uniform();
  const double shift_y = -1.0 - 2.0 * uniform();
  return [waves, shift_x, shift_y](model::BedPoint p) {
    model::BedPoint d{shift_x, shift_y};
    for (const Wave& wave : waves) {
      const double s = std::sin(wave.kx * p.x_mm + wave.ky * p.y_mm + wave.phase);
      d.x_mm += wave.ax * s;
      d.y_mm += wave.ay * s;
    }
    return d;
  };
}

struct NamedDisplacement {
  std::string name;
  FormulaMap::Displacement displacement;
};

inline std::vector<NamedDisplacement> displacements() {
  std::vector<NamedDisplacement> all = {
      {"scale_shear_and_turn",
       [](model::BedPoint p) {
         return model::BedPoint{0.8 + 0.002 * p.x_mm + 0.003 * p.y_mm,
                                -0.5 - 0.001 * p.x_mm - 0.0015 * p.y_mm};
       }},
      {"quadratic",
       [](model::BedPoint p) {
         return model::BedPoint{1.0 + 4e-6 * p.x_mm * p.x_mm - 3e-6 * p.y_mm * p.y_mm,
                                0.7 + 5e-6 * p.x_mm * p.y_mm};
       }},
  };
  for (const std::uint64_t seed : {1ULL, 2ULL, 3ULL}) {
    all.push_back({"random_smooth_seed_" + std::to_string(seed), random_smooth_displacement(seed)});
  }
  return all;
}

}  // namespace chaintrue::gcode
