// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_file.hpp"

#include <fmt/format.h>

#include "grid/files/names.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::files {
namespace {

RECORD_OF(model::Gondola, "a gondola")
OPTIONAL(spacing_mm,
         "Between the two points where the cords hold it; 0: both cords end at the pen.",
         kMillimetres)
OPTIONAL(pen_below_mm, "Distance of the pen below the middle between those points, hanging level.",
         kMillimetres)
OPTIONAL(pen_right_mm, "Distance of the pen to the right of that middle.", kMillimetres)
OPTIONAL(mass_below_mm, "Distance of the centre of mass below that middle.", kMillimetres)
OPTIONAL(mass_right_mm, "Distance of the centre of mass to the right of that middle.", kMillimetres)
REQUIRED(mass_kg, "Mass of everything that hangs.", number_in("kg"))
OPTIONAL(standoff_mm,
         "Extra distance from the wall of the cords' ends at the gondola, relative to "
         "those at the wall.",
         kMillimetres)
END_RECORD;

RECORD_OF(model::Cord, "a cord")
OPTIONAL(mass_kg_per_m, "Mass of a metre of cord.", number_in("kg/m"))
OPTIONAL(compliance_per_n, "Strain of a cord per newton; 0: none.", number_in("1/N"))
OPTIONAL(tooth_mm,
         "Length lost when a motor slips: a tooth of the belt, or a full step of a spool.",
         kMillimetres)
END_RECORD;

RECORD_OF(model::DrawingArea, "a drawing area")
REQUIRED(left_mm, "Left limit of the pen.", kMillimetres)
REQUIRED(right_mm, "Right limit of the pen.", kMillimetres)
REQUIRED(top_mm, "Upper limit of the pen; the pins are at 0.", kMillimetres)
REQUIRED(bottom_mm, "Lower limit of the pen.", kMillimetres)
END_RECORD;

auto cord_zero_record() {
  RECORD(ChainLengths, "the zeros of the cords")
  OPTIONAL(left_mm, "Excess of the controller's length of the left cord.", kMillimetres)
  OPTIONAL(right_mm, "Excess of the controller's length of the right cord.", kMillimetres);
}

auto cord_scale_record() {
  RECORD(ChainLengths, "the scales of the cords")
  NAMED(optional, "left_mm_per_m", left_mm,
        "Excess of the controller's length per metre of the left cord.", number_in("mm/m"))
  NAMED(optional, "right_mm_per_m", right_mm,
        "Excess of the controller's length per metre of the right cord.", number_in("mm/m"));
}

RECORD_OF(model::PlotterUncertainty, "the uncertainties of a V-plotter")
OPTIONAL(pin_spacing_mm, "Uncertainty of the distance between the pins, 1 sigma.", kMillimetres)
OPTIONAL(pin_rise_mm, "Uncertainty of the right pin's height above the left, 1 sigma.",
         kMillimetres)
OPTIONAL(zero_mm, "Uncertainty of each cord's zero, 1 sigma.", kMillimetres)
OPTIONAL(scale_mm_per_m, "Uncertainty of the length per motor turn, 1 sigma.", number_in("mm/m"))
END_RECORD;

void check_plotter_machine(const Cursor& at, PlotterMachine& machine) {
  if (!at.has("name")) machine.name.clear();
  report_impossible(at, problems_of(machine));
}

RECORD_OF(PlotterMachine, "a V-plotter's machine")
OPTIONAL(name, "Its name.")
REQUIRED(pin_spacing_mm,
         "Distance between the two points on the wall from which the cords come: pins, "
         "or axles of the pulleys.",
         kMillimetres)
OPTIONAL(pin_rise_mm, "Height of the right point above the left.", kMillimetres)
REQUIRED(motors, "Location of the motors with the pulleys or spools that count.",
         by_name_to(model::MotorPlace::gondola))
OPTIONAL(feed, "Side of its pulley over which a cord leaves.", in_order<Feed>(kFeeds))
OPTIONAL(pulley_radius_mm, "Radius of the cord on its pulley; 0: straight to the pin.",
         kMillimetres)
REQUIRED(gondola, "What hangs on the cords.")
OPTIONAL(cord, "The cords, or belts.")
NAMED(optional, "zero", zero_mm,
      "Known excess of the controller's length of each cord, which is corrected.",
      cord_zero_record())
NAMED(optional, "scale", scale_mm_per_m, "The same per metre.", cord_scale_record())
REQUIRED(area, "Allowed positions of the pen, from the middle between the pins.")
OPTIONAL(uncertainty, "Uncertainties of the settings, 1 sigma.")
    .check(check_plotter_machine) END_RECORD;

RECORD_OF(PerSide<double>, "steps per millimetre")
REQUIRED(left, "For the left motor; 0: unknown.", {"", 0.0, 1e5})
REQUIRED(right, "For the right motor; 0: unknown.", {"", 0.0, 1e5})
END_RECORD;

auto wall_point_record() {
  RECORD(BedPoint, "a place on the wall")
  FIELD(place, "x, to the right.", "y, up.", kPlaceMm);
}

RECORD_OF(PenCommands, "the pen's commands")
REQUIRED(up, "The line of G-code that lifts the pen.")
REQUIRED(down, "The line of G-code that lowers it.")
END_RECORD;

void check_set_plotter(const Cursor& at, SetPlotter& set) {
  if (!at.clean()) return;
  const bool is_mural = set.firmware == PlotterFirmware::mural;
  if (is_mural && model::is_point(set.machine.gondola)) {
    at.child("machine")
        .child("gondola")
        .child("spacing_mm")
        .report("0", ProblemKind::out_of_range,
                "for a mural, the distance between its two pulleys, 85 as built");
  }
  if (!is_mural && !set.home) {
    at.child("home").missing(
        "the position that the controller assumes when it is switched on, from the middle between "
        "the "
        "pins");
  }
}

}  // namespace

