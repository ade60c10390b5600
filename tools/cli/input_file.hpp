// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Loads the input files of a verb: detects their kind once, refuses kinds that the verb does not
/// read, and reports assumptions on standard error.
///
/// \code
///   const InputFile file = open_input(command.map);
///   require_kind(file, {FileKind::map, FileKind::anchors});
///   if (file.kind == FileKind::anchors) return check_anchors(load_anchors(file), ...);
///   return check_map(load_map(file), ...);
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/measured_options.hpp"
#include "grid/files/plotter_settings.hpp"
#include "grid/files/sources.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/map/length_map.hpp"
#include "grid/map/map_check.hpp"
#include "grid/observation/measured.hpp"
#include "grid/plotter/found_plotter.hpp"
#include "model/belts/belt_machine.hpp"
#include "model/controllers/controller.hpp"
#include "model/machine.hpp"
#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

using files::is_json;
using files::name_in_messages;
using files::name_without_folders;
using files::read_whole_file;
using model::ControllerSettings;

struct InputFile {
  std::string path;  ///< as given
  std::string name;  ///< its name in messages
  std::string text;
  FileKind kind = FileKind::other;

  /// For options that act on this kind only.
  Facts fact() const;
};

using InputFiles = std::vector<InputFile>;

/// "-" is standard input. \throws InputError if it cannot be read, or is JSON that ends
/// before its type.
InputFile open_input(const std::string& path);

/// \param also a clause on where a refused kind is accepted; empty: as usual for that kind
/// \throws InputError with the kind found and the kinds accepted.
void require_kind(const InputFile& file, const std::vector<FileKind>& taken,
                  const std::string& also = "");

/// Each reads a file of its kind. \throws InputError with every problem.
FittedAnchors load_anchors(const InputFile& file);
/// Null if there are none.
const HolesWithBelts* holes_of(const FittedAnchors& found);
Diagnosis load_diagnosis(const InputFile& file);
Machine load_machine(const InputFile& file);
/// The belts of a chaintrue_belts file.
BeltMachine load_belt_machine(const InputFile& file);
/// At most kMostBeltPoints places; `work` is their purpose: "a fit". Leaves out the points
/// `without`, counted from 1.
ReadBelts load_belts(const InputFile& file, const std::string& work,
                     const std::vector<std::size_t>& without = {});

CompensationMap load_map(const InputFile& file);

/// "-" is standard input. A file that is read again gives no new warnings. \throws
/// InputError.
Machine read_machine_input(const std::string& path);

/// The machine of a four-belt controller: from a chaintrue_belts file with the anchors in force,
/// from a chaintrue_anchors file with the fitted ones, as pasted from export maslow4. \throws
/// InputError.
BeltMachine read_belt_machine_input(const std::string& path);

// The grid or the holes of a verb: the file, and the options that supplement it.
struct GridInput {
  std::string grid;
  std::string machine;
  std::optional<double> length_noise_mm;
  std::optional<double> position_noise_mm;
  std::optional<double> noise_dof;
  /// Readings are in inches, in tables whose header says mm.
  bool inches = false;
  /// Files of declared effects.
  Words effects;
};

/// Adds GRID, --machine and the --noise options to a verb.
void add_grid_options(Verb verb, GridInput& input);

/// For measured files: those of two chains, whether it is a single grid, and whether any of them is a
/// table.
Facts facts_of(const InputFiles& files);

/// --effects: declared effects may act on the machine of every input file.
OptionRow effects_row(GridInput& input);

/// Reads all inputs; warnings go to standard error. \throws InputError.
MeasuredGrid read_grid_input(const GridInput& input);

/// Adds --tape-sigma-mm, --hook-offset-mm, --hook-sigma-mm and --hole-sigma-mm to a verb.
void add_tape_options(Verb verb, TapeOptions& input);

/// --without, for a verb that reads belts.
[[nodiscard]] OptionRow without_row(std::string& without);
/// Its points, from 1. \throws InputError.
std::vector<std::size_t> points_left_out(const std::string& without);

/// Enough data for a fit, or only for a check of a map.
enum class MeasuredUse { fit, check };

/// A grid or a set of holes, as the file is; `otherwise` is the machine for a file that names none,
/// if available. \throws InputError.
MeasuredFile load_measured(const InputFile& file, const GridInput& input, const TapeOptions& tape,
                           MeasuredUse use, const Machine* otherwise = nullptr);

/// The first file and those of --with: any mix of grids and holes of one machine, with equal stated
/// settings. \throws InputError.
Measured load_measured(const InputFiles& files, const GridInput& input, const TapeOptions& tape,
                       MeasuredUse use);

struct ReadingCounts {
  std::size_t points = 0;
  std::size_t distances = 0;
  std::size_t holes = 0;
};
/// Counts the readings of all files together.
ReadingCounts counts_of(const Measured& measured);

