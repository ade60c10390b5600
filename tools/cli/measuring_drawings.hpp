// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Drawings of how to take a reading, for printed sheets. Each is one SVG with a title, without a
/// script; nothing in it is to scale.
#pragma once

#include <string>

namespace chaintrue::cli {

/// x and y of a mark from the sheet's middle lines, with a square.
[[nodiscard]] std::string draw_middle_lines();
/// A tape from hole to hole, its 100 mm mark at the first and its hook hanging free.
[[nodiscard]] std::string draw_tape_and_hook();
/// A chain from the pin at 12 o'clock to its end at the ring.
[[nodiscard]] std::string draw_chain_length();

}  // namespace chaintrue::cli
