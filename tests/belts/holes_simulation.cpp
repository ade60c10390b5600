// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/belts/holes_simulation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <complex>

#include "grid/random.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using model::Belt;

double span(const model::Anchor& anchor, double x, double y) {
  return std::hypot(x - anchor.x_mm, y - anchor.y_mm);
}

}  // namespace

BedPoint SimulatedHoles::tool(double left_mm, double right_mm) const {
  // Law of cosines at the top left anchor, in true millimetres.
  using Complex = std::complex<double>;
  const auto& a = truth.anchors;
  const Complex tl(scale * a.tl.x_mm, scale * a.tl.y_mm);
  const Complex beam = Complex(scale * a.tr.x_mm, scale * a.tr.y_mm) - tl;
  const double d = std::abs(beam);
  const double l = scale * left_mm;
  const double r = scale * right_mm;
  const double cosine = (l * l + d * d - r * r) / (2.0 * l * d);
  const Complex at = tl + std::polar(l, std::arg(beam) - std::acos(cosine));
  // Half a wave over the frame, as from a beam that yields.
  const double x = at.real() / 1500.0;
  const double y = at.imag() / 1300.0;
  return {at.real() + unmodelled_mm * std::sin(2.0 * x) * std::cos(y),
          at.imag() + unmodelled_mm * std::cos(1.5 * x) * std::sin(2.0 * y)};
}

SimulatedHoles simulate_with_holes(const HolesSimulation& simulation) {
  Random random(simulation.seed);
  SimulatedHoles result;
  result.scale = simulation.scale;
  result.unmodelled_mm = simulation.unmodelled_mm;
  model::BeltMachine& truth = result.truth;
  truth = belts::with_anchors(truth, {-27.6, 2064.9, 2924.3, 2066.5, 2953.2});
  belts::AnchorVector stated = belts::anchors_of(truth);
  for (double& coordinate : stated) coordinate += simulation.stated_off_mm * random.normal();
  result.belts.machine = belts::with_anchors(truth, stated);
  for (int row = 0; row < simulation.rows; ++row) {
    for (int column = 0; column < simulation.columns; ++column) {
      const double x = 2953.0 * (0.2 + 0.6 * column / (simulation.columns - 1));
      const double y = 2065.0 * (0.25 + 0.5 * row / (simulation.rows - 1));
      BeltPoint point;
      for (const Belt belt : model::kBelts) {
        point.lengths_mm[belt] =
            span(truth.anchors[belt], x, y) + simulation.belt_noise_mm * random.normal();
      }
      result.belts.points.push_back(std::move(point));
    }
  }
  result.holes.machine = result.belts.machine;
  MeasuredHoles& set = result.holes.set;
  set.tape.sigma_mm = simulation.tape_mm;
  set.hole_sigma_mm = simulation.hole_mm;
  std::vector<BedPoint> at;
  for (const double y : {-450.0, 0.0, 450.0}) {
    for (const double x : {-1000.0, 0.0, 1000.0}) {
      if (simulation.few_holes && (x == 0.0) != (y == 0.0)) continue;
      const model::FramePoint meant = model::to_frame(result.holes.machine, {x, y});
      const auto& believed = result.holes.machine.anchors;
      const BedPoint there = result.tool(span(believed.tl, meant.x_mm, meant.y_mm),
                                         span(believed.tr, meant.x_mm, meant.y_mm));
      at.push_back({there.x_mm + simulation.hole_mm * random.normal(),
                    there.y_mm + simulation.hole_mm * random.normal()});
      set.holes.push_back({std::string(1, static_cast<char>('A' + set.holes.size())), {x, y}});
    }
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t k = i + 1; k < at.size(); ++k) {
      // Neighbours and corners: 24 of 36.
      if (!simulation.few_holes && (i + k) % 3 == 0) continue;
      set.distances.push_back(
          {.from = i,
           .to = k,
           .distance_mm = std::hypot(at[i].x_mm - at[k].x_mm, at[i].y_mm - at[k].y_mm) +
                          simulation.tape_mm * random.normal()});
    }
  }
  return result;
}

double rms_when_laid(const std::vector<BedPoint>& from, const std::vector<BedPoint>& to) {
  const auto matrix_of = [](const std::vector<BedPoint>& points) {
    Eigen::Matrix2Xd all(2, std::ssize(points));
    for (std::size_t i = 0; i < points.size(); ++i)
      all.col(static_cast<Eigen::Index>(i)) << points[i].x_mm, points[i].y_mm;
    return all;
  };
  const Eigen::Matrix2Xd a = matrix_of(from), b = matrix_of(to);
  const Eigen::Matrix3d laid = Eigen::umeyama(a, b, false);
  return std::sqrt((laid * a.colwise().homogeneous() - b.colwise().homogeneous()).squaredNorm() /
                   static_cast<double>(from.size()));
}

}  // namespace chaintrue::grid