/// The file, and those of --with.
InputFiles open_inputs(const std::string& path, const Words& with);

// --outside and --fade-mm: a map's continuation beyond its points, shared by several verbs.

struct OutsideOption {
  std::string way;
  double fade_width_mm = grid::OutsideRule{}.fade_width_mm;
};

/// \param usual what happens without the option, in words
void add_outside_options(Verb verb, OutsideOption& option, const std::string& usual);
/// The requested rule, or the given one.
grid::OutsideRule rule_of(const OutsideOption& option, const grid::OutsideRule& usual);

// The files of start for a V-plotter: the page to draw, the sheet of what to measure on it, and
// the drawing file to fill in.
/// A chaintrue_plotter, or settings that only a V-plotter has.
bool is_of_a_plotter(const InputFile& file);

/// A chaintrue_plotter, or the settings of a V-plotter's controller. \throws InputError with
/// every problem.
files::ReadPlotter load_plotter(const InputFile& file);

/// Next to the plotter's file if `folder` is empty. A measured plotter is assumed to have the
/// numbers of export plotter typed in.
int start_plotter(Verb verb, const InputFile& file, std::string folder);

// A machine's settings from any program: groundcontrol.ini, webcontrol.json, FluidNC's yaml, or a
// chaintrue_machine; and a map's machine with a controller that has these settings.
struct SettingsFile {
  std::string name;  ///< in messages
  files::ReadMachine read;
  /// Whether it is a file of this program.
  bool is_ours = false;
};

/// \throws InputError with every problem of the file.
SettingsFile read_settings_file(const std::string& path);
/// As above, from its text.
SettingsFile parse_settings_file(const std::string& path, const std::string& text);

/// `stated`, a map's machine as stated, with a controller that has `now`. A map without a
/// controller gets the file's. Reports in one line on standard error what differs from the settings
/// that the map was measured with. \param in_place the controller of --controller, for which the
/// settings are read; or null
/// \throws InputError for settings of another kind of controller, or that change the meaning
/// of the map's chain lengths.
[[nodiscard]] Machine with_settings(const Machine& stated, const SettingsFile& now,
                                    const ControllerKind* in_place);

/// map.json becomes map.after.json: where export writes the map for the typed-in numbers by
/// default.
std::string after_name(const std::string& map);

/// "maslow_classic", as in files and options.
std::string_view name_of(ControllerKind kind);

// A check whose points were commanded with settings other than the map's: those of a file, or the
// numbers of export groundcontrol if all or some were typed in since the map was measured, or not
// typed in although the map is for them. This is reported, and the check uses the map for the
// settings in force.

/// The map for the settings in the file `settings`; `measured` is recomputed for commands with
/// these. `map_name` is for messages.
/// \throws InputError for a bad file, settings of a wall plotter, or a map without a machine.
[[nodiscard]] CompensationMap with_settings_of(const std::string& settings,
                                               const std::string& map_name,
                                               const CompensationMap& map, Measured& measured);

/// Whether a map was made from the file `from` with its present content.
bool was_made_from(const std::string& made, const std::string& from);

/// The controller's settings for the map from which export made this one, if that map is next to it
/// unchanged.
std::optional<ControllerSettings> settings_before(const std::string& map);

/// `found` is the check of `map` against `measured`. Empty if the map's settings fit, or if the
/// others do not explain the points either. The others are those of `before`, the settings before
/// the map's numbers; else those of export groundcontrol.
[[nodiscard]] std::optional<Check> with_typed_settings(
    const CompensationMap& map, const Measured& measured, const Check& found,
    std::optional<ControllerSettings> before = {});

// What points are asked of and programs are made for: a compensation map, the anchors of four
// belts, or the V-plotter that a test drawing found. Verbs ask `lengths`; `content` holds
// what only one of the three has.
//
// \code
//   const Target target = open_target(open_target_file(command.map), command.frame);
//   if (const auto answer = target.lengths->query({100.0, -200.0})) use(*answer);
// \endcode
struct Target {
  using Content = std::variant<CompensationMap, FittedAnchors, KnownPlotter>;
  std::unique_ptr<const Content> content;
  std::unique_ptr<const grid::LengthMap> lengths;  ///< may refer to the content
  /// Null for another content.
  template <class Kind>
  const Kind* as() const {
    return std::get_if<Kind>(content.get());
  }
};

/// \throws InputError for a file of another kind.
InputFile open_target_file(const std::string& path);
/// \param frame of a map, "marks" or "bed". \throws InputError for a bad file; Failed for a map that
/// cannot be continued as `outside` asks.
Target open_target(const InputFile& file, const std::string& frame,
                   const OutsideOption& outside = {});

/// --frame for a target.
OptionRow frame_row(std::string& frame, std::string help);

/// A chaintrue_plotter with the results of a drawing. \throws InputError without them.
KnownPlotter load_found_plotter(const InputFile& file);

}  // namespace chaintrue::cli
