// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What may have changed in a mechanism since it was calibrated: the hypotheses of a check with new
/// readings.
///
/// A change is a shift d of one or a few quantities. To length i, which reads f_i, it adds
///
///   added        d
///   elongation   -d f_i: what grew by d is counted 1 / (1 + d) times as often
///   parameter    d df_i/dtheta_k
///
/// with d ~ N(mean, sigma^2) beforehand.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::model {

struct ChangedQuantity {
  enum class Kind { added, elongation, parameter };
  Kind kind = Kind::added;
  std::vector<std::size_t> lengths = {};  ///< which ones, of `added` and `elongation`
  std::size_t parameter = 0;              ///< which one, of `parameter`
  double mean = 0.0;
  double sigma = 0.0;       ///< 0: it is `mean`
  bool only_grows = false;  ///< half of the Gaussian counts
};

enum class Change {
  nothing,
  zero,
  tooth,
  pitch,
  zeros_and_pitch,
  motors,
  anchor,
  parameter,  ///< any, for a mechanism without more detail
  unknown,    ///< follows none of these
  bad_point,  ///< the machine is as it was: one new reading is wrong
};
/// As in files.
std::string_view name(Change what);

struct MechanismChange {
  Change what = Change::nothing;
  std::string side;         ///< "left", "both", "tl" or a parameter; empty: the whole machine
  bool zero_mends = false;  ///< zeroing again corrects it
  double prior = 0.0;       ///< prior probability
  std::vector<ChangedQuantity> quantities = {};
  int count = 0;  ///< for whole steps, such as skipped teeth
};

/// Prior probabilities; a group's share is divided evenly among its members.
struct ChangePriors {
  double nothing = 0.50;
  /// Chains come off together more often than one alone.
  double both_zeros = 0.10;
  double one_zero = 0.08;
  double tooth = 0.10;
  double pitch = 0.15;
  double zeros_and_pitch = 0.01;
  double motors = 0.02;
  double unknown = 0.02;
  double bad_point = 0.02;
};
inline constexpr ChangePriors kChangePriors{};

}  // namespace chaintrue::model

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::Change;
}  // namespace chaintrue
