// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/firmware_anchors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace chaintrue::sealed {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

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

struct State {
  Vector5 anchors;
  std::vector<Eigen::Vector2d> places;
};

double square_of(const State& state, const std::vector<Spans>& spans) {
  double sum = 0.0;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    for (int j = 0; j < 4; ++j) {
      const double r = (state.places[i] - anchor(state.anchors, j)).norm() -
                       spans[i][static_cast<std::size_t>(j)];
      sum += r * r;
    }
  }
  return sum;
}

/// One step with this damping.
State stepped(const State& state, const std::vector<Spans>& spans, double damping) {
  Matrix5 normal = Matrix5::Zero();
  Vector5 gradient = Vector5::Zero();
  std::vector<Eigen::Matrix2d> inverse(spans.size());
  std::vector<Eigen::Matrix<double, 2, 5>> across(spans.size());
  std::vector<Eigen::Vector2d> own(spans.size());
  for (std::size_t i = 0; i < spans.size(); ++i) {
    Eigen::Matrix<double, 4, 5> by_anchor = Eigen::Matrix<double, 4, 5>::Zero();
    Eigen::Matrix<double, 4, 2> by_place;
    Eigen::Vector4d r;
    for (int j = 0; j < 4; ++j) {
      const Eigen::Vector2d way = state.places[i] - anchor(state.anchors, j);
      r[j] = way.norm() - spans[i][static_cast<std::size_t>(j)];
      by_place.row(j) = way.normalized();
      for (int axis = 0; axis < 2; ++axis) {
        if (kColumn[j][axis] >= 0) by_anchor(j, kColumn[j][axis]) = -by_place(j, axis);
      }
    }
    Eigen::Matrix2d place_normal = by_place.transpose() * by_place;
    place_normal.diagonal() *= 1.0 + damping;
    inverse[i] = place_normal.inverse();
    across[i] = by_place.transpose() * by_anchor;
    own[i] = by_place.transpose() * r;
    Matrix5 anchor_normal = by_anchor.transpose() * by_anchor;
    anchor_normal.diagonal() *= 1.0 + damping;
    normal += anchor_normal - across[i].transpose() * inverse[i] * across[i];
    gradient += by_anchor.transpose() * r - across[i].transpose() * inverse[i] * own[i];
  }
  const Vector5 step = normal.ldlt().solve(-gradient);
  State next = state;
  next.anchors += step;
  for (std::size_t i = 0; i < spans.size(); ++i)
    next.places[i] -= inverse[i] * (own[i] + across[i] * step);
  return next;
}

/// From a rectangle; the least sum of squares that is reached.
std::optional<std::pair<double, State>> descended(double width,
                                                  double height,
                                                  const std::vector<Spans>& spans) {
  constexpr int kMostSteps = 400;
  constexpr double kConverged = 1e-12;
  State state;
  state.anchors << 0.0, height, width, height, width;
  for (const Spans& own : spans) {
    const auto place = place_of_upper(state.anchors, own);
    state.places.push_back(place.value_or(Eigen::Vector2d(0.5 * width, 0.5 * height)));
  }
  double square = square_of(state, spans);
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps && damping < 1e12; ++step) {
    const State next = stepped(state, spans, damping);
    const double there = square_of(next, spans);
    if (!(there < square)) {
      damping *= 10.0;
      continue;
    }
    const bool is_done = square - there < kConverged * square;
    state = next;
    square = there;
    damping *= 0.1;
    if (is_done) break;
  }
  if (!std::isfinite(square) || state.anchors[4] < 0.0) return std::nullopt;
  return std::pair(square, state);
}

}  // namespace

FirmwareAnchors firmware_anchors(const std::vector<Spans>& spans) {
  if (spans.size() < 5) throw std::invalid_argument("anchors of fewer than five places");
  double longest = 0.0;
  for (const Spans& own : spans) longest = std::max(longest, *std::max_element(own.begin(), own.end()));
  std::optional<std::pair<double, State>> best;
  // The firmware starts from the frame that its owner typed in, which is unknown here.
  for (const double width : {0.7, 1.0, 1.3, 1.6}) {
    for (const double height : {0.5, 0.7, 0.9, 1.2}) {
      auto found = descended(width * longest, height * longest, spans);
      if (found && (!best || found->first < best->first)) best = std::move(found);
    }
  }
  FirmwareAnchors result;
  if (!best) return result;
  result.converged = true;
  result.rms_mm = std::sqrt(best->first / (4.0 * static_cast<double>(spans.size())));
  for (int belt = 0; belt < 4; ++belt) {
    const Eigen::Vector2d at = anchor(best->second.anchors, belt);
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
