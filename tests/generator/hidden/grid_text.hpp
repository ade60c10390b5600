// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the person writes down: a chaintrue_grid file, composed by hand from its description.
#pragma once

#include <string>
#include <vector>

#include "generator/hidden/draw.hpp"

namespace chaintrue::generator {

struct WrittenGrid {
  TrueMachine stated;
  StatedSigmas sigmas;
  NoiseLevel stated_noise;
  double dof = 12.0;
  bool with_order = true;
  std::vector<HiddenMachine::Note> notes;
};
[[nodiscard]] std::string grid_text(const WrittenGrid& grid);

}  // namespace chaintrue::generator
