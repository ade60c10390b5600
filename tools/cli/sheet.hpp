// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A plan of marks for the machine: a list with empty cells for the readings, which fit,
/// diagnose and check read once it is filled in, and a program that moves to the marks. Same marks,
/// same bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/map/fitted_points.hpp"
#include "grid/observation/measured.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/observation/measured_holes.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/report/document.hpp"

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

struct DrillOptions {
  double depth_mm = 3.0;
  double clearance_mm = 5.0;
};

/// Drills every mark; if lengths are read, stops above it until the owner continues. Metric and
/// absolute.
std::string sheet_gcode(const Sheet& sheet, const DrillOptions& options);
/// Drills every hole.
std::string holes_gcode(const HolesPlan& plan, const DrillOptions& options);

/// A list in a file is JSON if the file's name ends in .json; on standard output, if --json is
/// given.
bool is_json_wanted(bool json, const std::string& output);

// A plan as a page to print: the bed drawn, the steps in order, and lines to write the readings
// on. For both A4 and Letter; nothing is fetched, no script runs. Same plan, same bytes.

/// `list` is the file for the readings; empty: standard output.
std::string sheet_page(const Sheet& sheet, const Machine& machine, const std::string& list);
std::string holes_page(const HolesPlan& plan, const std::string& list);

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

// A measurement plan as a drawing: the bed coloured by the expected error, the marks numbered in
// the order of the walk. Same plan, same bytes.
/// Over the bed, cell by cell from the bottom left.
struct ExpectedErrors {
  int columns = 0;
  int rows = 0;
  std::vector<double> cells_mm;  ///< negative if the map has no answer
  double rms_mm = 0.0;
  double largest_mm = 0.0;
  MarkPoint worst_at;
  std::size_t unanswered = 0;
};
ExpectedErrors expected_errors(const CompensationMap& map, const Bed& bed);

/// A self-contained SVG; nothing is fetched, no script runs.
std::string draw_plan(const grid::MeasurementPlan& plan, const Bed& bed,
                      const ExpectedErrors& errors);

/// The next places as numbered crosses among the measured ones.
std::string draw_follow_up(const std::vector<MarkPoint>& measured,
                           const std::vector<FollowUpPlace>& next, const Bed& bed);

// A plan of holes as a drawing: the sheet, the holes by name, a line for each distance to measure.
// Same plan, same bytes.

/// The foot of the perpendicular on an edge of the bed.
BedPoint on_edge(BedPoint from, grid::SheetEdge edge, const Bed& bed);
/// A self-contained SVG; nothing is fetched, no script runs.
std::string draw_holes_plan(const HolesPlan& plan);

// The part of chaintrue plan that chooses holes and tape distances.
/// The numbers of holes and distances and their sigmas, shared by all verbs that plan holes.
void require_sound(OptionProblems& problems, const HolesPlanRequest& request);

/// Adds --distances, --edges, --tape-sigma-mm and --hole-sigma-mm, for --holes.
void add_tape_options(Verb verb, HolesPlanRequest& request);

/// Writes the list, the drawing and the program; returns the exit code. \throws InputError
/// for values out of range.
int plan_the_holes(HolesPlanRequest request, const Machine& machine, const PlanOutputs& wanted);

// Holes and distances in words and numbers, shared by several verbs.
/// Each distance: measured, commanded, and predicted by the others; `file` if there are several.
Section distances_section(const MeasuredHoles& set, const grid::FittedDistances& fit,
                          std::string_view file);
/// The chains' scales, and the meaning of "left out".
void add_legend(const grid::estimation::ParameterKnowledge& knowledge, Section& distances);
/// "20 distances", "18 distances and 6 to the sheet's edges".
std::string distances_in_number(const MeasuredHoles& set);
/// The holes and what to measure, as a list for the workshop.
std::string workshop_list(const HolesPlan& plan);

// The next measurements of a diagnosis, as a list for the workshop and as lines for the file of marks.
/// The number of the next visit; empty where visits are not numbered.
template <class Points>
std::optional<int> next_visit(const Points& points) {
  std::optional<int> next;
  for (const auto& point : points) {
    if (point.order) next = std::max(next.value_or(0), *point.order + 1);
  }
  return next;
}

/// Numbered sentences, each with its expected probability.
std::string follow_up_list(const Diagnosis& found);

/// Whether any of them has this kind.
bool proposes(const Diagnosis& found, MeasurementKind kind);

/// The points to add to the grid's file, with empty lengths or commands, and with visit numbers if
/// the grid has them.
std::string point_lines(const Diagnosis& found, const MeasuredGrid& measured, bool is_json);
/// The readings of the machine to add to a file of either kind.
std::string readings_json(const Diagnosis& found);

// chaintrue plan --after: the next measurements with a tape, as lines for a file of holes. If
// several sets were diagnosed together, hole A of the second is "A (2)" to the diagnosis and A in
// its own file.

/// Whether the diagnosis used exactly these holes and distances.
bool is_diagnosis_of(const Diagnosis& found, const std::vector<const MeasuredHoles*>& sets);

/// Holes to cut, with unused names, and distances without values, for the set at this position. If
/// none is in this set, JSON is empty, and a table has only its two headers.
std::string distance_lines(const Diagnosis& found, const std::vector<const MeasuredHoles*>& sets,
                           std::size_t position, bool is_json);

// chaintrue plan FILE --after: what to measure next, as a list for the workshop, as lines for the
// files that were diagnosed, and as a drawing.
struct PlanAfterOptions {
  std::string file;  ///< a grid, holes or belts
  std::string after;
  Words with;  ///< the other files of the same diagnosis
  std::string machine;
  std::string output = "-";
  std::string drawing;
};

/// Facts on which options depend. \throws InputError for a file of another kind.
Facts facts_after(const InputFile& file);

/// \param file the options' file, opened
/// \throws InputError. Returns an exit code.
int plan_after(const PlanAfterOptions& options, const InputFile& file);

/// What to measure next, as texts: the list for the workshop, the lines to fill in, and the drawing
/// (SVG).
struct FollowUpTexts {
  std::string list;
  std::string csv;  ///< empty for belts, which have no CSV
  std::string json;
  std::string drawing;
};
/// Empty if the diagnosis used other readings.
std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found, const Measured& measured);
std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found, const MeasuredBelts& belts);

}  // namespace chaintrue::cli
