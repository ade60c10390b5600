// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shared by the verbs of `chaintrue gcode`: inputs of compensating and verifying, the program's
/// text, messages.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/controller_settings.hpp"
#include "grid/files/pending_file.hpp"
#include "grid/progress.hpp"
#include "grid/provenance.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/expected_error.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::cli {

using gcode::CompensateOptions;
using gcode::Findings;
using gcode::Firmware;
using gcode::LineSource;
using gcode::Move;
using gcode::Note;
using gcode::PathSample;
using gcode::Problem;

// The options of `chaintrue gcode`, and which map, machine and controller they name.

struct GcodeOptions {
  Verb verb;
  std::string program;
  std::string other;  ///< verify: the file that is run
  std::string map;
  /// For --map; opened before any verb begins.
  std::optional<InputFile> map_file;
  std::string machine;
  /// The word for the option of `machine` and its alternatives in messages.
  std::string machine_option = "--machine or --settings";
  /// The controller's present settings.
  std::string settings;
  std::string controller;
  std::string frame = "marks";
  std::string home = "0,0";
  std::string output = "-";
  std::string report;        ///< compensate: a page with a picture
  CompensateOptions limits;  ///< as stated; compensate_options() adds the controller's
  gcode::Dialect words;      ///< as stated; dialect() adds the home and the codes
  double every_mm = 10.0;
  bool no_verify = false;  ///< compensate: write without having run the output
  bool forced = false;     ///< compensate: even with a map that is unfit for cutting
  bool json = false;

  gcode::Dialect dialect() const;
  /// For --home. \throws InputError if it is not a pair of numbers.
  BedPoint home_mm() const;
};

/// The firmware of --controller, including Maslow 4 and Marlin; null if not stated.
const Firmware* stated_firmware(std::string_view name);

/// Opens the file given as --map and warns if its scale is unknown. \throws InputError for a bad file.
Target open_target(const GcodeOptions& options);

/// How the machine's controller executes a program.
struct GcodeController {
  std::unique_ptr<const model::ControllerKinematics> kinematics;
  const Firmware* firmware;
  /// Empty if it does not clamp.
  std::optional<gcode::ClampBox> clamp_box;
  /// The area for programs: the bed, the frame of the anchors of four belts, a plotter's drawing
  /// area.
  Rectangle sheet;
  /// From the map's machine; none for belts and plotters.
  ChainLengths half_play_mm;
  /// Its settings, for the header of compensated programs.
  std::vector<files::NamedSetting> settings;
  /// A firmware with its own settings; then `firmware` points to this.
  std::shared_ptr<const Firmware> with_settings = nullptr;
};

/// Map, machine and controller, which belong together.
struct GcodeMachine {
  /// \throws InputError for bad files, or if neither map nor --machine states the controller's
  /// settings.
  explicit GcodeMachine(const GcodeOptions& options);
  GcodeMachine(const GcodeMachine&) = delete;
  GcodeMachine& operator=(const GcodeMachine&) = delete;

  const Target target;
  const GcodeController controller;
  const gcode::Corrector corrector;
};

/// The area for programs with --machine; without it the usual bed. \throws InputError.
Rectangle sheet_of(const GcodeOptions& options);

/// With a map: checks that the tolerance exceeds the rounding.
void check_limits(const GcodeOptions& options, OptionProblems& problems);
/// Inputs of compensating, except the program.
CompensateOptions compensate_options(const GcodeOptions& options, const GcodeMachine& machine);

/// Inputs of running the output on the simulated machine.
gcode::VerifyOptions verify_options(const GcodeOptions& options, const GcodeMachine& machine);

/// A program's lines; standard input ("-") and pipes are kept in memory. \throws InputError where
/// it cannot be read.
class GcodeText {
 public:
  explicit GcodeText(const std::string& path);
  LineSource open() const;
  /// As above, and shows this step of the work and the share of the program that was read.
  LineSource open(const WorkStep& step) const;
  /// Its name without folders, and its hash.
  SourceFile source() const;

 private:
  std::string path_;
  std::optional<std::string> text_;
};

/// A command on the map of these options, with their --settings.
[[nodiscard]] Words with_map_words(const GcodeOptions& options, Words words);

/// part.nc becomes part.true.nc.
std::string compensated_name(const std::string& program);

/// Thrown for a refused program, after all of its problems were printed.
struct GcodeRefused : Failed {
  explicit GcodeRefused(std::vector<Problem> found);
  std::vector<Problem> problems;
};

/// A JSON text.
std::string in_quotes(std::string_view text);

/// Prints a problem to stderr as `file: line 3: ...`; returns the exit code of its kind.
int report(const std::string& file, const Problem& problem);
/// Prints all findings and how many there are beyond those kept; the exit code of the first, or
/// kDone.
int report(const std::string& file, const Findings& findings);

/// The content of a pending file, as a program. \throws InputError if it could not be written.
LineSource written_so_far(PendingFile& file);

// The verbs of `chaintrue gcode`; each returns the exit code. \throws files::InputError.
using GcodeVerb = int(const GcodeOptions& options);

/// A program's extent and, with a map, all problems that compensating would report.
GcodeVerb run_gcode_check;
/// Chain lengths along the path, as a CSV.
GcodeVerb run_gcode_lengths;
GcodeVerb run_gcode_compensate;
/// Runs a program on a simulated controller and compares the track with another program's path.
GcodeVerb run_gcode_verify;
/// One line: the state before, what it does, the state after.
GcodeVerb run_gcode_explain;

// The expected error of the tool for a compensated program: the map's uncertainty along the cuts,
// and the path's deviation.

/// `map` is empty if the map's error is unknown, `path_mm` is the largest deviation of the
/// simulated tool. Adds the two: their directions are unrelated.
struct PromisedError {
  std::optional<gcode::ExpectedError> map;
  double path_mm = 0.0;
  /// Without the scale of four belts, if it was not taped.
  bool is_without_scale = false;

  /// For cuts on the measured part; empty if there are none.
  std::optional<double> measured_mm() const;
  /// For cuts outside.
  std::optional<double> outside_mm() const;
};

/// The uncertainty of the machine's map or anchors for cuts at these places.
[[nodiscard]] PromisedError promised_along(const gcode::CutPlaces& cuts,
                                           const GcodeMachine& machine, double path_mm);
/// Sentences, one per line; empty if nothing is cut or known.
std::string in_words(const PromisedError& error);
/// For --json, as members of an object: `"expected_mm": 0.28, ...`; null if unknown.
std::string as_members(const PromisedError& error);

}  // namespace chaintrue::cli
