// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: strength.hpp.
#include "generator/hidden/strength.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace chaintrue::generator {
namespace {

// Wide enough that the rounding of a pose (1e-10 mm) is negligible, narrow enough that the cubic
// term of a length of 1 m is as well.
constexpr double kStep = 0.5;
constexpr Eigen::Index kSettings = 6;

std::optional<std::vector<Lengths>> lengths_of(const TrueMachine& machine,
                                               std::span<const Visit> visits,
                                               const std::vector<Rest>& near) {
  const auto at_rest = rests(machine, visits, &near);
  if (!at_rest) return std::nullopt;
  return readings(machine, {}, visits, *at_rest);
}

// Central difference of the readings between two sessions.
std::optional<std::vector<Lengths>> difference(const TrueMachine& plus,
                                               std::span<const Visit> plus_visits,
                                               const TrueMachine& minus,
                                               std::span<const Visit> minus_visits,
                                               const std::vector<Rest>& near) {
  const auto p = lengths_of(plus, plus_visits, near);
  const auto m = lengths_of(minus, minus_visits, near);
  if (!p || !m) return std::nullopt;
  std::vector<Lengths> slope(p->size());
  for (std::size_t i = 0; i < slope.size(); ++i) {
    for (std::size_t c = 0; c < 2; ++c) slope[i][c] = ((*p)[i][c] - (*m)[i][c]) / (2.0 * kStep);
  }
  return slope;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

std::vector<Visit> moved(std::span<const Visit> visits, double dx, double dy) {
  std::vector<Visit> result(visits.begin(), visits.end());
  for (Visit& v : result) v.place = {v.place.x + dx, v.place.y + dy};
  return result;
}

}  // namespace

Projection::Projection(const Eigen::MatrixXd& columns) : taken_(orthonormal(columns)) {}

Signature Projection::left_of(const Eigen::VectorXd& rows) const {
  Signature all = Signature::Zero(taken_.rows());
  all.head(rows.size()) = rows;
  all -= taken_ * (taken_.transpose() * all);
  return all;
}

std::optional<Yardstick> Yardstick::make(const TrueMachine& machine, std::span<const Visit> visits,
                                         NoiseLevel noise, StatedSigmas stated) {
  Yardstick y;
  y.machine_ = machine;
  y.machine_.wheel = WheelShape::round;
  y.visits_.assign(visits.begin(), visits.end());
  auto at_rest = rests(y.machine_, visits);
  if (!at_rest) return std::nullopt;
  y.rests_ = std::move(*at_rest);
  y.plain_ = readings(y.machine_, {}, visits, y.rests_);

  const auto by_x = difference(y.machine_, moved(visits, kStep, 0), y.machine_,
                               moved(visits, -kStep, 0), y.rests_);
  const auto by_y = difference(y.machine_, moved(visits, 0, kStep), y.machine_,
                               moved(visits, 0, -kStep), y.rests_);
  if (!by_x || !by_y) return std::nullopt;
  const double l2 = noise.length_mm * noise.length_mm;
  const double p2 = noise.position_mm * noise.position_mm;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const double a = (*by_x)[i][0], b = (*by_y)[i][0], c = (*by_x)[i][1], d = (*by_y)[i][1];
    y.slopes_.push_back({a, b, c, d});
    const double c00 = l2 + p2 * (a * a + b * b);
    const double c10 = p2 * (a * c + b * d);
    const double c11 = l2 + p2 * (c * c + d * d);
    const double f00 = std::sqrt(c00), f10 = c10 / f00, f11 = std::sqrt(c11 - f10 * f10);
    y.whitening_.push_back({1.0 / f00, -f10 / (f00 * f11), 1.0 / f11});
  }

  const auto rows = static_cast<Eigen::Index>(2 * visits.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows + kSettings, kSettings);
  for (Eigen::Index k = 0; k < kSettings; ++k) {
    std::vector<Lengths> slope(visits.size());
    if (k < 4) {
      TrueMachine plus = y.machine_, minus = y.machine_;
      const auto motor = static_cast<std::size_t>(k / 2);
      (k % 2 == 0 ? plus.axis[motor].x : plus.axis[motor].y) += kStep;
      (k % 2 == 0 ? minus.axis[motor].x : minus.axis[motor].y) -= kStep;
      const auto found = difference(plus, visits, minus, visits, y.rests_);
      if (!found) return std::nullopt;
      slope = *found;
    } else {
      for (Lengths& s : slope) s[static_cast<std::size_t>(k - 4)] = 1.0;
    }
    a.col(k).head(rows) = y.whitened(slope);
    a(rows + k, k) = 1.0 / (k < 4 ? stated.motor_mm : stated.zero_mm);
  }
  y.by_setting_ = a;
  y.settings_ = Projection(a);
  return y;
}

