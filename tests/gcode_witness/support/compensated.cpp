// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/compensated.hpp"

#include <stdexcept>

#include "grid/files/grid_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/map_for_settings.hpp"
#include "tests/gcode_witness/follower/path_distance.hpp"

namespace chaintrue::witness {
namespace {

model::Machine with_controller(model::Machine machine, model::ControllerKind kind) {
  machine.controller.kind = kind;
  return machine;
}

/// The firmwares' constants, stated independently of tools/gcode/firmware.cpp.
follower::Workshop workshop(const grid::CompensationMap& map,
                            const model::ControllerKinematics& kinematics,
                            model::ControllerKind kind) {
  constexpr double kFluidncSegmentMm = 10.0;  // WallPlotter's segment_length, its default
  follower::Workshop result{&map, &kinematics};
  result.single_precision = kind != model::ControllerKind::ideal;
  if (kind == model::ControllerKind::fluidnc_wallplotter)
    result.chain_linear_piece_mm = kFluidncSegmentMm;
  return result;
}

}  // namespace

const grid::CompensationMap& measured_map(const std::string& fixtures) {
  static const grid::CompensationMap map =
      grid::fit(grid::files::read_grid(fixtures + "/grids/seven_by_four.json").grid).value();
  return map;
}

Shop::Shop(const grid::CompensationMap& map, model::ControllerKind kind)
    : target_(map),
      machine_(with_controller(*grid::stated_machine(map), kind)),
      kinematics_(model::make_controller_kinematics(machine_)),
      corrector_(target_, *kinematics_, gcode::firmware(kind)),
      workshop_(workshop(map, *kinematics_, kind)) {}

std::optional<std::string> Shop::compensate(const std::string& program,
                                            double tolerance_mm,
                                            std::string& why) const {
  gcode::CompensateOptions options;
  options.tolerance_mm = tolerance_mm;
  std::string output;
  gcode::Compensator compensator(
      corrector_, options, [&](std::string_view bytes) { output += bytes; });
  auto source = gcode::LineSource::from_text(program);
  const auto outcome = compensator.run(source, {});
  if (!outcome) {
    why = outcome.error().message();
    return std::nullopt;
  }
  if (compensator.findings().problem_count > 0) {
    why = compensator.findings().problems.front().message();
    return std::nullopt;
  }
  return output;
}

std::string Shop::verify(const std::string& original,
                         const std::string& output,
                         double tolerance_mm) const {
  auto a = gcode::LineSource::from_text(original);
  auto b = gcode::LineSource::from_text(output);
  gcode::VerifyOptions options;
  options.tolerance_mm = tolerance_mm;
  const auto summary = gcode::verify(a, b, corrector_, {}, options);
  if (!summary) return summary.error().problem.message();
  return summary->holds() ? "" : summary->fault;
}

double Shop::distance_mm(const std::string& original,
                         const std::string& output,
                         double most_mm) const {
  const auto intended = follower::joined(follower::program_path(original));
  const auto tool = follower::tool_path(workshop_, follower::joined(follower::program_path(output)));
  if (!tool) return most_mm;
  return follower::path_distance_mm(intended, *tool, most_mm);
}

bool Shop::follows(const std::string& original,
                   const std::string& output,
                   double distance_mm) const {
  const auto intended = follower::joined(follower::program_path(original));
  const auto tool = follower::tool_path(workshop_, follower::joined(follower::program_path(output)));
  return tool && follower::within(intended, *tool, distance_mm);
}

}  // namespace chaintrue::witness
