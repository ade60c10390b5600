// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The last stage of the pipeline: reads a program's events and writes a file whose commands move
/// the tool along the program's path.
///
/// Error budget of a path: chord (measured against the exact map, for arcs and lines) + rounding of
/// the words (half a unit of the last decimal in each axis) <= tolerance. Feed rates per minute are
/// kept; inverse time feeds are converted to feeds per minute, so that every piece of a move takes
/// its share of the time.
///
/// Nothing is written that would be cut wrong: targets outside the map or outside the controller's
/// clamping box, and corrections or slopes of it above the stated limits, are problems, each with
/// its line.
///
/// \code
///   Corrector corrector(map, *kinematics, firmware(kind));
///   Compensator compensator(corrector, options, [&](std::string_view bytes) { file << bytes; });
///   const auto outcome = compensator.run(source, dialect);
///   if (!compensator.findings().problems.empty()) discard(file);
/// \endcode
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "interp/checked_field.hpp"
#include "tools/gcode/corrector.hpp"
#include "tools/gcode/emitter.hpp"
#include "tools/gcode/program.hpp"
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
  /// "motorspacingx 2978.4": what the controller is presumed to hold, for the header.
  std::vector<std::string> settings;
  /// Called for every command in X and Y with its start and end, and for every plunge with its place
  /// as both.
  std::function<void(const Move&, const PathSample&, const PathSample&)> on_command;
};

/// Results of the run. Problems and notes keep the first hundred of each kind, and count all; of
/// problems that one line has in a row the first.
struct Findings {
  static constexpr std::size_t kMostKept = 100;
  std::vector<Problem> problems;
  std::uint64_t problem_count = 0;
  std::vector<Note> notes;
  std::uint64_t note_count = 0;

  void add(Problem problem);
  /// A note that is a problem to whoever needs places on the sheet is added as one.
  void add(Note note);

 private:
  std::size_t last_line_ = 0;
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

/// Rounding error at this number of decimals; the tolerance must be larger.
[[nodiscard]] double least_tolerance_mm(int decimals);

/// One run, not thread safe.
class Compensator final : private Sink {
 public:
  /// Keeps a reference. \throws std::invalid_argument if the tolerance does not exceed the
  /// rounding.
  Compensator(const Corrector& corrector, CompensateOptions options, ByteSink out);

  /// An unexpected value is a problem of the program itself; problems with the map and the
  /// controller are in findings().
  [[nodiscard]] Result<CompensateSummary> run(LineSource& source, const Dialect& dialect);
  [[nodiscard]] const Findings& findings() const { return findings_; }

 private:
  void move(const Move& move) override;
  void word(const PassedWord& word) override;
  void comment(const Comment& comment) override;
  void note_unknown(const PassedWord& word);
  void note(const Note& note) override { findings_.add(note); }
  [[nodiscard]] bool goes_on_after(const Problem& problem) override {
    findings_.add(problem);
    return true;
  }
  void end(std::size_t line, std::string_view word) override;

  /// Corrector::command, from tables in the regions where a program cuts often.
  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> command(model::BedPoint target);
  [[nodiscard]] Curve curve(const Move& move, ChainDirections directions);
  void go_to_assumed_start(const Move& move);
  void along(const Move& move, double feed);
  void piece(const Move& move, double feed, double from, double to, ChainDirections directions);
  void emit(const Move& move, double feed, const PathSample& sample);
  void examine(const Move& move, const PathSample& sample);
  void object(const Move& move, const CorrectionFailure& failure, Point place);
  [[nodiscard]] ChainDirections directions_at(const Move& move,
                                              double t,
                                              ChainDirections otherwise) const;
  [[nodiscard]] bool has_play() const {
    return options_.half_play_mm.left_mm != 0.0 || options_.half_play_mm.right_mm != 0.0;
  }

  const Corrector& corrector_;
  CompensateOptions options_;
  Emitter emitter_;
  Segmenter segmenter_;
  interp::CheckedField table_;  // of command(p) - p, without play
  double unchecked_length_mm_ = 0.0;
  Findings findings_;
  CompensateSummary summary_;
  std::optional<PathSample> here_;  // empty until the program states X and Y
  bool homed_ = false;              // and not yet at a place
  ChainDirections directions_;
  std::set<std::string, std::less<>> unknown_words_;  // words that already have a note
};

}  // namespace chaintrue::gcode
