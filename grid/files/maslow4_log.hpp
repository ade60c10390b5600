// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The output of a Maslow 4 while it finds its anchors, from a pasted serial log or an older list of
/// readings: lines in any order, with any other text between them.
///
///     [MSG:INFO: Waypoints [0-29]: (0:-9.0,10.4) (1:141.0,10.4) ...]      where it is to go
///     [MSG:INFO: Top Left 2664.769]                                       single readings that did
///                                                                         not agree
///     [MSG:INFO: Measured waypoint 7]
///     [MSG:INFO: Waypoint 7 coordinates: X=141.00 Y=10.40]                where it was sent
///     CLBM:[{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85},{...}]       the readings, averaged
///     [MSG:INFO: Find Anchors fit: rms=1.2mm max=3.4mm perAnchor=[..]mm converged=1]
///
/// Older prints have no `CLBM:[`, one `{...}` a line, trailing commas, comments and blank lines.
///
/// The list grows while the machine measures and is printed again: a list that begins with the
/// previous one continues it. Any other list, a heading ("Run 2:") and a list of waypoints from 0 on
/// begin another run.
///
/// A reading that is damaged is left out, with its line; one print of a list gives what another lost.
/// Colours, other output and lines that a terminal broke in two are handled. Where a run stopped
/// before its list was printed, places come of single readings that agree to a centimetre.
///
/// Sources: MaslowCNC/Maslow_4, firmware/FluidNC/src/Maslow/Calibration.cpp (the format, which belts
/// are pulled, that the lengths are horizontal spans) and Maslow.cpp before pull 157 of October 2024
/// (that they were slanting); firmware/FluidNC/data/maslow.yaml (the settings).
///
/// \code
///   Maslow4Options options;
///   options.settings = read_whole_file("maslow.yaml");
///   const Maslow4Import import = parse_maslow4(text, "log.txt", options);
///   write_whole_file("belts.json", write_belts(import.belts));
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/files/input_error.hpp"

namespace chaintrue::grid::files {

/// First and last of the file's points, counted from 0 over all runs.
struct PointRange {
  std::size_t first = 0;
  std::size_t last = 0;
};
/// A run, counted from 1, or points; neither: the last run.
struct LogPart {
  std::optional<int> run = std::nullopt;
  std::optional<PointRange> points = std::nullopt;
};
/// "2", "1,2" or "0:98". \throws InputError otherwise.
std::vector<LogPart> log_parts_of(const std::string& text, const std::string& option);

struct Maslow4Options {
  std::optional<std::string> settings;  ///< text of maslow.yaml
  std::string settings_file = "maslow.yaml";
  LogPart part;
  std::optional<model::BeltLengths> lengths;
  std::optional<Orientation> orientation;
};

/// A run of the machine's own calibration.
struct LoggedRun {
  std::string heading;   ///< from the file; may be empty
  std::size_t line = 0;  ///< of its first reading
  PointRange points;
};

struct Maslow4Import {
  MeasuredBelts belts;
  std::vector<LoggedRun> runs;       ///< all runs in the file
  std::size_t taken = 0;             ///< into the runs; for a range of points the run of its first
  std::vector<std::string> assumed;  ///< sentences: values in neither log nor settings
  std::vector<Warning> warnings;
  /// From the settings, which apply to one of several runs at most; if the log prints it, points
  /// have it.
  std::optional<BeltPull> settings_pull;
  bool is_enough = false;              ///< for a fit of the anchors
  std::optional<std::string> stopped;  ///< why the last run did not finish, and what to do
};

/// `file` is the name used in messages. \throws InputError with every problem: where fewer than five
/// readings can be read though others are there, or where they contradict each other as a whole.
Maslow4Import parse_maslow4(const std::string& text, const std::string& file,
                            const Maslow4Options& options = {});

// Several runs of a Maslow 4's calibration as one session: the same machine, each run with its own
// pull. Visits are numbered on from run to run.
//
// How hard belts were pulled comes from `--pulls`, or, where a log prints it,
// from Maslow_Calibration_Current_Threshold, mA (MaslowCNC/Maslow_4, firmware/FluidNC/src/Maslow).
//
// \code
//   std::vector<Maslow4Import> runs = {parse_maslow4(one, "1.log"), parse_maslow4(two, "2.log")};
//   const Maslow4Import session = one_session(std::move(runs), pulls_of("1,1.6", "--pulls"));
// \endcode

/// "1,1.6" relative, "1300mA,1900mA" or "150N,240N"; one unit. \throws InputError otherwise.
std::vector<BeltPull> pulls_of(const std::string& text, const std::string& option);

/// `pulls`: one for each run; empty: as in the logs. A single run is returned itself, with its
/// pull.
/// \throws InputError if runs have different frames, or if the pull of each is unknown.
/// \throws std::logic_error without runs.
Maslow4Import one_session(std::vector<Maslow4Import> runs, const std::vector<BeltPull>& pulls);

}  // namespace chaintrue::grid::files
