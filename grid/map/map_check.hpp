// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A few new points against a map: has anything changed since it was measured, what, and does
/// re-zeroing mend it.
///
/// Each hypothesis predicts the residuals r (measured less map) as a Gaussian,
///
///   r ~ N(X m, K + X P X')                                                                  (1)
///   K  noise of the new readings, what the map does not know of itself, and where a sheet lies that
///      was laid anew, as well as its file says
///
/// where X is what the changed quantities do to r, m and P their size beforehand; the probabilities
/// follow by Bayes' theorem from the priors stated in kCheckPriors. A pitch only grows: half of its
/// Gaussian counts (2 Phi(mean / sigma) of its posterior). Source: D. MacKay, Information Theory,
/// Inference, and Learning Algorithms (2003), chapter 28, for evidences.
///
/// \code
///   const auto check = check_map(map, grid);          // or holes
///   if (check && check->verdict == CheckVerdict::valid) carry_on();
/// \endcode
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"
#include "grid/progress.hpp"

namespace chaintrue::grid {

enum class CheckVerdict { valid, valid_after_rezeroing, measure_again };
[[nodiscard]] std::string_view name(CheckVerdict verdict);

/// What may have changed, in files and on the command line: nothing, zero, tooth, pitch,
/// zeros_and_pitch, motors, unknown, bad_point.
struct CheckHypothesis {
  std::string what;
  std::string side;  ///< left, right, both or empty
  CheckVerdict verdict = CheckVerdict::valid;
  double probability = 0.0;
  /// Teeth skipped, positive where too much is read; of a bad point its number, from 0.
  int count = 0;
  /// What would put each chain's reading right: the change of its zero, one sigma.
  model::PerSide<double> zero_mm;
  model::PerSide<double> zero_sigma_mm;
  /// Elongation since the map was made.
  model::PerSide<double> elongation;
  model::PerSide<double> elongation_sigma;
};

/// One sigma of a shift of a zero: up to 3 mm is what re-hanging a chain does.
inline constexpr double kZeroShiftSigmaMm = 2.0;
/// Of a pitch that grew: 0.05 % is a year's wear.
inline constexpr double kPitchGrowthSigma = 5e-4;
inline constexpr double kMotorShiftSigmaMm = 5.0;
/// Of a smooth change that none of these is, and of a reading that is simply wrong.
inline constexpr double kUnknownSigmaMm = 3.0;
inline constexpr double kOutlierSigmaMm = 20.0;

/// Probabilities beforehand; a group's share is divided evenly among its members.
struct CheckPriors {
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
inline constexpr CheckPriors kCheckPriors{};

/// Where one new point lies beside what the map says, in its own numbers.
struct CheckResidual {
  std::string what;  ///< "point 3, left chain", "A-B"
  double residual_mm = 0.0;
  double sigma_mm = 0.0;  ///< of noise and map together
};

struct MapCheck {
  CheckVerdict verdict = CheckVerdict::valid;
  std::array<double, 3> probability{};  ///< by verdict
  /// The verdict has less than kDecided: more points are needed.
  bool decided = true;
  std::vector<CheckHypothesis> hypotheses;  ///< most probable first
  /// The map's chain zeros with the most probable re-zeroing put in; a map without a machine counts
  /// from nothing.
  model::ChainLengths new_zero;
  std::vector<CheckResidual> residuals;
  std::string sentence;
  /// What these points cannot tell apart; empty where all is clear.
  std::string not_told_apart;
  /// What was taken out of the readings, and what could not be; whole sentences.
  std::vector<std::string> notes;
  /// All of it is of the map for other settings than its own (check_settings.hpp).
  bool settings_have_changed = false;
  [[nodiscard]] bool is_valid_as_it_is() const {
    return decided && verdict == CheckVerdict::valid && !settings_have_changed;
  }
};
inline constexpr double kDecided = 0.8;

struct CheckFailure {
  enum class Reason {
    too_many_readings,
    no_machine,   ///< commands without a controller
    no_lengths,   ///< a command that its controller cannot reach, or points without lengths
    unreachable,  ///< a place off the map, or where its machine cannot hold the sled
  } reason;
  std::string sentence;
};

/// Any mix of files. What the files' machine has of effects of the paper and of the visit is taken out
/// of the readings first (corrected_data.hpp), as it is for a map.
[[nodiscard]] tl::expected<MapCheck, CheckFailure> check_map(const CompensationMap& map,
                                                             const Measured& measured,
                                                             const Progress& progress = {});

}  // namespace chaintrue::grid
