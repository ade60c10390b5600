// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/compensated.hpp"

#include "grid/files/grid_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/map_in_frame.hpp"
#include "tests/gcode/true_machine.hpp"
#include "tests/gcode_witness/follower/path_distance.hpp"
#include "tests/gcode_witness/support/random.hpp"

namespace chaintrue::witness {
namespace {

model::Machine with_controller(model::Machine machine, model::ControllerKind kind) {
  machine.controller.kind = kind;
  return machine;
}

/// The firmwares' constants, stated independently of tools/gcode/firmware.cpp.
follower::Workshop workshop(const grid::LengthMap& machine,
                            const model::ControllerKinematics& kinematics,
                            model::ControllerKind kind) {
  constexpr double kFluidncSegmentMm = 10.0;  // WallPlotter's segment_length, its default
  follower::Workshop result{&machine, &kinematics};
  result.single_precision = kind != model::ControllerKind::ideal;
  if (kind == model::ControllerKind::fluidnc_wallplotter)
    result.chain_linear_piece_mm = kFluidncSegmentMm;
  return result;
}

}  // namespace

Shop::Shop(std::unique_ptr<const grid::LengthMap> machine, const model::Machine& believed)
    : machine_(std::move(machine)),
      kinematics_(model::make_controller_kinematics(believed)),
      corrector_(*machine_, *kinematics_, gcode::firmware(believed.controller.kind)),
      workshop_(workshop(*machine_, *kinematics_, believed.controller.kind)) {}

std::unique_ptr<const Shop> measured_shop(const std::string& fixtures, model::ControllerKind kind) {
  static const grid::CompensationMap map =
      grid::fit(
          grid::files::read(grid::files::parse_grid, fixtures + "/grids/seven_by_four.json").grid)
          .value();
  return std::make_unique<Shop>(std::make_unique<grid::MapInFrame>(map),
                                with_controller(*grid::stated_machine(map), kind));
}

std::unique_ptr<const Shop> random_shop(std::uint64_t seed, model::ControllerKind kind) {
  Random random(seed);
  model::Machine machine;
  for (model::MotorPosition* motor : {&machine.motors.left, &machine.motors.right}) {
    motor->x_mm += random.between(-6.0, 6.0);
    motor->y_mm += random.between(-6.0, 6.0);
  }
  machine.chain_zero = {random.between(-3.0, 3.0), random.between(-3.0, 3.0)};
  return std::make_unique<Shop>(std::make_unique<gcode::testing_support::TrueMachine>(machine),
                                with_controller({}, kind));
}

std::optional<std::string> Shop::compensate(const std::string& program, double tolerance_mm,
                                            std::string& why) const {
  gcode::CompensateOptions options;
  options.tolerance_mm = tolerance_mm;
  std::string output;
  gcode::Compensator compensator(corrector_, options,
                                 [&](std::string_view bytes) { output += bytes; });
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

std::string Shop::verify(const std::string& original, const std::string& output,
                         double tolerance_mm) const {
  auto a = gcode::LineSource::from_text(original);
  auto b = gcode::LineSource::from_text(output);
  gcode::VerifyOptions options;
  options.tolerance_mm = tolerance_mm;
  const auto summary = gcode::verify(a, b, corrector_, {}, options);
  if (!summary) return summary.error().problem.message();
  return summary->holds() ? "" : summary->fault;
}

double Shop::distance_mm(const std::string& original, const std::string& output,
                         double most_mm) const {
  const auto intended = follower::joined(follower::program_path(original));
  const auto tool =
      follower::tool_path(workshop_, follower::joined(follower::program_path(output)));
  if (!tool) return most_mm;
  return follower::path_distance_mm(intended, *tool, most_mm);
}

bool Shop::follows(const std::string& original, const std::string& output,
                   double distance_mm) const {
  const auto intended = follower::joined(follower::program_path(original));
  const auto tool =
      follower::tool_path(workshop_, follower::joined(follower::program_path(output)));
  return tool && follower::within(intended, *tool, distance_mm);
}

}  // namespace chaintrue::witness
