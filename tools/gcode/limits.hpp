// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The stage between the segmenter and the emitter: a program's demands on map and controller
/// are checked command by command, and written as long as nothing is wrong.
///
/// Problems are commands outside the controller's clamping box, corrections or slopes of it above
/// the stated limits, points off the map, and words that the controller would take for others.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/gcode/emitter.hpp"
#include "tools/gcode/segmenter.hpp"

namespace chaintrue::gcode {

struct CompensateOptions {
  double tolerance_mm = 0.05;
  int decimals = 3;
  /// Larger corrections indicate a wrong map, machine or home.
  double largest_correction_mm = 30.0;
  /// Change of the correction per millimetre of path.
  double steepest_correction = 0.05;
  /// Rapids are single commands: their ends are compensated, their paths are not.
  bool keep_rapids_whole = false;
  std::optional<ClampBox> clamp_box;
  /// Half the width of a named direction_hysteresis for each chain.
  model::ChainLengths half_play_mm;
  /// For the header.
  std::optional<grid::Provenance> made_by;
  /// "motorspacingx 2978.4": the presumed settings of the controller, for the header.
  std::vector<std::string> settings;
  /// Called for every command in X and Y with its start and end, and for every plunge with its place
  /// as both.
  std::function<void(const Move&, const PathSample&, const PathSample&)> on_command;

  bool has_play() const { return half_play_mm.left_mm != 0.0 || half_play_mm.right_mm != 0.0; }
};

struct CompensateSummary {
  std::uint64_t blocks = 0;
  std::uint64_t moves = 0;
  std::uint64_t commands = 0;
  double path_mm = 0.0;
  double largest_correction_mm = 0.0;
  std::size_t largest_correction_line = 0;
  double steepest_correction = 0.0;
};

class Limits {
 public:
  /// Keeps references.
  Limits(const Corrector& corrector, const CompensateOptions& options, ByteSink out);

  void header(double home_x_mm, double home_y_mm);
  /// The command that ends at this sample. \throws Refusal if it cannot be written
  void command(const Move& move, double feed_mm_per_min, const PathSample& sample);
  /// A move in Z alone.
  void height(const Move& move, double feed_mm_per_min);
  void word(const PassedWord& word);
  void comment(const Comment& comment);
  void end(std::string_view word) { emitter_.end(word); }
  /// There is no command for a place of the move.
  void object(const Move& move, const CorrectionFailure& failure, Point place);
  void add(const Note& note) { findings_.add(note); }
  void add(const Problem& problem) { findings_.add(problem); }

  /// Where the last command ends; empty until the program states X and Y.
  const std::optional<PathSample>& here() const { return here_; }
  const Findings& findings() const { return findings_; }
  /// What is written after a problem is discarded.
  bool hold() const { return findings_.problem_count == 0; }
  /// Corrections and commands alone.
  CompensateSummary summary() const;

 private:
  void examine(const Move& move, const PathSample& sample);
  void note_unknown(const PassedWord& word);

  const Corrector& corrector_;
  const CompensateOptions& options_;
  Emitter emitter_;
  Findings findings_;
  CompensateSummary summary_;
  std::optional<PathSample> here_;
  std::set<Code> unknown_;  // codes that already have a note
};

}  // namespace chaintrue::gcode
