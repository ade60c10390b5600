// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs a file on a simulated controller and machine, and proves that the tool follows the intended
/// path, or says where it does not.
///
/// The file holds when, between any two words that pass through (S, M, T, G4, G43, G64 ...), the
/// tool's track and the intended path have a Frechet distance of at most the tolerance
/// (path_matcher.hpp), heights included; when the words are the same and stand at the same places;
/// when rapids are rapids, cuts are cuts, and the tool's speed along a cut is the intended one to
/// within `speed_share`. Rounding may swallow moves shorter than least_run_mm().
///
/// Not part of the deviation: the classic controller's last tick, which overshoots every command
/// along its direction by less than one tick's way and comes back. It is stated by itself; it is
/// the same in every file.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tools/gcode/corrector.hpp"
#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {

struct VerifyOptions {
  double tolerance_mm = 0.05;
  /// Of the file that is run: shorter moves than a few of its last decimals may be missing.
  int decimals = 3;
  /// Of the original; the other file is run with home at 0, 0.
  model::BedPoint home;
  /// Home of the file that is run; the original's own where it is run itself.
  model::BedPoint run_home;
  model::ChainLengths half_play_mm;
  /// Rapids were left whole: only their ends count.
  bool rapids_whole = false;
  /// The tool's speed against the intended one: what the steepest correction that is allowed by
  /// default (0.05 mm per mm) makes of it, and the rounding of F.
  double speed_share = 0.06;
  /// Of uncompensated(): called for every move of the original, on the sheet.
  std::function<void(const Move&)> on_move;
};

struct Deviation {
  double largest_mm = 0.0;
  Point intended;  ///< there
  Point tool;
  std::size_t original_line = 0;
  std::size_t run_line = 0;
};

struct VerifySummary {
  Deviation feeds;
  Deviation rapids;
  double tick_overshoot_mm = 0.0;
  std::uint64_t commands = 0;
  std::uint64_t places = 0;  ///< of the tool that were compared
  bool strays = false;
  /// Empty where the words that pass through are the same, at the same places.
  std::string words_differ;
  /// Empty where rapids are rapids and cuts have the intended speed.
  std::string motion_differs;
  /// The first fault, in a sentence: where, and what to look at. Empty where the file holds.
  std::string fault;

  [[nodiscard]] bool holds() const {
    return !strays && words_differ.empty() && motion_differs.empty();
  }
  [[nodiscard]] double largest_mm() const {
    return feeds.largest_mm > rapids.largest_mm ? feeds.largest_mm : rapids.largest_mm;
  }
};

/// Why there is no answer: one of the files is refused, or the simulated machine cannot go where it
/// is told.
struct VerifyProblem {
  bool in_original = false;
  Problem problem;
};

[[nodiscard]] tl::expected<VerifySummary, VerifyProblem> verify(LineSource& original,
                                                                LineSource& run,
                                                                const Corrector& corrector,
                                                                const Dialect& dialect,
                                                                const VerifyOptions& options);

/// How far the tool is from the intended path where a program runs as it is.
[[nodiscard]] Result<Deviation> uncompensated(LineSource& original,
                                              const Corrector& corrector,
                                              const Dialect& dialect,
                                              const VerifyOptions& options);

/// Of moves that rounding may swallow.
[[nodiscard]] double least_run_mm(const VerifyOptions& options);

}  // namespace chaintrue::gcode
