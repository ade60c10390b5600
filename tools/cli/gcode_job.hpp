// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs of `chaintrue gcode` share: options, the map with its controller, the program's
/// text, messages.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "grid/files/pending_file.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/progress.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/verb.hpp"
#include "tools/gcode/compensation_target.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::cli {

struct GcodeOptions {
  std::string program;
  std::string other;  ///< verify: the file that is run
  std::string map;
  std::string machine;
  std::string controller;
  std::string frame = "marks";
  std::string home = "0,0";
  std::string output = "-";
  std::string report;  ///< compensate: a page with a picture
  double tolerance_mm = 0.05;
  double every_mm = 10.0;
  double largest_correction_mm = 30.0;
  double steepest_correction = 0.05;
  int decimals = 3;
  std::uint64_t step_budget = gcode::Dialect{}.step_budget;
  bool keep_rapids_whole = false;
  bool home_is_zero = false;
  bool skip_deletable = false;
  bool tools_have_no_diameter = false;
  bool no_verify = false;  ///< compensate: write without having run the output
  bool json = false;

  [[nodiscard]] gcode::Dialect dialect() const;
  /// Of --home. \throws InputError where it is no pair of numbers.
  [[nodiscard]] model::BedPoint home_mm() const;
};

/// Of --controller; empty where it is not given.
[[nodiscard]] std::optional<model::ControllerKind> controller_kind(std::string_view name);
/// That of --controller, a Maslow 4 among them; null where nothing is stated.
[[nodiscard]] const gcode::Firmware* stated_firmware(std::string_view name);

/// Map, machine and controller, which belong together.
class GcodeMachine {
 public:
  /// \throws InputError for bad files, or where neither map nor --machine says what the controller
  /// believes.
  explicit GcodeMachine(const GcodeOptions& options);
  [[nodiscard]] const gcode::TargetMap& target() const { return *target_; }
  [[nodiscard]] const gcode::Corrector& corrector() const { return *corrector_; }
  [[nodiscard]] const model::Machine& machine() const { return machine_; }
  [[nodiscard]] const std::string& map_hash() const { return map_hash_; }
  /// Of the machine that the map was extended with.
  [[nodiscard]] model::ChainLengths half_play_mm() const { return half_play_mm_; }

 private:
  void take_map(const GcodeOptions& options, const std::string& text);
  /// Of a fit of four belts, with the anchors that its controller goes by.
  void take_belts(const GcodeOptions& options, const std::string& text);

  std::unique_ptr<grid::CompensationMap> map_;
  std::unique_ptr<gcode::TargetMap> target_;
  model::Machine machine_;
  std::unique_ptr<const model::ControllerKinematics> kinematics_;
  std::unique_ptr<gcode::Corrector> corrector_;
  std::string map_hash_;
  model::ChainLengths half_play_mm_;
};

/// That the tolerance leaves room for rounding.
void check_limits(const GcodeOptions& options, OptionProblems& problems);
/// What compensating needs to know, the program's own hash left out.
[[nodiscard]] gcode::CompensateOptions compensate_options(const GcodeOptions& options,
                                                          const GcodeMachine& machine);

/// What running the output on the simulated machine needs to know.
[[nodiscard]] gcode::VerifyOptions verify_options(const GcodeOptions& options,
                                                  const GcodeMachine& machine);

/// A program's lines; standard input ("-") and pipes are kept in memory. \throws InputError where
/// it cannot be read.
class GcodeText {
 public:
  explicit GcodeText(const std::string& path);
  [[nodiscard]] gcode::LineSource open() const;
  /// The same, which shows this step of the work and how much of the program was read.
  [[nodiscard]] gcode::LineSource open(const grid::WorkStep& step) const;
  [[nodiscard]] std::string hash() const;

 private:
  std::string path_;
  std::optional<std::string> text_;
};

/// part.nc becomes part.true.nc.
[[nodiscard]] std::string compensated_name(const std::string& program);

/// Prints a problem to stderr as `file: line 3: ...`; gives the exit code that its kind has.
int report(const std::string& file, const gcode::Problem& problem);
/// Prints all findings and how many there are beyond those kept; the exit code of the first, or
/// kDone.
int report(const std::string& file, const gcode::Findings& findings);

/// What a file that has not taken its place yet holds, as a program. \throws InputError where it
/// could not be written.
[[nodiscard]] gcode::LineSource written_so_far(grid::files::PendingFile& file);

}  // namespace chaintrue::cli
