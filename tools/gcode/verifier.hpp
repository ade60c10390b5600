// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs a file on a simulated controller and machine, and states how far the tool strays from the
/// intended path.
///
/// The file's numbers are taken in the controller's own format, its way between commands is the
/// controller's own (ticks, pieces that are linear in chain length), the machine is the map
/// backwards. The tool's places are matched with the intended path in order, never backwards, so a
/// move that is missing or out of order shows as a deviation. Heights count like X and Y.
///
/// Not part of the deviation: the classic controller's last tick, which overshoots every command
/// along its direction by less than one tick's way and comes back. It is stated by itself; it is
/// the same in every file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/gcode/corrector.hpp"
#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {

struct VerifyOptions {
  double tolerance_mm = 0.05;
  /// Of the original; the other file is run with home at 0, 0.
  model::BedPoint home;
  /// Home of the file that is run; the original's own where it is run itself.
  model::BedPoint run_home;
  model::ChainLengths half_play_mm;
  /// Rapids were left whole: only their ends count.
  bool rapids_whole = false;
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
  /// Empty where the words that pass through (S, T, M ...) come in the same order in both files.
  std::string words_differ;
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

}  // namespace chaintrue::gcode
