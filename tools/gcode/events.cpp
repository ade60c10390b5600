// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names of events.
#include "tools/gcode/events.hpp"

namespace chaintrue::gcode {

std::string_view name(MoveKind kind) {
  constexpr std::string_view kNames[] = {"rapid", "feed", "arc", "probe"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace chaintrue::gcode
