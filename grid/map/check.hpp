// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The result of a check by new readings, for any mechanism: whether the calibration is still
/// valid, re-zeroing restores it, or it must be measured again.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "model/failure.hpp"
#include "model/mechanism_change.hpp"

namespace chaintrue::grid {

enum class CheckVerdict { valid, valid_after_rezeroing, measure_again };
std::string_view name(CheckVerdict verdict);

/// Prior sigmas of a smooth change that no hypothesis covers, and of a wrong reading.
inline constexpr double kUnknownSigmaMm = 3.0;
inline constexpr double kOutlierSigmaMm = 20.0;
/// A verdict with a lower probability needs more readings.
inline constexpr double kDecided = 0.8;

/// How far a quantity has changed.
struct QuantityFound {
  model::ChangedQuantity of;
  double value = 0.0;
  double sigma = 0.0;  ///< 0 where `of` states the value
};

/// A hypothesis: nothing changed, a change of the mechanism, an unknown change, or a bad point.
struct CheckHypothesis {
  model::Change what = model::Change::nothing;
  std::string side;  ///< the identifier in files; empty: the whole
  CheckVerdict verdict = CheckVerdict::valid;
  double probability = 0.0;
  /// Teeth skipped, positive where too much is read; for a bad point its number, from 0.
  int count = 0;
  std::string name = {};  ///< for a bad point: "point 3"
  std::vector<QuantityFound> found = {};

  /// Excess of a length's reading with its sigma, and its relative growth; 0 if the hypothesis has
  /// none.
  QuantityFound added(std::size_t length) const;
  QuantityFound elongation(std::size_t length) const;
  /// For the only quantity, or the root of the sum of squares.
  double size() const;
};

/// The deviation of one new reading from the calibration.
struct CheckResidual {
  std::string name;  ///< "point 3, left chain", "A-B"
  double residual_mm = 0.0;
  double sigma_mm = 0.0;  ///< of noise and calibration together
};

/// Residuals that are good or bad together.
struct CheckUnit {
  std::string name;           ///< "point 3"
  std::size_t index = 0;      ///< into the file's points or distances
  std::size_t first_row = 0;  ///< into the residuals
  std::size_t rows = 1;
  double rms_mm(const std::vector<CheckResidual>& residuals) const;
  double sigma_mm(const std::vector<CheckResidual>& residuals) const;
};

struct Check {
  CheckVerdict verdict = CheckVerdict::valid;
  std::array<double, 3> probability{};  ///< by verdict
  /// False: the verdict has less than kDecided, more readings are needed.
  bool decided = true;
  std::vector<CheckHypothesis> hypotheses;  ///< most probable first
  /// The calibrated zeros after the most probable re-zeroing, one for each length; relative to 0
  /// for a map without a machine. Empty if zeros are not settings.
  std::vector<double> new_zero_mm;
  std::vector<CheckResidual> residuals;
  std::vector<CheckUnit> units;  ///< in the order of the file
  std::string sentence;
  /// Hypotheses that these readings cannot distinguish; may be empty.
  std::string not_separable;
  /// Sentences: the corrections of the readings, and those that could not be made.
  std::vector<std::string> notes;
  /// The result is for the map with other settings than its own (map_check.hpp).
  bool settings_have_changed = false;
  bool is_valid_as_it_is() const {
    return decided && verdict == CheckVerdict::valid && !settings_have_changed;
  }
};

enum class CheckReason {
  too_many_readings,
  no_machine,   ///< commands without a controller
  no_lengths,   ///< a command that its controller cannot reach, or points without lengths
  unreachable,  ///< a place off the map, or where its machine cannot hold the tool
  no_noise,     ///< the accuracy of new readings is unknown
  nowhere,      ///< the lengths do not meet
};
using CheckFailure = Failure<CheckReason>;

}  // namespace chaintrue::grid