Eigen::VectorXd Yardstick::whitened(std::span<const Lengths> pairs) const {
  Eigen::VectorXd rows(static_cast<Eigen::Index>(2 * pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& w = whitening_[i];
    const auto r = static_cast<Eigen::Index>(2 * i);
    rows[r] = w[0] * pairs[i][0];
    rows[r + 1] = w[1] * pairs[i][0] + w[2] * pairs[i][1];
  }
  return rows;
}

std::optional<Signature> Yardstick::signature(std::span<const Hidden> effects) const {
  const TrueMachine with = altered(machine_, effects);
  bool machine_changes = false;
  for (const Hidden& e : effects) machine_changes |= card(e.cause).alters_machine();
  std::vector<Lengths> read;
  if (machine_changes) {
    const auto at_rest = rests(with, visits_, &rests_);
    if (!at_rest) return std::nullopt;
    read = readings(with, effects, visits_, *at_rest);
  } else {
    read = readings(with, effects, visits_, rests_);
  }
  for (std::size_t i = 0; i < read.size(); ++i) {
    const Vec2 mark = written(visits_[i].place, effects);
    const double dx = mark.x - visits_[i].place.x, dy = mark.y - visits_[i].place.y;
    const auto& j = slopes_[i];
    read[i][0] -= plain_[i][0] + j[0] * dx + j[1] * dy;
    read[i][1] -= plain_[i][1] + j[2] * dx + j[3] * dy;
  }
  return settings_.left_of(whitened(read));
}

Signature Yardstick::signature_of(const Disturbance& disturbance) const {
  std::vector<Lengths> pairs;
  const std::vector<Site> sites = sites_of(visits_, rests_);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec2 own = disturbance.at(sites[i]);
    const auto& j = slopes_[i];
    if (disturbance.moves_tool)
      pairs.push_back({j[0] * own.x + j[1] * own.y, j[2] * own.x + j[3] * own.y});
    else
      pairs.push_back({own.x, own.y});
  }
  return signature_of_lengths(pairs);
}

Signature Yardstick::signature_of_lengths(std::span<const Lengths> extra) const {
  return settings_.left_of(whitened(extra));
}

std::vector<double> Yardstick::angles(std::size_t chain) const {
  std::vector<double> all;
  for (const Rest& r : rests_) all.push_back(r.chain[chain].angle_rad);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Rival> Yardstick::rivals() const {
  constexpr int kPlaces = 24;
  std::vector<Rival> all;
  const auto add = [&](const CauseCard& c, Where where, std::span<const double> places) {
    Eigen::MatrixXd columns(by_setting_.rows(), static_cast<Eigen::Index>(places.size()));
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Hidden one[] = {{c.cause, where, c.usual, places[k]}};
      const auto s = signature(one);
      if (!s || !(s->norm() > 1e-9)) return;
      columns.col(static_cast<Eigen::Index>(k)) = *s;
    }
    all.push_back({c.cause, where, orthonormal(columns)});
  };
  for (const CauseCard& c : cards()) {
    for (const Where where : c.sides) {
      if (c.place == Place::phase) {
        const double quadrature[] = {0.0, 1.5707963267948966};
        add(c, where, quadrature);
        continue;
      }
      std::vector<double> places;
      if (c.place == Place::none) places.push_back(0.0);
      if (c.place == Place::angle) {
        const auto known = angles(where == Where::left ? 0 : 1);
        for (int k = 0; k < kPlaces; ++k) {
          places.push_back(known.front() + (known.back() - known.front()) * (k + 0.5) / kPlaces);
        }
      }
      if (c.place == Place::visit) {
        for (const Visit& v : visits_) places.push_back(v.number);
      }
      for (const double place : places) {
        const double only[] = {place};
        add(c, where, only);
      }
    }
  }
  return all;
}

double likeness(const Signature& signature, const Rival& rival) {
  return (rival.basis.transpose() * signature).norm() / signature.norm();
}

double unexplained(const Signature& signature, const std::vector<Rival>& rivals) {
  double likest = 0.0;
  for (const Rival& rival : rivals) likest = std::max(likest, likeness(signature, rival));
  return signature.norm() * std::sqrt(std::max(0.0, 1.0 - likest * likest));
}

double strength_to_separate(double rho) {
  if (rho >= 1.0) return std::numeric_limits<double>::infinity();
  return 1.645 * std::sqrt(2.0 / (1.0 - rho));
}

}  // namespace chaintrue::generator
