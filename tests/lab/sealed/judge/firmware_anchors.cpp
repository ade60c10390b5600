// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/firmware_anchors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <unsupported/Eigen/NumericalDiff>

namespace chaintrue::sealed {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;

/// Column of an anchor's x and y among the five unknowns; -1: fixed.
constexpr int kColumn[4][2] = {{0, 1}, {2, 3}, {-1, -1}, {4, -1}};

Eigen::Vector2d anchor(const Vector5& a, int belt) {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    if (kColumn[belt][axis] >= 0) at[axis] = a[kColumn[belt][axis]];
  }
  return at;
}

/// Where the upper two spans meet, below the line between their anchors.
std::optional<Eigen::Vector2d> place_of_upper(const Vector5& a, const Spans& spans) {
  const Eigen::Vector2d left = anchor(a, 0);
  const Eigen::Vector2d across = anchor(a, 1) - left;
  const double width = across.norm();
  const double along = (spans[0] * spans[0] - spans[1] * spans[1] + width * width) / (2.0 * width);
  const double square = spans[0] * spans[0] - along * along;
  if (!(square > 0.0)) return std::nullopt;
  const Eigen::Vector2d unit = across / width;
  return left + along * unit + std::sqrt(square) * Eigen::Vector2d(unit.y(), -unit.x());
}

/// Residuals (1) at anchors, each place where its own four are least: Gauss and Newton from where its upper spans
/// meet, or from the frame's middle.
struct Residuals : Eigen::DenseFunctor<double> {
  explicit Residuals(const std::vector<Spans>& all)
      : DenseFunctor(5, 4 * static_cast<int>(all.size())), spans(all) {}

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& all) const {
    constexpr int kSteps = 12;
    const Vector5 anchors = x;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      Eigen::Vector2d place = place_of_upper(anchors, spans[i]).value_or(0.5 * anchor(anchors, 1));
      Eigen::Vector4d r;
      for (int step = 0; step < kSteps; ++step) {
        Eigen::Matrix<double, 4, 2> slope;
        for (int j = 0; j < 4; ++j) {
          const Eigen::Vector2d way = place - anchor(anchors, j);
          r[j] = way.norm() - spans[i][static_cast<std::size_t>(j)];
          slope.row(j) = way.normalized();
        }
        if (step + 1 < kSteps)
          place -= (slope.transpose() * slope).inverse() * (slope.transpose() * r);
      }
      all.segment<4>(4 * static_cast<Eigen::Index>(i)) = r;
    }
    return 0;
  }

  const std::vector<Spans>& spans;
};

}  // namespace

FirmwareAnchors firmware_anchors(const std::vector<Spans>& spans) {
  if (spans.size() < 5) throw std::invalid_argument("anchors of fewer than five places");
  double longest = 0.0;
  for (const Spans& own : spans)
    longest = std::max(longest, *std::max_element(own.begin(), own.end()));
  Eigen::NumericalDiff<Residuals, Eigen::Central> residuals{Residuals(spans)};
  Vector5 best = Vector5::Zero();
  double least = std::numeric_limits<double>::infinity();
  // The firmware starts from the frame that its owner typed in, which is unknown here.
  for (const double width : {0.7, 1.0, 1.3, 1.6}) {
    for (const double height : {0.5, 0.7, 0.9, 1.2}) {
      Eigen::VectorXd anchors(5);
      anchors << 0.0, height, width, height, width;
      anchors *= longest;
      Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residuals, Eigen::Central>> search(residuals);
      search.minimize(anchors);
      if (!(search.fnorm() < least) || anchors[4] < 0.0) continue;
      least = search.fnorm();
      best = anchors;
    }
  }
  FirmwareAnchors result;
  result.converged = std::isfinite(least);
  if (!result.converged) return result;
  result.rms_mm = least / std::sqrt(4.0 * static_cast<double>(spans.size()));
  for (int belt = 0; belt < 4; ++belt) {
    const Eigen::Vector2d at = anchor(best, belt);
    result.anchors[static_cast<std::size_t>(belt)] = {at.x(), at.y()};
  }
  return result;
}

std::vector<double> lower_off_mm(const FirmwareAnchors& found, const std::vector<Spans>& spans) {
  Vector5 a;
  a << found.anchors[0][0], found.anchors[0][1], found.anchors[1][0], found.anchors[1][1],
      found.anchors[3][0];
  std::vector<double> off;
  for (const Spans& own : spans) {
    const auto place = place_of_upper(a, own);
    if (!place) continue;
    for (const int belt : {2, 3})
      off.push_back(own[static_cast<std::size_t>(belt)] - (*place - anchor(a, belt)).norm());
  }
  return off;
}

}  // namespace chaintrue::sealed
