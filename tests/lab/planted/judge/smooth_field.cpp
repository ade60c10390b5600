// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: smooth_field.hpp.
#include "planted/judge/smooth_field.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace chaintrue::planted {
namespace {

using generator::Lengths;
using generator::Vec2;
using generator::Visit;
using generator::Yardstick;

constexpr Eigen::Index kSettings = 6;
constexpr Eigen::Index kSheet = 3;

Vec2 placed(Vec2 mark, Vec2 shift, double turn_rad) {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {c * mark.x - s * mark.y + shift.x, s * mark.x + c * mark.y + shift.y};
}

/// Settings, and shift and turn of the sheet, which are known by the readings alone.
Eigen::MatrixXd free_columns(const Yardstick& yardstick) {
  const Eigen::MatrixXd& settings = yardstick.settings();
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(settings.rows(), kSettings + kSheet);
  x.leftCols(kSettings) = settings;
  for (Eigen::Index k = 0; k < kSheet; ++k) {
    std::vector<Lengths> change;
    for (std::size_t i = 0; i < yardstick.visits().size(); ++i) {
      const Vec2 at = yardstick.visits()[i].place;
      const auto& j = yardstick.slopes()[i];
      const double dx = k == 0 ? 1.0 : k == 1 ? 0.0 : -at.y;
      const double dy = k == 0 ? 0.0 : k == 1 ? 1.0 : at.x;
      change.push_back({j[0] * dx + j[1] * dy, j[2] * dx + j[3] * dy});
    }
    const Eigen::VectorXd rows = yardstick.whitened(change);
    x.col(kSettings + k).head(rows.size()) = rows;
  }
  return x;
}

Yardstick yardstick_at(const generator::TrueMachine& machine, const std::vector<Visit>& visits,
                       generator::NoiseLevel noise) {
  auto made = Yardstick::make(machine, visits, noise, {});
  if (!made) throw std::runtime_error("calibrate: the machine cannot reach a mark");
  return std::move(*made);
}

/// F, for rows of the visits.
Eigen::MatrixXd covariance_of(const SmoothField& field, const Yardstick& yardstick) {
  const auto& visits = yardstick.visits();
  const auto n = static_cast<Eigen::Index>(visits.size());
  const double both = field.correlation * field.left_mm * field.right_mm;
  Eigen::Matrix2d chains;
  chains << field.left_mm * field.left_mm, both, both, field.right_mm * field.right_mm;
  std::vector<Eigen::Matrix2d> whitening;
  for (const auto& w : yardstick.whitening()) {
    whitening.emplace_back();
    whitening.back() << w[0], 0.0, w[1], w[2];
  }
  Eigen::MatrixXd f(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Vec2 p = visits[static_cast<std::size_t>(i)].place;
      const Vec2 q = visits[static_cast<std::size_t>(j)].place;
      const double far = ((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y)) /
                         (2.0 * field.length_mm * field.length_mm);
      const Eigen::Matrix2d block = std::exp(-far) * whitening[static_cast<std::size_t>(i)] *
                                    chains * whitening[static_cast<std::size_t>(j)].transpose();
      f.block<2, 2>(2 * i, 2 * j) = block;
      f.block<2, 2>(2 * j, 2 * i) = block.transpose();
    }
  }
  return f;
}

struct Metric {
  Eigen::LLT<Eigen::MatrixXd> v;
  Eigen::MatrixXd x;  ///< V^-1/2 X
  Eigen::LLT<Eigen::MatrixXd> information;

  Metric(const SmoothField& field, const CalibratedSession& session) {
    const Eigen::Index rows = session.free.rows();
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(rows, rows);
    const Eigen::Index read = rows - kSettings;
    covariance.topLeftCorner(read, read) *= field.noise_factor * field.noise_factor;
    covariance.topLeftCorner(read, read) += covariance_of(field, session.yardstick);
    v.compute(covariance);
    x = v.matrixL().solve(session.free);
    information.compute(x.transpose() * x);
  }
  double square(const Eigen::VectorXd& rows) const {
    const Eigen::VectorXd white = v.matrixL().solve(rows);
    const Eigen::VectorXd by_free = x.transpose() * white;
    return std::max(0.0, white.squaredNorm() - by_free.dot(information.solve(by_free)));
  }
  /// log |V| + log |X' V^-1 X|
  double log_determinants() const {
    return 2.0 * (v.matrixLLT().diagonal().array().log().sum() +
                  information.matrixLLT().diagonal().array().log().sum());
  }
};

