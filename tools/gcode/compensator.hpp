// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reads a program's events, places its moves with the map, takes up play, and writes a file whose
/// commands move the tool along the program's path (segmenter.hpp, limits.hpp).
///
/// Feed rates per minute are kept; inverse time feeds are converted to feeds per minute, so that
/// every piece of a move takes its share of the time.
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

#include "interp/checked_field.hpp"
#include "tools/gcode/limits.hpp"
#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {

/// One run, not thread safe.
class Compensator final : private Sink {
 public:
  /// Keeps a reference. \throws std::invalid_argument if the tolerance does not exceed the
  /// rounding.
  Compensator(const Corrector& corrector, CompensateOptions options, ByteSink out);
  Compensator(const Compensator&) = delete;

  /// An unexpected value is a problem of the program itself; problems with the map and the
  /// controller are in findings().
  [[nodiscard]] Result<CompensateSummary> run(LineSource& source, const Dialect& dialect);
  const Findings& findings() const { return limits_.findings(); }

 private:
  void move(const Move& move) override;
  void word(const PassedWord& word) override;
  void comment(const Comment& comment) override { limits_.comment(comment); }
  void note(const Note& note) override { limits_.add(note); }
  bool goes_on_after(const Problem& problem) override {
    limits_.add(problem);
    return true;
  }
  void end(std::size_t /*line*/, std::string_view word) override { limits_.end(word); }

  /// Corrector::command, from tables in the regions where a program cuts often.
  Corrected<model::BedPoint> command(model::BedPoint target);
  Curve curve(const Move& move, ChainDirections directions);
  void go_to_assumed_start(const Move& move);
  void along(const Move& move, double feed);
  void piece(const Move& move, double feed, double from, double to, ChainDirections directions);
  ChainDirections directions_at(const Move& move, double t, ChainDirections otherwise) const;

  const Corrector& corrector_;
  CompensateOptions options_;
  Limits limits_;
  Segmenter segmenter_;
  interp::CheckedField table_;  // of command(p) - p, without play
  std::uint64_t moves_ = 0;
  double path_mm_ = 0.0;
  bool homed_ = false;  // and not yet at a place
  ChainDirections directions_;
};

}  // namespace chaintrue::gcode
