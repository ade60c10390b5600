// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The strength of a hidden cause in the data of a session: the norm of its signature in units of
/// noise, after projection on the settings.
///
/// Notation
///   g      reading less that of the machine without the effect at the mark as written, per
///          visit and chain, whitened by C = s_L^2 + s_xy^2 J J', J = d(L, R)/d(x, y)
///   A      derivatives by the six settings, whitened by C, and their stated sigmas as further rows
///   M      projection orthogonal to A
///   delta  |M g|
///   rho    |cosine| of M g of two effects
///
/// Derivatives are differences on the drum: the teeth's ripple of 0.02 mm is in the readings and
/// would disturb a slope.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "generator/hidden/disturbance.hpp"

namespace chaintrue::generator {

struct NoiseLevel {
  double length_mm = 0.2;
  double position_mm = 0.3;
};
struct StatedSigmas {
  double motor_mm = 3.0;
  double zero_mm = 1.0;
};

/// A signature after projection; empty if the machine cannot have the effect.
using Signature = Eigen::VectorXd;

/// An effect of the catalogue at one side and place, as the space spanned by its size (and phase).
struct Rival {
  Cause cause{};
  Where where{};
  Eigen::MatrixXd basis;  ///< orthonormal columns
};

/// What a change leaves after projection orthogonal to columns.
class Projection {
 public:
  Projection() = default;
  explicit Projection(const Eigen::MatrixXd& columns);
  /// Rows that are missing at the end are zero.
  Signature left_of(const Eigen::VectorXd& rows) const;

 private:
  Eigen::MatrixXd taken_;  ///< orthonormal
};

class Yardstick {
 public:
  /// Empty if the machine cannot reach a visit.
  static std::optional<Yardstick> make(const TrueMachine& machine, std::span<const Visit> visits,
                                       NoiseLevel noise, StatedSigmas stated);

  std::optional<Signature> signature(std::span<const Hidden> effects) const;
  Signature signature_of(const Disturbance& disturbance) const;
  /// For readings that are `extra` too large.
  Signature signature_of_lengths(std::span<const Lengths> extra) const;
  /// The whole catalogue at its usual sizes and at places all over the session.
  std::vector<Rival> rivals() const;

  const std::vector<Visit>& visits() const { return visits_; }
  const std::vector<Rest>& at_rest() const { return rests_; }
  /// d(left, right)/d(x, y), row by row.
  const std::vector<std::array<double, 4>>& slopes() const { return slopes_; }
  /// Angles of a chain over the session, ascending.
  std::vector<double> angles(std::size_t chain) const;

  /// A, with the rows of the stated sigmas last.
  const Eigen::MatrixXd& settings() const { return by_setting_; }
  /// Lower triangle of each visit's whitening: 00, 10, 11.
  const std::vector<std::array<double, 3>>& whitening() const { return whitening_; }
  /// Pairs of lengths as rows in units of noise, nothing projected out.
  Eigen::VectorXd whitened(std::span<const Lengths> pairs) const;

 private:
  TrueMachine machine_;
  std::vector<Visit> visits_;
  std::vector<Rest> rests_;
  std::vector<Lengths> plain_;
  std::vector<std::array<double, 4>> slopes_;
  std::vector<std::array<double, 3>> whitening_;
  Eigen::MatrixXd by_setting_;
  Projection settings_;
};

/// Largest |cosine| between a signature and those of a rival.
double likeness(const Signature& signature, const Rival& rival);
/// The length of a signature's part that the likest of its rivals does not explain.
double unexplained(const Signature& signature, const std::vector<Rival>& rivals);
/// 1.645 sqrt(2 / (1 - rho)): the strength at which 95 of 100 are distinguished from the rival.
double strength_to_separate(double rho);

}  // namespace chaintrue::generator
