// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_record.hpp"

#include "grid/files/names.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using model::ChainLengths;
using model::Cord;
using model::DrawingArea;
using model::Gondola;
using model::MotorPlace;
using model::PlotterFirmware;
using model::PlotterMachine;
using model::PlotterUncertainty;

auto gondola_record() {
  return Record<Gondola>("a gondola")
      .optional("spacing_mm",
                "Between the two points where the cords hold it; 0: both cords end at the pen.",
                &Gondola::spacing_mm,
                kMillimetres)
      .optional("pen_below_mm",
                "Distance of the pen below the middle between those points, hanging level.",
                &Gondola::pen_below_mm,
                kMillimetres)
      .optional("pen_right_mm",
                "Distance of the pen to the right of that middle.",
                &Gondola::pen_right_mm,
                kMillimetres)
      .optional("mass_below_mm",
                "Distance of the centre of mass below that middle.",
                &Gondola::mass_below_mm,
                kMillimetres)
      .optional("mass_right_mm",
                "Distance of the centre of mass to the right of that middle.",
                &Gondola::mass_right_mm,
                kMillimetres)
      .required("mass_kg", "Mass of everything that hangs.", &Gondola::mass_kg, number_in("kg"))
      .optional("standoff_mm",
                "Extra distance from the wall of the cords' ends at the gondola, relative to "
                "those at the wall.",
                &Gondola::standoff_mm,
                kMillimetres);
}

auto cord_record() {
  return Record<Cord>("a cord")
      .optional(
          "mass_kg_per_m", "Mass of a metre of cord.", &Cord::mass_kg_per_m, number_in("kg/m"))
      .optional("compliance_per_n",
                "Strain of a cord per newton; 0: none.",
                &Cord::compliance_per_n,
                number_in("1/N"))
      .optional("tooth_mm",
                "Length lost when a motor slips: a tooth of the belt, or a full step of a spool.",
                &Cord::tooth_mm,
                kMillimetres);
}

auto area_record() {
  return Record<DrawingArea>("a drawing area")
      .required("left_mm", "Left limit of the pen.", &DrawingArea::left_mm, kMillimetres)
      .required("right_mm", "Right limit of the pen.", &DrawingArea::right_mm, kMillimetres)
      .required("top_mm",
                "Upper limit of the pen; the pins are at 0.",
                &DrawingArea::top_mm,
                kMillimetres)
      .required("bottom_mm", "Lower limit of the pen.", &DrawingArea::bottom_mm, kMillimetres);
}

auto cord_zero_record() {
  return Record<ChainLengths>("the zeros of the cords")
      .optional("left_mm",
                "Excess of the controller's length of the left cord.",
                &ChainLengths::left_mm,
                kMillimetres)
      .optional("right_mm",
                "Excess of the controller's length of the right cord.",
                &ChainLengths::right_mm,
                kMillimetres);
}

auto cord_scale_record() {
  return Record<ChainLengths>("the scales of the cords")
      .optional("left_mm_per_m",
                "Excess of the controller's length per metre of the left cord.",
                &ChainLengths::left_mm,
                number_in("mm/m"))
      .optional("right_mm_per_m",
                "Excess of the controller's length per metre of the right cord.",
                &ChainLengths::right_mm,
                number_in("mm/m"));
}

auto uncertainty_of_plotter_record() {
  using Sigmas = PlotterUncertainty;
  return Record<Sigmas>("the uncertainties of a V-plotter")
      .optional("pin_spacing_mm",
                "Uncertainty of the distance between the pins, 1 sigma.",
                &Sigmas::pin_spacing_mm,
                kMillimetres)
      .optional("pin_rise_mm",
                "Uncertainty of the right pin's height above the left, 1 sigma.",
                &Sigmas::pin_rise_mm,
                kMillimetres)
      .optional(
          "zero_mm", "Uncertainty of each cord's zero, 1 sigma.", &Sigmas::zero_mm, kMillimetres)
      .optional("scale_mm_per_m",
                "Uncertainty of the length per motor turn, 1 sigma.",
                &Sigmas::scale_mm_per_m,
                number_in("mm/m"));
}

void check_plotter_machine(const Cursor& at, PlotterMachine& machine) {
  if (!at.has("name")) machine.name.clear();
  report_impossible(at, model::problems_of(machine));
}