Record<SetPlotter> set_plotter_record() {
  RECORD(SetPlotter, "a V-plotter with its controller's settings")
  REQUIRED(firmware,
           "The firmware, whose kinematics converts a command into cord lengths; a "
           "Makelangelo is a marlin.",
           by_name_to(PlotterFirmware::mural))
  REQUIRED(machine, "The machine with the controller's settings.")
  OPTIONAL(steps_per_mm, "As set in the controller.")
  OPTIONAL(home,
           "Position that the controller assumes when it is switched on, from the middle "
           "between the pins. For all but a mural.",
           wall_point_record())
  OPTIONAL(pins_middle, "The middle between the pins in the controller's own coordinates.",
           wall_point_record())
  OPTIONAL(homed_offset_mm, "Homed step offset of a mural.", {"mm", -1000.0, 1000.0})
  OPTIONAL(pen, "Commands that lift and lower the pen.")
  OPTIONAL(feed_mm_per_min, "Feed for the test page.", {"mm/min", 1.0, 1e5})
  OPTIONAL(longest_belt_mm,
           "Longest belt that the controller allows; the test drawing stays within it.",
           {"mm", 1.0, 40000.0})
  OPTIONAL(segments_per_second,
           "For Marlin: pieces per second into which it divides a move (S of M665).",
           {"1/s", 0.1, 1e4})
      .check(check_set_plotter);
}

namespace {

RECORD_OF(FoundSetting, "an estimated setting")
REQUIRED(value, "Its value.", kMillimetres)
REQUIRED(sigma, "Its uncertainty, 1 sigma.", kSigmaMm)
END_RECORD;

void check_correlations(const Cursor& at, FoundPlotter& found) {
  constexpr std::size_t kPairs = 15;  // of six settings
  if (!at.clean()) return;
  if (found.correlations.size() != kPairs) {
    at.child("correlations")
        .report(fmt::format("{} numbers", found.correlations.size()), ProblemKind::wrong_count,
                "15, of each of the six settings with those after it");
    return;
  }
  // Rounding may move a correlation matrix's least eigenvalue below zero by this.
  constexpr double kRounding = 1e-6;
  const VectorXd scale = found.covariance().diagonal().cwiseSqrt();
  MatrixXd of_ones = found.covariance();
  for (Index i = 0; i < scale.size(); ++i) {
    if (!(scale[i] > 0.0)) return;
    of_ones.row(i) /= scale[i];
    of_ones.col(i) /= scale[i];
  }
  if (linear::SymmetricEigen(of_ones).eigenvalues().minCoeff() >= -kRounding) return;
  at.child("correlations")
      .report("correlations that six quantities can have", ProblemKind::impossible,
              "the ones that chaintrue fit wrote");
}

RECORD_OF(FoundPlotter, "settings estimated from a drawing")
REQUIRED(pin_spacing_mm, "Distance between the pins.")
REQUIRED(pin_rise_mm, "Height of the right pin above the left.")
REQUIRED(zero_left_mm, "Excess of the controller's length of the left cord.")
REQUIRED(zero_right_mm, "Excess of the controller's length of the right cord.")
REQUIRED(scale_left_mm_per_m, "Excess of the controller's length per metre of the left cord.")
REQUIRED(scale_right_mm_per_m, "Excess of the controller's length per metre of the right cord.")
REQUIRED(correlations,
         "Correlations of each of these six, in this order, with those after it: 15 "
         "numbers, used for the expected error of compensated drawings.",
         list({"", -1.0, 1.0}))
    .check(check_correlations) END_RECORD;

/// A machine with these settings must be valid.
void check_found(const Cursor& at, KnownPlotter& plotter) {
  if (!at.clean() || !plotter.found) return;
  const auto problems = problems_of(machine_found(plotter.set, *plotter.found));
  if (problems.empty()) return;
  at.child("found").report(problems.front().parameter.substr(1) + " " + problems.front().value,
                           ProblemKind::impossible, problems.front().expected);
}

}  // namespace

FILE_RECORD(plotter, KnownPlotter, "a V-plotter", kPlotterFormat)
REQUIRED(set, "The plotter with its controller's settings.", set_plotter_record())
OPTIONAL(found, "Results of a test drawing; absent before one was measured.")
ALSO(add_made_by_key).check(check_found) END_FILE_RECORD;

KnownPlotter parse_plotter(const std::string& text, const std::string& file) {
  return read_document(plotter_record(), text, file);
}

std::string write_plotter(const KnownPlotter& plotter, const Words& comments,
                          const std::optional<Provenance>& made_by) {
  Json json = with_made_by(plotter_record().write(plotter), made_by);
  if (!comments.empty()) json["comment"] = comments;
  return print_json(json);
}

}  // namespace chaintrue::grid::files
