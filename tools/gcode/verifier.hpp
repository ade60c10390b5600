// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs a file on a simulated controller and machine, and checks that the tool follows the intended
/// path; otherwise reports where it does not.
///
/// The file passes if, between any two words that are passed through (S, M, T, G4, G43, G64 ...),
/// the tool's track and the intended path have a Frechet distance of at most the tolerance
/// (path_matcher.hpp), heights included; if the words are the same and at the same positions; if
/// rapids are rapids, cuts are cuts, and the tool's speed along a cut is the intended one to within
/// `speed_share`. Moves of a few units of the last decimal may vanish by rounding.
///
/// Not part of the deviation: the classic controller's last tick, which overshoots every command
/// along its direction by less than one tick's distance and returns. It is reported separately; it
/// is the same in every file.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tools/gcode/corrector.hpp"
#include "tools/gcode/path_matcher.hpp"
#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {

struct VerifyOptions {
  double tolerance_mm = 0.05;
  /// For the file that is run: moves shorter than a few units of its last decimal may be missing.
  int decimals = 3;
  model::ChainLengths half_play_mm;
  /// Rapids are single commands: only their ends count.
  bool rapids_whole = false;
  /// Allowed relative deviation of the tool's speed: that of the steepest correction allowed by
  /// default (0.05 mm per mm), and the rounding of F.
  double speed_share = 0.06;
  /// For uncompensated(): called for every move of the original.
  std::function<void(const Move&)> on_move;
};

struct VerifySummary {
  Deviation feeds;
  Deviation rapids;
  double tick_overshoot_mm = 0.0;
  std::uint64_t commands = 0;
  std::uint64_t places = 0;  ///< of the tool's track that were compared
  bool strays = false;
  /// Empty if the words that are passed through are the same, at the same positions.
  std::string words_differ;
  /// Empty if rapids are rapids and cuts have the intended speed.
  std::string motion_differs;
  /// The first fault as a sentence, with its place and what to check. Empty if the file passes.
  std::string fault;

  bool holds() const { return !strays && words_differ.empty() && motion_differs.empty(); }
  const Deviation& worst() const {
    return feeds.distance_mm >= rapids.distance_mm ? feeds : rapids;
  }
  double largest_mm() const { return worst().distance_mm; }
};

/// Why there is no result: one of the files is rejected, or the simulated machine cannot reach a
/// commanded position.
struct VerifyProblem {
  bool in_original = false;
  Problem problem;
};

/// \param dialect the original's; the other file is run with home at 0, 0.
[[nodiscard]] tl::expected<VerifySummary, VerifyProblem> verify(LineSource& original,
                                                                LineSource& run,
                                                                const Corrector& corrector,
                                                                const Dialect& dialect,
                                                                const VerifyOptions& options);

/// The deviation of the tool from the intended path for an uncompensated program.
[[nodiscard]] Result<Deviation> uncompensated(LineSource& original, const Corrector& corrector,
                                              const Dialect& dialect, const VerifyOptions& options);

}  // namespace chaintrue::gcode
