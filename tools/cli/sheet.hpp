// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A plan of marks for the machine: a list with empty cells for the readings, which fit,
/// diagnose and check read once it is filled in, and a program that moves to the marks. Same marks,
/// same bytes.
#pragma once

#include <string>
#include <vector>

#include "grid/observation/measured_grid.hpp"
#include "grid/planning/holes_plan.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/places.hpp"

namespace chaintrue::cli {

/// The reading at a mark.
enum class SheetOf {
  places,   ///< the controller is sent there, and the tool's place is measured
  lengths,  ///< the tool is brought there, and both chains' lengths are read
};

/// Default distance from the bed's edge to the outermost marks and holes. More than half of an 18
/// inch sled is then on the sheet, which keeps it from tipping, and it clears the supports below.
inline constexpr double kReachableMm = 100.0;
/// On a bed of less than half a metre a fifth of its shorter side.
double reachable_mm(const Bed& bed);

/// --margin-mm leaves a bed at least this wide and high for marks.
void require_margin(OptionProblems& problems, double margin_mm, const Bed& bed,
                    double least_side_mm = 100.0);

/// The words of --measure, and the default for a machine: without a controller of known kinematics
/// only lengths can be read.
SheetOf sheet_of(const std::string& word, const Machine* machine);

struct Sheet {
  std::vector<MarkPoint> marks;
  SheetOf of = SheetOf::places;
  /// Numbers of the marks in driving order; empty: each once, in the given order.
  std::vector<std::size_t> visits = {};
};

/// Distance from the first hole at which a second visit drills, towards the middle: separate holes
/// that count as one place (kRepeatDistanceMm).
inline constexpr double kBesideMm = 15.0;

/// A line of a sheet. Marks are numbered in the order of their first visits.
struct SheetVisit {
  std::size_t number = 0;  ///< of the visit, from 1
  MarkPoint mark;
  std::size_t again = 0;   ///< the number of the mark's first visit; 0: this is the first
  bool is_beside = false;  ///< of a second visit: kBesideMm from there
  /// "29 (next to mark 8)", or "29 (mark 8 again)" if nothing is drilled
  std::string name() const;
};
std::vector<SheetVisit> visits_of(const Sheet& sheet);

/// order,commanded_x_mm,commanded_y_mm,x_mm,y_mm or order,x_mm,y_mm,left_mm,right_mm.
std::string sheet_csv(const Sheet& sheet);
/// The list as a chaintrue_grid, including the machine and the noise.
std::string sheet_json(const Sheet& sheet, const Machine& machine, const StatedNoise& noise);

struct DrillOptions {
  double depth_mm = 3.0;
  double clearance_mm = 5.0;
};

/// Drills every mark; if lengths are read, stops above it until the owner continues. Metric and
/// absolute.
std::string sheet_gcode(const Sheet& sheet, const DrillOptions& options);
/// Drills every hole.
std::string holes_gcode(const grid::HolesPlan& plan, const DrillOptions& options);

/// A list in a file is JSON if the file's name ends in .json; on standard output, if --json is
/// given.
bool is_json_wanted(bool json, const std::string& output);

// A plan as a page to print: the bed drawn, the steps in order, and lines to write the readings
// on. For both A4 and Letter; nothing is fetched, no script runs. Same plan, same bytes.

/// `list` is the file for the readings; empty: standard output.
std::string sheet_page(const Sheet& sheet, const Machine& machine, const std::string& list);
std::string holes_page(const grid::HolesPlan& plan, const std::string& list);

// The outputs of a plan: list, page, program and drawing.

/// Paths; empty: not wanted.
struct PlanOutputs {
  std::string list = "-";
  std::string drawing;
  std::string gcode;
  std::string page;
  DrillOptions drill;
  bool json = false;
};

/// The list and, if requested, the page, the program and the answer. \param expected as for
/// add_answer
Outputs sheet_outputs(const Sheet& sheet, const Machine& machine, const StatedNoise& noise,
                      const PlanOutputs& outputs, const std::string& expected);

/// With --json, where the list goes into a file: the places in mm, numbers of places in the order of
/// the visits (empty: each once), and members of an object on what is expected.
void add_answer(const std::vector<MarkPoint>& places, const std::vector<std::size_t>& visits,
                const std::string& expected, const PlanOutputs& outputs, Outputs& written);

/// The next step: fill in the list and fit it.
void say_next_of_sheet(const PlanOutputs& outputs, const std::string& machine);

}  // namespace chaintrue::cli
