// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_record.hpp"

#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using model::BedPoint;
using model::ChainLengths;
using model::Cord;
using model::DrawingArea;
using model::Gondola;
using model::MotorPlace;
using model::PlotterFirmware;
using model::PlotterMachine;
using model::PlotterUncertainty;

const Record<Gondola>& gondola_record() {
  static const auto record =
      Record<Gondola>("a gondola")
          .optional("spacing_mm", &Gondola::spacing_mm, number_in("mm"))
          .optional("pen_below_mm", &Gondola::pen_below_mm, number_in("mm"))
          .optional("pen_right_mm", &Gondola::pen_right_mm, number_in("mm"))
          .optional("mass_below_mm", &Gondola::mass_below_mm, number_in("mm"))
          .optional("mass_right_mm", &Gondola::mass_right_mm, number_in("mm"))
          .required("mass_kg", &Gondola::mass_kg, number_in("kg"))
          .optional("standoff_mm", &Gondola::standoff_mm, number_in("mm"));
  return record;
}

const Record<Cord>& cord_record() {
  static const auto record =
      Record<Cord>("a cord")
          .optional("mass_kg_per_m", &Cord::mass_kg_per_m, number_in("kg/m"))
          .optional("compliance_per_n", &Cord::compliance_per_n, number_in("1/N"))
          .optional("tooth_mm", &Cord::tooth_mm, number_in("mm"));
  return record;
}

const Record<DrawingArea>& area_record() {
  static const auto record = Record<DrawingArea>("a drawing area")
                                 .required("left_mm", &DrawingArea::left_mm, number_in("mm"))
                                 .required("right_mm", &DrawingArea::right_mm, number_in("mm"))
                                 .required("top_mm", &DrawingArea::top_mm, number_in("mm"))
                                 .required("bottom_mm", &DrawingArea::bottom_mm, number_in("mm"));
  return record;
}

const Record<ChainLengths>& cord_zero_record() {
  static const auto record = Record<ChainLengths>("the zeros of the cords")
                                 .optional("left_mm", &ChainLengths::left_mm, number_in("mm"))
                                 .optional("right_mm", &ChainLengths::right_mm, number_in("mm"));
  return record;
}

const Record<ChainLengths>& cord_scale_record() {
  static const auto record =
      Record<ChainLengths>("the scales of the cords")
          .optional("left_mm_per_m", &ChainLengths::left_mm, number_in("mm/m"))
          .optional("right_mm_per_m", &ChainLengths::right_mm, number_in("mm/m"));
  return record;
}

const Record<PlotterUncertainty>& uncertainty_of_plotter_record() {
  using Sigmas = PlotterUncertainty;
  static const auto record =
      Record<Sigmas>("the uncertainties of a V-plotter")
          .optional("pin_spacing_mm", &Sigmas::pin_spacing_mm, number_in("mm"))
          .optional("pin_rise_mm", &Sigmas::pin_rise_mm, number_in("mm"))
          .optional("zero_mm", &Sigmas::zero_mm, number_in("mm"))
          .optional("scale_mm_per_m", &Sigmas::scale_mm_per_m, number_in("mm/m"));
  return record;
}

void check_plotter_machine(const Cursor& at, PlotterMachine& machine) {
  if (!at.has("name")) machine.name.clear();
  for (const model::MachineProblem& problem : model::problems_of(machine)) {
    const std::string place = at.pointer() + problem.parameter;
    // A field that could not be read keeps its default, which needs no check.
    if (!at.problems().at_or_below(place)) at.problems().add(place, problem);
  }
}

