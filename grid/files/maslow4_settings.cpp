// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "grid/files/anchors_file.hpp"

namespace chaintrue::grid::files {

Maslow4Settings write_maslow4_settings(const BeltsFit& fit) {
  Maslow4Settings result;
  for (const model::Belt belt : model::kBelts) {
    const model::Anchor& anchor = fit.machine.anchors[belt];
    for (const auto& [axis, value] : {std::pair{'X', anchor.x_mm}, std::pair{'Y', anchor.y_mm}}) {
      fmt::format_to(std::back_inserter(result.text),
                     "$/kinematics/MaslowKinematics/{}{}={:.2f}\n",
                     name(belt),
                     axis,
                     value);
    }
  }
  if (!fit.scale) {
    result.remarks.emplace_back(
        "Maslow_Scale_X and Maslow_Scale_Y stay as they are: no distance was taped, so nothing is "
        "known of the scale.");
    return result;
  }
  // Commands are multiplied by them, and then paid out in the belts' own millimetres.
  const double scale = 1.0 / fit.scale->factor;
  constexpr double kSeenSigmas = 2.0;
  const bool is_in_force = std::abs(fit.machine.scale_x - scale) < kSeenSigmas * fit.scale->sigma &&
                           std::abs(fit.machine.scale_y - scale) < kSeenSigmas * fit.scale->sigma;
  if (is_in_force) {
    result.remarks.push_back(
        fmt::format("Maslow_Scale_X and Maslow_Scale_Y stay as they are: the tape asks for {:.5f}, "
                    "give or take {:.5f}, and that is in force.",
                    scale,
                    fit.scale->sigma));
    return result;
  }
  for (const char axis : {'X', 'Y'}) {
    fmt::format_to(std::back_inserter(result.text), "$/Maslow_Scale_{}={:.5f}\n", axis, scale);
  }
  return result;
}

}  // namespace chaintrue::grid::files
