// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Uses the installed package: reads a machine and asks for the chain lengths in the bed's lower left corner.
#include <fmt/format.h>

#include <cmath>

#include "grid/files/machine_file.hpp"
#include "model/kinematics.hpp"

using chaintrue::model::Model;

constexpr const char* kMachine = R"({
  "file_type": "chaintrue_machine", "format_version": "1.0", "name": "consumer",
  "bed": {"width_mm": 2438.4, "height_mm": 1219.2},
  "motors": {"left": {"x_mm": -1489.2, "y_mm": 1072.6}, "right": {"x_mm": 1489.2, "y_mm": 1072.6}},
  "sprocket": {"teeth": 10, "pitch_mm": 6.35},
  "feed": "over_top",
  "attachment": {"kind": "ring", "radius_mm": 139.1},
  "chain": {"mass_kg_per_m": 0.14, "compliance_per_n": 5.1685e-6},
  "sled": {"mass_kg": 11.6},
  "frame": {"tilt_from_vertical_deg": 15.0}
})";
// Elastic catenary, default machine, at (-1219.2, -609.6): table_over_top.json, d_elastic.
constexpr double kReferenceLeftMm = 1578.086244515909970542772674587386123;
constexpr double kReferenceRightMm = 3059.343465116610797725982533579905476067;
constexpr double kToleranceMm = 1e-9;  // what the model promises over the bed

int main() {
  const auto machine = chaintrue::grid::files::parse_machine(kMachine, "consumer.json");
  const auto kinematics = make_kinematics(equilibrium_parameters(machine), Model::elastic);
  const auto pose = kinematics->inverse({-1219.2, -609.6});
  if (!pose) return 1;
  fmt::print("left {:.9f} mm, right {:.9f} mm\n", pose->lengths.left_mm, pose->lengths.right_mm);
  const bool is_right = std::abs(pose->lengths.left_mm - kReferenceLeftMm) < kToleranceMm &&
                        std::abs(pose->lengths.right_mm - kReferenceRightMm) < kToleranceMm;
  return is_right ? 0 : 1;
}
