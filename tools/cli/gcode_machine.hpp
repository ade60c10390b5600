// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The options of `chaintrue gcode`, and which map, machine and controller they name.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/controller_settings.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/plotter/found_plotter.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/verb.hpp"
#include "tools/gcode/compensator.hpp"

namespace chaintrue::cli {

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
  bool forced = false;     ///< compensate: even with a map that is unfit for cutting
  bool json = false;

  [[nodiscard]] gcode::Dialect dialect() const;
  /// For --home. \throws InputError if it is not a pair of numbers.
  [[nodiscard]] BedPoint home_mm() const;
};

/// From --controller; empty if not given.
[[nodiscard]] std::optional<ControllerKind> controller_kind(std::string_view name);
/// The firmware of --controller, including Maslow 4 and Marlin; null if not stated.
[[nodiscard]] const gcode::Firmware* stated_firmware(std::string_view name);

/// What a program aims at: a map, the fit of four belts, or the plotter that a drawing found.
struct GcodeTarget {
  std::unique_ptr<const CompensationMap> map = {};  ///< null for four belts and for a V-plotter
  std::optional<grid::KnownPlotter> plotter = {};
  /// For four belts: the machine in force when they were measured.
  std::optional<BeltMachine> belts_in_force = {};
  std::unique_ptr<const grid::LengthMap> lengths = {};
  /// For four belts whose scale was not taped: the map whose error excludes the scale; otherwise
  /// null.
  std::unique_ptr<const grid::LengthMap> in_belts_mm = {};
};
/// Of --map. \throws InputError for a bad file.
[[nodiscard]] GcodeTarget open_target(const GcodeOptions& options);

/// How the machine's controller executes a program.
struct GcodeController {
  std::unique_ptr<const model::ControllerKinematics> kinematics;
  const gcode::Firmware* firmware;
  /// Empty if it does not clamp.
  std::optional<gcode::ClampBox> clamp_box;
  /// The area for programs: the bed, the frame of the anchors of four belts, a plotter's drawing
  /// area.
  interp::Rectangle sheet;
  /// From the map's machine; none for belts and plotters.
  model::ChainLengths half_play_mm;
  /// Its settings, for the header of compensated programs.
  std::vector<files::NamedSetting> settings;
  /// A firmware with its own settings; then `firmware` points to this.
  std::shared_ptr<const gcode::Firmware> with_settings = nullptr;
};

/// Map, machine and controller, which belong together.
class GcodeMachine {
 public:
  /// \throws InputError for bad files, or if neither map nor --machine states the controller's
  /// settings.
  explicit GcodeMachine(const GcodeOptions& options);
  [[nodiscard]] const grid::LengthMap& target() const { return *target_.lengths; }
  /// See GcodeTarget::in_belts_mm.
  [[nodiscard]] const grid::LengthMap* in_belts_mm() const { return target_.in_belts_mm.get(); }
  /// Null for four belts and for a V-plotter.
  [[nodiscard]] const CompensationMap* map() const { return target_.map.get(); }
  [[nodiscard]] const grid::KnownPlotter* plotter() const {
    return target_.plotter ? &*target_.plotter : nullptr;
  }
  [[nodiscard]] const gcode::Corrector& corrector() const { return corrector_; }
  [[nodiscard]] const GcodeController& controller() const { return controller_; }

 private:
  GcodeTarget target_;
  GcodeController controller_;
  gcode::Corrector corrector_;
};

/// The area for programs with --machine; without it the usual bed. \throws InputError.
[[nodiscard]] interp::Rectangle sheet_of(const GcodeOptions& options);

}  // namespace chaintrue::cli
