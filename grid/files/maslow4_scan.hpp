// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The runs of a Maslow 4's log, before they are interpreted. Private to grid/files.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/files/input_error.hpp"
#include "model/belts/belt.hpp"

namespace chaintrue::grid::files {

// A run of Find Anchors that did not finish: at which waypoint, what the machine read there, the
// possible causes, and what to do. Private to grid/files.
//
// Source: MaslowCNC/Maslow_4, firmware/FluidNC/src/Maslow/Calibration.cpp, for what is printed: a
// belt's four readings at a waypoint, repeated up to nine times until they agree to 2.5 mm; the
// guards of the fit; threads 427, 547, 924, 961, 968 and 1010 for runs that stopped.

enum class StopKind {
  readings_disagree,  ///< of one place, tried again
  gave_up_reading,    ///< they never agreed
  imbalance,          ///< the machine's guard: one belt's misfit is twice another's
  not_converged,      ///< the machine's solver
  low_fitness,        ///< the readings contradict each other, in the machine's view
  centre_off,         ///< the first place is not where the settings put it
  went_back,          ///< to "Belts Extended", without an error
  other_error,
  log_ends,  ///< before the last waypoint that was announced, without an error
};

struct RunStopped {
  StopKind kind{};
  std::size_t line = 0;
  std::string said{};  ///< the machine's message; empty: none
  int last_measured = -1;
  int last_announced = -1;
  /// Single readings of the last attempt at the waypoint where it stopped.
  PerBelt<std::vector<double>> readings_mm{};
};

/// A setting, or a whole file of settings, that the controller rejected: it uses others.
struct SettingsRefused {
  std::size_t line = 0;
  std::string said;
};
bool is_setting_refused(std::string_view line);
std::string words_of(const SettingsRefused& refused);

/// Empty for a line that does not indicate a failure.
std::optional<StopKind> stop_of(std::string_view line);

/// The answer. `belts` are the places that were rebuilt, with the settings in force where these are
/// known.
std::string words_of(const RunStopped& stopped, const MeasuredBelts& belts);

// Readings `{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85}` in a log's lines. One that a serial line
// or a clipboard damaged is reported with the others; it keeps its place in the list. Private to
// grid/files.

struct ScannedReading {
  std::optional<PerBelt<double>> lengths_mm;  ///< empty: not measured, or not readable
  std::size_t line = 0;
  /// The reasons why it is not readable, each with its place in the file.
  std::vector<InputProblem> problems;
  /// Made of single readings, since no list has it.
  bool from_single_readings = false;
};

/// Reads lines in order. A reading may continue on the next lines.
class ReadingReader {
 public:
  explicit ReadingReader(std::string file) : file_(std::move(file)) {}

  struct Found {
    std::vector<ScannedReading> readings;
    bool list_ends = false;  ///< a "]" outside of readings
  };
  Found take(std::string_view line, std::size_t number);
  /// A reading has begun that has not ended.
  bool is_open() const { return open_; }
  /// Ends such a reading: as one that is not readable, if it looks like one.
  std::optional<ScannedReading> give_up();

 private:
  std::optional<ScannedReading> read(const std::string& text, bool is_closed = true) const;
  void begin(std::size_t number, std::size_t column);

  std::string file_;
  bool open_ = false;
  std::string text_;     ///< of the open reading
  std::string outside_;  ///< after the last reading
  std::size_t line_ = 0;
  std::size_t column_ = 0;
  std::size_t lines_ = 0;  ///< that the open reading has taken
};

struct ScannedRun {
  std::string heading;
  bool is_list = false;  ///< printed as CLBM:[...]
  /// By waypoint; those that are not readable keep their place.
  std::vector<ScannedReading> points;
  std::map<int, BedPoint> commanded;  ///< by waypoint
  std::map<int, PerBelt<std::vector<double>>> thrown_away_mm;
  /// Single readings of the last attempt at a waypoint.
  std::map<int, PerBelt<std::vector<double>>> last_attempt_mm;
  std::optional<FirmwareFit> fit;
  std::optional<double> pull_ma;  ///< the motors' current, where the log prints the setting before
  int last_measured = -1;         ///< of "Measured waypoint N"; -1: the log has none
  int last_announced = -1;        ///< of "Waypoints [0-N]"
  /// The list has fewer readings than waypoints were measured before it was printed.
  bool list_is_short = false;
  std::size_t first_line = 0;
};

struct ScannedLog {
  std::vector<ScannedRun> runs;            ///< with a reading that can be read, or that cannot
  std::optional<RunStopped> stopped;       ///< how the last run ended, if it did not finish
  std::optional<SettingsRefused> refused;  ///< the first setting that the controller rejected
  std::optional<std::size_t> first_passed_over;  ///< the first line from which nothing is read
  bool list_has_end = true;                      ///< false: the log ends in the middle of a list
};
/// `file` is the name used in messages.
ScannedLog scan_maslow4(const std::string& text, const std::string& file);

}  // namespace chaintrue::grid::files
