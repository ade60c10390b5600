// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The user's file: a chaintrue_grid, composed by hand from the format's description.
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
  std::vector<HiddenMachine::Note> notes;
};
std::string grid_text(const WrittenGrid& grid);

}  // namespace chaintrue::generator