const Record<PlotterMachine>& plotter_machine_record() {
  using model::Feed;
  using Plotter = PlotterMachine;
  static const auto record =
      Record<Plotter>("a V-plotter's machine")
          .optional("name", &Plotter::name, text())
          .required("pin_spacing_mm", &Plotter::pin_spacing_mm, number_in("mm"))
          .optional("pin_rise_mm", &Plotter::pin_rise_mm, number_in("mm"))
          .required(
              "motors",
              &Plotter::motors,
              choice<MotorPlace>({{"wall", MotorPlace::wall}, {"gondola", MotorPlace::gondola}}))
          .optional("feed",
                    &Plotter::feed,
                    choice<Feed>({{"over_top", Feed::over_top}, {"off_bottom", Feed::off_bottom}}))
          .optional("pulley_radius_mm", &Plotter::pulley_radius_mm, number_in("mm"))
          .required("gondola", &Plotter::gondola, object(gondola_record()))
          .optional("cord", &Plotter::cord, object(cord_record()))
          .optional("zero", &Plotter::zero_mm, object(cord_zero_record()))
          .optional("scale", &Plotter::scale_mm_per_m, object(cord_scale_record()))
          .required("area", &Plotter::area, object(area_record()))
          .optional("uncertainty", &Plotter::uncertainty, object(uncertainty_of_plotter_record()))
          .check(check_plotter_machine);
  return record;
}

const Record<model::PerSide<double>>& steps_record() {
  using Steps = model::PerSide<double>;
  static const auto record = Record<Steps>("steps per millimetre")
                                 .required("left", &Steps::left, number({"", 0.0, 1e5}))
                                 .required("right", &Steps::right, number({"", 0.0, 1e5}));
  return record;
}

const Record<BedPoint>& wall_point_record() {
  static const auto record = Record<BedPoint>("a place on the wall")
                                 .required("x_mm", &BedPoint::x_mm, number(kPlaceMm))
                                 .required("y_mm", &BedPoint::y_mm, number(kPlaceMm));
  return record;
}

const Record<PenCommands>& pen_record() {
  static const auto record = Record<PenCommands>("the pen's commands")
                                 .required("up", &PenCommands::up, text())
                                 .required("down", &PenCommands::down, text());
  return record;
}

void check_set_plotter(const Cursor& at, SetPlotter& set) {
  if (!at.clean()) return;
  const bool is_mural = set.firmware == PlotterFirmware::mural;
  if (is_mural && model::is_point(set.machine.gondola)) {
    at.problems().add(at.pointer() + "/machine/gondola/spacing_mm",
                      "0",
                      "of a mural the distance between its two pulleys, 85 as it is built",
                      ProblemKind::out_of_range);
  }
  if (!is_mural && !set.home) {
    at.child("home").missing(
        "where the controller takes the pen to be when it is switched on, from the middle between "
        "the pins");
  }
}

}  // namespace

const Record<SetPlotter>& set_plotter_record() {
  static const auto record =
      Record<SetPlotter>("a V-plotter as its controller holds it")
          .required("firmware",
                    &SetPlotter::firmware,
                    choice<PlotterFirmware>({{"fluidnc", PlotterFirmware::fluidnc},
                                             {"marlin", PlotterFirmware::marlin},
                                             {"polargraph", PlotterFirmware::polargraph},
                                             {"mural", PlotterFirmware::mural}}))
          .required("machine", &SetPlotter::machine, object(plotter_machine_record()))
          .optional("steps_per_mm", &SetPlotter::steps_per_mm, object(steps_record()))
          .optional("home", &SetPlotter::home, object(wall_point_record()))
          .optional("pins_middle", &SetPlotter::pins_middle, object(wall_point_record()))
          .optional(
              "homed_offset_mm", &SetPlotter::homed_offset_mm, number({"mm", -1000.0, 1000.0}))
          .optional("pen", &SetPlotter::pen, object(pen_record()))
          .optional("feed_mm_per_min", &SetPlotter::feed_mm_per_min, number({"mm/min", 1.0, 1e5}))
          .optional("longest_belt_mm", &SetPlotter::longest_belt_mm, number({"mm", 1.0, 40000.0}))
          .optional("segments_per_second", &SetPlotter::segments_per_second, number({"1/s", 0.1, 1e4}))
          .check(check_set_plotter);
  return record;
}

}  // namespace chaintrue::grid::files
