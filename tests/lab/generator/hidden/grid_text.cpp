// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/grid_text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace chaintrue::generator {

std::string grid_text(const WrittenGrid& g) {
  const TrueMachine& m = g.stated;
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 R"({{"file_type": "chaintrue_grid", "format_version": "1.0", "name": "sealed",
 "machine": {{"file_type": "chaintrue_machine", "format_version": "1.0", "name": "sealed",
  "bed": {{"width_mm": 2438.4, "height_mm": 1219.2}},
  "motors": {{"left": {{"x_mm": {}, "y_mm": {}}}, "right": {{"x_mm": {}, "y_mm": {}}}}},
  "sprocket": {{"teeth": {}, "pitch_mm": {}}},
  "feed": "{}",
  "attachment": {{"kind": "ring", "radius_mm": {}}},
  "chain": {{"mass_kg_per_m": {}, "compliance_per_n": {}}},
  "chain_zero": {{"left_mm": {}, "right_mm": {}}},
  "sled": {{"mass_kg": {}}},
  "frame": {{"tilt_from_vertical_deg": {}}},
  "uncertainty": {{"motor_position_mm": {}, "chain_zero_mm": {}, "ring_radius_mm": 1}}}},
 "noise": {{"length_mm": {:.6g}, "position_mm": {:.6g}, "dof": {}}},
 "points": [
)",
                 m.axis[0].x, m.axis[0].y, m.axis[1].x, m.axis[1].y, m.teeth, m.pitch_mm,
                 m.over_top ? "over_top" : "off_bottom", m.ring_radius_mm, m.chain_mass_kg_per_m,
                 m.compliance_per_n, m.chain_zero_mm[0], m.chain_zero_mm[1], m.sled_mass_kg,
                 m.tilt_from_vertical_deg, g.sigmas.motor_mm, g.sigmas.zero_mm,
                 g.stated_noise.length_mm, g.stated_noise.position_mm, g.dof);
  for (std::size_t i = 0; i < g.notes.size(); ++i) {
    const HiddenMachine::Note& n = g.notes[i];
    fmt::format_to(
        out,
        R"(  {{"x_mm": {:.4f}, "y_mm": {:.4f}, "left_mm": {:.4f}, "right_mm": {:.4f}, "order": {})",
        n.mark.x, n.mark.y, n.lengths[0], n.lengths[1], n.number);
    text += i + 1 < g.notes.size() ? "},\n" : "}\n";
  }
  text += " ]}\n";
  return text;
}

}  // namespace chaintrue::generator
