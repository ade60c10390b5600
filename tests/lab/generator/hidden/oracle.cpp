// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/oracle.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace chaintrue::generator {
namespace {

constexpr std::size_t kOracleSettings = 6;

/// The unknowns as one vector: motors, zeros, then sizes and places of the given effects.
class OracleUnknowns {
 public:
  OracleUnknowns(const HiddenMachine& machine, std::span<const Hidden> given)
      : base_(machine.truth()), given_(given.begin(), given.end()) {
    base_.wheel = WheelShape::round;
  }
  Eigen::VectorXd start() const {
    std::vector<double> x;
    for (const Vec2& axis : base_.axis) x.insert(x.end(), {axis.x, axis.y});
    x.insert(x.end(), base_.chain_zero_mm.begin(), base_.chain_zero_mm.end());
    for (const Hidden& h : given_) {
      if (size_is_free(h)) x.push_back(h.size / card(h.cause).usual);
      if (place_is_free(h)) x.push_back(h.place);
    }
    return Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  }
  Fitted at(const Eigen::VectorXd& x) const {
    Fitted f{base_, given_};
    for (std::size_t c = 0; c < 2; ++c) {
      const auto i = static_cast<Eigen::Index>(c);
      f.machine.axis[c] = {x[2 * i], x[2 * i + 1]};
      f.machine.chain_zero_mm[c] = x[4 + i];
    }
    Eigen::Index k = kOracleSettings;
    for (Hidden& h : f.effects) {
      const CauseCard& c = card(h.cause);
      if (size_is_free(h)) h.size = std::clamp(x[k++] * c.usual, c.lower, c.upper);
      if (place_is_free(h)) h.place = x[k++];
    }
    return f;
  }

 private:
  static bool size_is_free(const Hidden& h) { return !card(h.cause).whole(); }
  static bool place_is_free(const Hidden& h) {
    const Place place = card(h.cause).place;
    return place == Place::phase || place == Place::angle;
  }
  TrueMachine base_;
  std::vector<Hidden> given_;
};

std::optional<Eigen::VectorXd> residual(const Fitted& fitted, const TrueMachine& stated,
                                        const Record& record,
                                        const std::vector<std::array<double, 4>>& slopes) {
  std::vector<Vec2> marks;
  std::vector<int> numbers;
  for (const auto& note : record.notes) {
    marks.push_back(note.mark);
    numbers.push_back(note.number);
  }
  const auto predicted = fitted.predict(marks, numbers);
  if (!predicted) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(marks.size());
  Eigen::VectorXd r = Eigen::VectorXd::Zero(2 * n + static_cast<Eigen::Index>(kOracleSettings));
  const double l2 = record.noise.length_mm * record.noise.length_mm;
  const double p2 = record.noise.position_mm * record.noise.position_mm;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (std::find(record.left_out.begin(), record.left_out.end(), i) != record.left_out.end()) {
      continue;
    }
    const auto& [a, b, c, d] = slopes[i];
    const double f00 = std::sqrt(l2 + p2 * (a * a + b * b));
    const double f10 = p2 * (a * c + b * d) / f00;
    const double f11 = std::sqrt(l2 + p2 * (c * c + d * d) - f10 * f10);
    const double left = record.notes[i].lengths[0] - (*predicted)[i][0];
    const double right = record.notes[i].lengths[1] - (*predicted)[i][1];
    const auto row = static_cast<Eigen::Index>(2 * i);
    r[row] = left / f00;
    r[row + 1] = (right - f10 * r[row]) / f11;
  }
  for (std::size_t c = 0; c < 2; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    const auto& m = fitted.machine;
    r[2 * n + 2 * i] = (stated.axis[c].x - m.axis[c].x) / record.sigmas.motor_mm;
    r[2 * n + 2 * i + 1] = (stated.axis[c].y - m.axis[c].y) / record.sigmas.motor_mm;
    r[2 * n + 4 + i] = (stated.chain_zero_mm[c] - m.chain_zero_mm[c]) / record.sigmas.zero_mm;
  }
  return r;
}

}  // namespace

std::optional<std::vector<Lengths>> Fitted::predict(std::span<const Vec2> marks,
                                                    std::span<const int> numbers) const {
  std::vector<Visit> visits;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    visits.push_back({place_of(marks[i], effects), numbers[i]});
  }
  const TrueMachine with = altered(machine, effects);
  const auto at_rest = rests(with, visits);
  if (!at_rest) return std::nullopt;
  return readings(with, effects, visits, *at_rest);
}

std::optional<Fitted> fit_given(const HiddenMachine& machine, std::span<const Hidden> given,
                                const Record& record) {
  const auto yardstick =
      Yardstick::make(machine.truth(), machine.visits(), record.noise, record.sigmas);
  if (!yardstick) return std::nullopt;
  const OracleUnknowns unknowns(machine, given);
  Eigen::VectorXd x = unknowns.start();
  const auto of = [&](const Eigen::VectorXd& at) {
    return residual(unknowns.at(at), machine.stated(), record, yardstick->slopes());
  };
  auto r = of(x);
  if (!r) return std::nullopt;
  for (int n = 0; n < 12; ++n) {
    Eigen::MatrixXd slope(r->size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      constexpr double kSmall = 1e-3;
      Eigen::VectorXd shifted = x;
      shifted[k] += kSmall;
      const auto there = of(shifted);
      if (!there) return std::nullopt;
      slope.col(k) = (*there - *r) / kSmall;
    }
    const Eigen::VectorXd step = slope.colPivHouseholderQr().solve(*r);
    double share = 1.0;
    for (; share > 1e-3; share *= 0.5) {
      const auto next = of(x - share * step);
      if (!next || next->squaredNorm() > r->squaredNorm()) continue;
      x -= share * step;
      r = next;
      break;
    }
    if (share <= 1e-3 || step.cwiseAbs().maxCoeff() < 1e-5) break;
  }
  return unknowns.at(x);
}

}  // namespace chaintrue::generator
