// SPDX-License-Identifier: GPL-3.0-or-later
#include "torture/invocations.hpp"

#include <algorithm>
#include <array>

namespace chaintrue::torture {
namespace {

using Words = std::vector<std::string>;

}  // namespace

const std::vector<std::pair<std::string, std::string>>& copied_files() {
  static const std::vector<std::pair<std::string, std::string>> all = {
      {"grid.json", "grids/seven_by_four.json"},
      {"few.json", "grids/five_new_points.json"},
      {"grid_every_key.json", "good/grid_every_key.json"},
      {"grid.csv", "good/grid_plain.csv"},
      {"commas.csv", "good/grid_decimal_commas_and_semicolons.csv"},
      {"machine.json", "machines/classic.json"},
      {"machine_every_key.json", "good/machine_every_key.json"},
      {"controller.json", "machines/groundcontrol.json"},
      {"holes.json", "holes/nine_holes.json"},
      {"holes.csv", "good/holes_plain.csv"},
      {"belts.json", "belts/thirty_one_places.json"},
      {"belts_every_key.json", "good/belts_every_key.json"},
      {"maslow4.txt", "good/maslow4_notes.txt"},
      {"maslow4_log.txt", "good/maslow4_log.txt"},
      {"maslow.yaml", "machines/maslow.yaml"},
      {"settings.ini", "good/groundcontrol_ring.ini"},
      {"mural.txt", "plotter/mural.txt"},
      {"drawing.json", "plotter/mural_drawing.json"},
      {"plotter.json", "good/plotter_every_key.json"},
      {"scan.csv", "good/optical_scan.csv"},
      {"diagnosis_every_key.json", "good/diagnosis_every_key.json"},
      {"part.nc", "gcode/bracket.nc"}};
  return all;
}

const std::vector<Words>& makers() {
  static const std::vector<Words> all = {
      {"fit", "grid.json", "-o", "map.json"},
      {"fit", "belts.json", "-o", "anchors.json"},
      {"diagnose", "holes.json", "-o", "diagnosis.json"},
      {"diagnose", "belts.json", "-o", "belts_diagnosis.json"},
      {"gcode", "compensate", "part.nc", "--map", "map.json", "-o", "true.nc"},
      {"sweep", "sweep.json", "-o", "whole"}};
  return all;
}

const std::vector<Reading>& readings() {
  static const std::vector<Reading> all = {
      {"grid.json", 8, {"fit", "IN", "-o", "OUT"}},
      {"grid.json", 1, {"diagnose", "IN", "-o", "OUT"}},
      {"grid.json", 4, {"check", "map.json", "IN"}},
      {"grid.json", 2, {"fit", "holes.json", "--with", "IN", "-o", "OUT"}},
      {"grid.json", 1, {"diagnose", "grid.json", "--held-out", "IN"}},
      {"few.json", 4, {"check", "map.json", "IN"}},
      {"grid_every_key.json", 4, {"fit", "IN", "-o", "OUT"}},
      {"grid.csv", 8, {"fit", "IN", "--machine", "machine.json", "-o", "OUT"}},
      {"grid.csv", 4, {"fit", "IN", "--surface", "direct", "-o", "OUT"}},
      {"commas.csv", 4, {"fit", "IN", "--machine", "machine.json", "-o", "OUT"}},
      {"machine.json", 6, {"simulate", "--machine", "IN", "--grid", "4x3", "-o", "OUT"}},
      {"machine.json", 4, {"simulate", "--machine", "IN", "--grid", "3x3"}},
      {"machine.json", 2, {"simulate", "--machine", "IN", "--holes", "5", "--distances", "8"}},
      {"machine.json", 2, {"plan", "--machine", "IN", "--points", "12", "-o", "OUT"}},
      {"machine.json", 1, {"plan", "--machine", "IN", "--holes", "5"}},
      {"machine.json", 1, {"passes", "--machine", "IN", "--passes", "2"}},
      {"machine.json", 2, {"effects", "chain_stretch", "--machine", "IN"}},
      {"machine.json", 1, {"effects", "--atlas", "IN", "-o", "OUT"}},
      {"machine.json", 6, {"export", "groundcontrol", "IN"}},
      {"machine.json", 4, {"square", "--machine", "IN", "--controller-machine", "machine.json"}},
      {"machine_every_key.json", 4, {"simulate", "--machine", "IN", "--grid", "3x3"}},
      {"machine_every_key.json", 4, {"start", "IN", "OUT"}},
      {"holes.json", 5, {"fit", "IN", "-o", "OUT"}},
      {"holes.json", 2, {"diagnose", "IN", "-o", "OUT"}},
      {"holes.json", 2, {"passes", "IN", "-o", "OUT"}},
      {"holes.json", 3, {"check", "map.json", "IN"}},
      {"holes.csv", 5, {"fit", "IN", "--machine", "machine.json", "-o", "OUT"}},
      {"belts.json", 6, {"fit", "IN", "-o", "OUT"}},
      {"belts.json", 2, {"diagnose", "IN", "-o", "OUT"}},
      {"belts.json", 3, {"check", "anchors.json", "IN"}},
      {"belts.json", 3, {"simulate", "--belts", "IN", "--grid", "4x4", "-o", "OUT"}},
      {"belts_every_key.json", 4, {"fit", "IN", "-o", "OUT"}},
      {"maslow4.txt", 6, {"import", "maslow4", "IN", "-o", "OUT"}},
      {"maslow4_log.txt", 6, {"import", "maslow4", "IN", "-o", "OUT"}},
      {"maslow4_log.txt", 2, {"maslow4", "--replay", "IN", "--settings", "maslow.yaml"}},
      {"maslow.yaml", 6, {"import", "maslow4", "maslow4_log.txt", "--settings", "IN", "-o", "OUT"}},
      {"settings.ini", 8, {"import", "groundcontrol", "IN", "-o", "OUT"}},
      {"settings.ini", 2, {"start", "IN", "OUT"}},
      {"mural.txt", 4, {"import", "plotter", "IN", "-o", "OUT"}},
      {"mural.txt", 2, {"start", "IN", "OUT"}},
      {"plotter.json", 6, {"export", "plotter", "IN"}},
      {"plotter.json", 4, {"start", "IN", "OUT"}},
      {"drawing.json", 6, {"fit", "IN", "-o", "OUT"}},
      {"drawing.json", 2, {"diagnose", "IN", "-o", "OUT"}},
      {"scan.csv", 6, {"import", "optical", "IN", "--machine", "controller.json", "-o", "OUT"}},
      {"points.csv", 8, {"query", "map.json", "--points", "IN"}},
      {"points.csv", 3, {"query", "anchors.json", "--points", "IN"}},
      {"points.csv", 4, {"simulate", "--machine", "machine.json", "--points", "IN"}},
      {"points.csv", 2, {"simulate", "--machine", "machine.json", "--marks", "IN"}},
      {"map.json", 8, {"query", "IN", "0", "0", "900", "-400"}},
      {"map.json", 2, {"plan", "--check", "IN"}},
      {"map.json", 2, {"square", "--map", "IN"}},
      {"anchors.json", 4, {"export", "maslow4", "IN"}},
      {"anchors.json", 4, {"query", "IN", "0", "0", "900", "-400"}},
      {"anchors.json", 2, {"report", "IN", "-o", "OUT"}},
      {"anchors.json", 2, {"gcode", "check", "part.nc", "--map", "IN"}},
      {"diagnosis.json", 6, {"report", "IN", "-o", "OUT"}},
      {"diagnosis.json", 4, {"plan", "holes.json", "--after", "IN"}},
      {"diagnosis.json", 2, {"diagnose", "holes.json", "--before", "IN"}},
      {"diagnosis_every_key.json", 4, {"report", "IN", "-o", "OUT"}},
      {"diagnosis_every_key.json", 2, {"export", "groundcontrol", "IN"}},
      {"belts_diagnosis.json", 4, {"report", "IN", "-o", "OUT"}},
      {"belts_diagnosis.json", 4, {"plan", "belts.json", "--after", "IN"}},
      {"belts_diagnosis.json", 2, {"export", "maslow4", "IN"}},
      {"sweep.json", 2, {"sweep", "IN", "-o", "OUT", "--shard", "1/4"}},
      {"part.nc", 10, {"gcode", "check", "IN"}},
      {"part.nc", 10, {"gcode", "compensate", "IN", "--map", "map.json", "-o", "OUT"}},
      {"part.nc", 6, {"gcode", "lengths", "IN", "--map", "map.json", "-o", "OUT"}},
      {"part.nc", 4, {"gcode", "verify", "IN", "IN", "--map", "map.json"}},
      {"part.nc", 4, {"gcode", "verify", "part.nc", "IN", "--map", "map.json"}},
      {"part.nc", 4, {"gcode", "explain", "IN:3"}},
  };
  return all;
}

const std::vector<Sealed>& sealed_files() {
  static const std::vector<Sealed> all = {
      {"map.json",
       {{"query", "IN", "0", "0", "1100", "-500"},
        {"query", "IN", "--inverse", "1600", "1700"},
        {"report", "IN", "-o", "OUT"},
        {"check", "IN", "few.json"},
        {"export", "linuxcnc", "IN", "-o", "OUT"},
        {"export", "klipper", "IN", "-o", "OUT"},
        {"export", "fluidnc", "IN", "-o", "OUT"},
        {"gcode", "compensate", "part.nc", "--map", "IN", "-o", "OUT"}}},
      {"anchors.json",
       {{"query", "IN", "0", "0", "1100", "-500"},
        {"report", "IN", "-o", "OUT"},
        {"check", "IN", "belts.json"},
        {"export", "maslow4", "IN"},
        {"gcode", "compensate", "part.nc", "--map", "IN", "-o", "OUT"}}}};
  return all;
}

const std::vector<Words>& invocations() {
  static const std::vector<Words> all = {
      {"start", "settings.ini", "OUT"},
      {"import", "optical", "scan.csv", "--machine", "controller.json", "-o", "OUT"},
      {"import", "groundcontrol", "settings.ini", "-o", "OUT"},
      {"import", "maslow4", "maslow4_log.txt", "--settings", "maslow.yaml", "-o", "OUT"},
      {"import", "plotter", "mural.txt", "-o", "OUT"},
      {"start", "mural.txt", "OUT"},
      {"export", "plotter", "plotter.json", "-o", "OUT"},
      {"fit", "drawing.json", "-o", "OUT"},
      {"export", "groundcontrol", "controller.json", "-o", "OUT"},
      {"export", "linuxcnc", "map.json", "-o", "OUT"},
      {"export", "klipper", "map.json", "-o", "OUT"},
      {"export", "fluidnc", "map.json", "-o", "OUT"},
      {"export", "grblhal", "map.json", "-o", "OUT"},
      {"export", "maslow4", "anchors.json", "-o", "OUT"},
      {"plan", "--machine", "machine.json", "-o", "OUT"},
      {"plan", "--machine", "machine.json", "--holes", "5", "-o", "OUT"},
      {"plan", "--check", "map.json", "-o", "OUT"},
      {"plan", "holes.json", "--after", "diagnosis.json", "-o", "OUT"},
      {"simulate", "--machine", "machine.json", "--grid", "4x3", "-o", "OUT"},
      {"simulate", "--machine", "machine.json", "--holes", "5", "-o", "OUT"},
      {"simulate", "--belts", "belts.json", "--grid", "4x3", "-o", "OUT"},
      {"diagnose", "grid.json", "-o", "OUT"},
      {"diagnose", "holes.json", "-o", "OUT"},
      {"diagnose", "belts.json", "-o", "OUT"},
      {"fit", "grid.json", "-o", "OUT"},
      {"fit", "grid.csv", "--surface", "direct", "-o", "OUT"},
      {"fit", "holes.json", "-o", "OUT"},
      {"fit", "belts.json", "-o", "OUT"},
      {"query", "map.json", "10", "NUMBER"},
      {"query", "map.json", "--inverse", "1600", "NUMBER"},
      {"query", "anchors.json", "900", "NUMBER", "-o", "OUT"},
      {"check", "map.json", "few.json", "-o", "OUT"},
      {"check", "anchors.json", "belts.json", "-o", "OUT"},
      {"maslow4", "--replay", "maslow4_log.txt", "--settings", "maslow.yaml"},
      {"passes", "--machine", "machine.json", "--passes", "2", "-o", "OUT"},
      {"passes", "holes.json", "-o", "OUT"},
      {"report", "map.json", "-o", "OUT"},
      {"report", "diagnosis.json", "-o", "OUT"},
      {"report", "anchors.json", "-o", "OUT"},
      {"gcode", "check", "part.nc", "--map", "map.json"},
      {"gcode", "lengths", "part.nc", "--map", "map.json", "-o", "OUT"},
      {"gcode", "compensate", "part.nc", "--map", "map.json", "-o", "OUT"},
      {"gcode", "compensate", "part.nc", "--map", "anchors.json", "-o", "OUT"},
      {"gcode", "verify", "part.nc", "true.nc", "--map", "map.json"},
      {"gcode", "explain", "part.nc:NUMBER"},
      {"effects", "chain_stretch", "--machine", "machine.json"},
      {"formats", "machine"},
      {"square", "--machine", "machine.json", "--controller-machine", "controller.json"},
      {"square", "--map", "map.json", "-o", "OUT"},
      {"sweep", "sweep.json", "-o", "OUT", "--shard", "1/4"},
      {"completion", "bash"},
      {"man", "fit"}};
  return all;
}

bool has_subverbs(std::string_view verb) {
  return verb == "import" || verb == "export" || verb == "gcode";
}

std::string verb_of(const Words& arguments) {
  return has_subverbs(arguments[0]) ? arguments[0] + " " + arguments[1] : arguments[0];
}

const Words& good_texts(const std::string& option) {
  static const std::map<std::string, Words> all = {
      {"--grid", {"4x3", "2x2", "7x4"}},
      {"--spacing", {"regular", "chebyshev"}},
      {"--region", {"whole", "left", "top"}},
      {"--order", {"rows", "columns", "random", "serpentine_rows"}},
      {"--effect",
       {"chain_pitch_error:left:elongation=0.0012",
        "chain_stretch:both:axial_stiffness_n=100000",
        "belt_stretch:-:elongation=0.004"}},
      {"--offset", {"motor_left_x_mm=1.5", "tl_x_mm=12"}},
      {"--model", {"straight", "firmware", "elastic_3d"}},
      {"--name", {"a name", "<b>"}},
      {"--side", {"left", "both"}},
      {"--set", {"elongation=0.001"}},
      {"--shard", {"1/4", "4/4"}},
      {"--date", {"2026-11-22"}},
      {"--home", {"1,2", "-10,5.5"}},
      {"--points", {"0:9", "12"}},
      {"--machine", {"machine.json", "machine_every_key.json", "controller.json"}},
      {"--with", {"grid.json", "holes.json", "few.json"}}};
  static const Words none;
  const auto found = all.find(option);
  return found == all.end() ? none : found->second;
}

bool is_output(std::string_view option) {
  static constexpr std::array<std::string_view, 11> all = {"--output",
                                                           "--page",
                                                           "--gcode",
                                                           "--svg",
                                                           "--answer",
                                                           "--report",
                                                           "--extended-machine",
                                                           "--corrected-grid",
                                                           "--law",
                                                           "--draw",
                                                           "--all"};
  return std::find(all.begin(), all.end(), option) != all.end();
}

}  // namespace chaintrue::torture