/// -2 log of the restricted likelihood.
double misfit(const SmoothField& field, const CalibratedSession& session) {
  const Metric metric(field, session);
  return metric.log_determinants() + metric.square(session.residual);
}

/// Logarithms of the three sizes and the inverse hyperbolic tangent of the correlation.
using Logs = std::array<double, 4>;

SmoothField field_of(double length_mm, const Logs& at) {
  return {length_mm, std::exp(at[0]), std::exp(at[1]), std::tanh(at[2]), std::exp(at[3])};
}

}  // namespace

Vec2 CalibratedSession::on_bed(Vec2 mark) const {
  return placed(mark, sheet_shift, sheet_turn_rad);
}

CalibratedSession calibrate(const generator::TrueMachine& stated,
                            const std::vector<ReadMark>& marks, generator::NoiseLevel noise) {
  // Shifts of centimetres: each step leaves a hundredth of the step before it.
  constexpr int kSteps = 5;
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(kSettings + kSheet);
  const generator::StatedSigmas sigmas;
  for (int step = 0;; ++step) {
    generator::TrueMachine machine = stated;
    machine.wheel = generator::WheelShape::round;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto row = static_cast<Eigen::Index>(2 * k);
      machine.axis[k].x += moved(row);
      machine.axis[k].y += moved(row + 1);
      machine.chain_zero_mm[k] += moved(4 + static_cast<Eigen::Index>(k));
    }
    const Vec2 shift{moved(kSettings), moved(kSettings + 1)};
    const double turn_rad = moved(kSettings + 2);
    std::vector<Visit> visits;
    for (const ReadMark& m : marks) {
      visits.push_back({placed(m.mark, shift, turn_rad), static_cast<int>(visits.size())});
    }
    Yardstick yardstick = yardstick_at(machine, visits, noise);
    std::vector<Lengths> off = generator::readings(machine, {}, visits, yardstick.at_rest());
    for (std::size_t i = 0; i < off.size(); ++i) {
      for (std::size_t c = 0; c < 2; ++c) off[i][c] = marks[i].lengths[c] - off[i][c];
    }
    Eigen::MatrixXd x = free_columns(yardstick);
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(x.rows());
    residual.head(x.rows() - kSettings) = yardstick.whitened(off);
    for (Eigen::Index k = 0; k < kSettings; ++k) {
      residual(x.rows() - kSettings + k) = -moved(k) / (k < 4 ? sigmas.motor_mm : sigmas.zero_mm);
    }
    if (step == kSteps) {
      return {machine, shift, turn_rad, std::move(yardstick), std::move(x), std::move(residual)};
    }
    moved += x.colPivHouseholderQr().solve(residual);
  }
}

SmoothField likeliest_field(const CalibratedSession& session) {
  SmoothField best;
  double least = std::numeric_limits<double>::infinity();
  for (const double length_mm : {100.0, 150.0, 250.0, 400.0, 600.0, 900.0}) {
    Logs at{std::log(0.5), std::log(0.5), 0.0, 0.0};
    double here = misfit(field_of(length_mm, at), session);
    // Compass search: a tenth of a size changes no strength that matters.
    for (double step = 0.8; step > 0.08;) {
      bool better = false;
      for (std::size_t k = 0; k < at.size(); ++k) {
        for (const double sign : {1.0, -1.0}) {
          Logs next = at;
          next[k] += sign * step;
          const double there = misfit(field_of(length_mm, next), session);
          if (!(there < here)) continue;
          at = next;
          here = there;
          better = true;
        }
      }
      if (!better) step /= 2.0;
    }
    if (here < least) {
      least = here;
      best = field_of(length_mm, at);
    }
  }
  return best;
}

double strength_given(const SmoothField& field, const CalibratedSession& session,
                      const generator::Signature& signature) {
  return std::sqrt(Metric(field, session).square(signature));
}

}  // namespace chaintrue::planted
