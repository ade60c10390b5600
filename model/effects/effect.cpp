// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/effects/effect.hpp"

#include <array>
#include <cstddef>

namespace chaintrue::model::effects {
namespace {

template <class Enum, std::size_t Count>
std::string_view word(Enum value, const std::array<std::string_view, Count>& words) {
  return words.at(static_cast<std::size_t>(value));
}

}  // namespace

std::string_view name(Station station) {
  return word(station, std::array<std::string_view, 4>{"paper", "machine", "chain", "reading"});
}

std::string_view name(EffectSide side) {
  return word(side, std::array<std::string_view, 11>{"", "left", "right", "both", "x", "y", "tl",
                                                     "tr", "bl", "br", "all"});
}

std::string_view name(RemedyKind kind) {
  return word(kind, std::array<std::string_view, 4>{"change the machine", "correct the data",
                                                    "repair", "compensate on its own"});
}

std::string_view name(DataNeed need) {
  return word(need, std::array<std::string_view, 2>{"positions", "positions and order"});
}

std::string_view name(Part part) {
  return word(part, std::array<std::string_view, 5>{"", "a sled on a ring (\"kind\": \"ring\")",
                                                    "a sled on brackets (\"kind\": \"brackets\")",
                                                    "a gondola that two points hold",
                                                    "a pulley or spool with its radius"});
}

LengthState chain_at_rest(const Pose& pose, Side side, const Sprocket& sprocket) {
  const ChainState& chain = pose.chains[side];
  return {.angle_rad = variable(chain.angle_rad, kAngle),
          .free_mm = variable(chain.free_length_mm, kFree),
          .length_mm = variable(pose.lengths[side], kLength),
          .tension = variable(chain.tension_at_sprocket_n, kTension),
          .horizontal_n = variable(chain.horizontal_n, kHorizontal),
          .x_mm = variable(pose.position.x_mm, kX),
          .y_mm = variable(pose.position.y_mm, kY),
          .turn_mm = sprocket.teeth * sprocket.pitch_mm,
          .tooth_mm = sprocket.pitch_mm,
          .side = side == Side::left ? 1.0 : -1.0};
}

EffectSide mirrored(EffectSide side) {
  switch (side) {
    case EffectSide::left:
      return EffectSide::right;
    case EffectSide::right:
      return EffectSide::left;
    default:
      return side;
  }
}

bool acts_on(EffectSide effect_side, Side chain) {
  switch (effect_side) {
    case EffectSide::none:
    case EffectSide::both:
      return true;
    case EffectSide::left:
      return chain == Side::left;
    case EffectSide::right:
      return chain == Side::right;
    default:
      return false;
  }
}

}  // namespace chaintrue::model::effects
