// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/machine_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "model/kinematics.hpp"

namespace chaintrue::grid::files {
namespace {

/// Links of the chains that are sold for this part at 3.5 kN; motors stall before.
constexpr double kMostPullN = 2000.0;

std::array<std::pair<std::string_view, BedPoint>, 5> outermost_of(const Bed& bed) {
  const double x = 0.5 * bed.width_mm, y = 0.5 * bed.height_mm;
  return {{{"middle of the upper edge", {0.0, y}},
           {"upper left corner", {-x, y}},
           {"upper right corner", {x, y}},
           {"lower left corner", {-x, -y}},
           {"lower right corner", {x, -y}}}};
}

void check_bed(const Machine& machine, Problems& problems) {
  const double half = 0.5 * machine.bed.width_mm;
  if (machine.motors.left.x_mm > -half || machine.motors.right.x_mm < half) {
    problems.add("the machine's motors",
                 fmt::format("motors at {:.1f} and {:.1f} mm, over a bed from {:.1f} to {:.1f} mm",
                             machine.motors.left.x_mm, machine.motors.right.x_mm, -half, half),
                 ProblemKind::impossible, "motors beyond both sides of the bed");
    return;
  }
  const auto kinematics = make_kinematics(equilibrium_parameters(machine));
  for (const auto& [name, place] : outermost_of(machine.bed)) {
    const auto pose = kinematics->inverse(place);
    if (!pose) {
      problems.add("the machine's bed",
                   fmt::format("its {} at ({:.1f}, {:.1f}) mm: {}", name, place.x_mm, place.y_mm,
                               pose.error().sentence()),
                   ProblemKind::impossible, "a bed below the motors that the sled can reach");
      return;
    }
    const double pull_n =
        std::max(pose->chains.left.tension_at_sprocket_n, pose->chains.right.tension_at_sprocket_n);
    if (pull_n < kMostPullN) continue;
    problems.add("the machine's motors",
                 fmt::format("a pull of {:.0f} N at the {} of the bed", pull_n, name),
                 ProblemKind::impossible,
                 "motors so high above the bed that no chain pulls more than {:.0f} N", kMostPullN);
    return;
  }
}

}  // namespace

void check_geometry(const Machine& machine, Problems& problems) {
  problems.add_all("the machine's ", problems_of(machine));
  if (!problems.any()) check_bed(machine, problems);
}

double longest_chain_mm(const Machine& machine) {
  const auto kinematics = make_kinematics(equilibrium_parameters(machine));
  double longest = 0.0;
  for (const auto& [name, place] : outermost_of(machine.bed)) {
    const auto pose = kinematics->inverse(place);
    if (pose) longest = std::max({longest, pose->lengths.left_mm, pose->lengths.right_mm});
  }
  return longest;
}

void refuse_foreign_settings(std::string_view text, Problems& problems) {
  struct Program {
    std::string_view name;
    std::string_view section;
  };
  constexpr Program kPrograms[] = {{"LinuxCNC", "[EMC]"},
                                   {"LinuxCNC", "[KINS]"},
                                   {"Klipper", "[mcu]"},
                                   {"Klipper", "[printer]"},
                                   {"Klipper", "[stepper_"}};
  for (const Program& program : kPrograms) {
    const std::size_t at = text.find(program.section);
    const bool is_at_line = at == 0 || (at != npos && text[at - 1] == '\n');
    if (!is_at_line) continue;
    problems.explain(
        line_and_column_of(text, at), ProblemKind::file_kind,
        fmt::format("these are settings of {}, which do not describe a hanging machine and are not "
                    "read. Enter the machine's dimensions instead: for a router on two chains, "
                    "chaintrue start without a file writes a machine file to fill in; for a "
                    "V-plotter, write a text with the lines machine.width=, "
                    "machine.motors.mmPerRev=, machine.motors.stepsPerRev=, "
                    "controller.homepoint.x= and controller.homepoint.y=, in mm from the left "
                    "motor, right and down",
                    program.name));
    problems.throw_if_any();
  }
}

}  // namespace chaintrue::grid::files