auto plotter_machine_record() {
  using model::Feed;
  using Plotter = PlotterMachine;
  return Record<Plotter>("a V-plotter's machine")
      .optional("name", "Its name.", &Plotter::name)
      .required("pin_spacing_mm",
                "Distance between the two points on the wall from which the cords come: pins, "
                "or axles of the pulleys.",
                &Plotter::pin_spacing_mm,
                kMillimetres)
      .optional("pin_rise_mm",
                "Height of the right point above the left.",
                &Plotter::pin_rise_mm,
                kMillimetres)
      .required("motors",
                "Location of the motors with the pulleys or spools that count.",
                &Plotter::motors,
                by_name_to(MotorPlace::gondola))
      .optional(
          "feed", "Side of its pulley over which a cord leaves.", &Plotter::feed, choice(kFeeds))
      .optional("pulley_radius_mm",
                "Radius of the cord on its pulley; 0: straight to the pin.",
                &Plotter::pulley_radius_mm,
                kMillimetres)
      .required("gondola", "What hangs on the cords.", &Plotter::gondola, gondola_record())
      .optional("cord", "The cords, or belts.", &Plotter::cord, cord_record())
      .optional("zero",
                "Known excess of the controller's length of each cord, which is corrected.",
                &Plotter::zero_mm,
                cord_zero_record())
      .optional("scale", "The same per metre.", &Plotter::scale_mm_per_m, cord_scale_record())
      .required("area",
                "Allowed positions of the pen, from the middle between the pins.",
                &Plotter::area,
                area_record())
      .optional("uncertainty",
                "Uncertainties of the settings, 1 sigma.",
                &Plotter::uncertainty,
                uncertainty_of_plotter_record())
      .check(check_plotter_machine);
}

auto steps_record() {
  using Steps = model::PerSide<double>;
  return Record<Steps>("steps per millimetre")
      .required("left", "For the left motor; 0: unknown.", &Steps::left, {"", 0.0, 1e5})
      .required("right", "For the right motor; 0: unknown.", &Steps::right, {"", 0.0, 1e5});
}

auto wall_point_record() {
  return Record<model::BedPoint>("a place on the wall")
      .place("x, to the right.", "y, up.", kPlaceMm);
}

auto pen_record() {
  return Record<PenCommands>("the pen's commands")
      .required("up", "The line of G-code that lifts the pen.", &PenCommands::up)
      .required("down", "The line of G-code that lowers it.", &PenCommands::down);
}

void check_set_plotter(const Cursor& at, SetPlotter& set) {
  if (!at.clean()) return;
  const bool is_mural = set.firmware == PlotterFirmware::mural;
  if (is_mural && model::is_point(set.machine.gondola)) {
    at.child("machine")
        .child("gondola")
        .child("spacing_mm")
        .report("0",
                ProblemKind::out_of_range,
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
  return Record<SetPlotter>("a V-plotter with its controller's settings")
      .required("firmware",
                "The firmware, whose kinematics converts a command into cord lengths; a "
                "Makelangelo is a marlin.",
                &SetPlotter::firmware,
                by_name_to(PlotterFirmware::mural))
      .required("machine",
                "The machine with the controller's settings.",
                &SetPlotter::machine,
                plotter_machine_record())
      .optional(
          "steps_per_mm", "As set in the controller.", &SetPlotter::steps_per_mm, steps_record())
      .optional("home",
                "Position that the controller assumes when it is switched on, from the middle "
                "between the pins. For all but a mural.",
                &SetPlotter::home,
                wall_point_record())
      .optional("pins_middle",
                "The middle between the pins in the controller's own coordinates.",
                &SetPlotter::pins_middle,
                wall_point_record())
      .optional("homed_offset_mm",
                "Homed step offset of a mural.",
                &SetPlotter::homed_offset_mm,
                {"mm", -1000.0, 1000.0})
      .optional("pen", "Commands that lift and lower the pen.", &SetPlotter::pen, pen_record())
      .optional("feed_mm_per_min",
                "Feed for the test page.",
                &SetPlotter::feed_mm_per_min,
                {"mm/min", 1.0, 1e5})
      .optional("longest_belt_mm",
                "Longest belt that the controller allows; the test drawing stays within it.",
                &SetPlotter::longest_belt_mm,
                {"mm", 1.0, 40000.0})
      .optional("segments_per_second",
                "For Marlin: pieces per second into which it divides a move (S of M665).",
                &SetPlotter::segments_per_second,
                {"1/s", 0.1, 1e4})
      .check(check_set_plotter);
}

}  // namespace chaintrue::grid::files
