// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A frame as stated, and the true one.
#pragma once

#include "model/belts/belt_machine.hpp"

namespace chaintrue::testing_support {

inline model::BeltMachine stated() {
  model::BeltMachine machine;
  machine.anchors_known = true;
  machine.anchors = {
      {-27.6, 2064.9, 100.0}, {2924.3, 2066.5, 56.0}, {0.0, 0.0, 34.0}, {2953.2, 0.0, 78.0}};
  return machine;
}

inline model::BeltMachine truth() {
  model::BeltMachine machine = stated();
  machine.anchors.tl.x_mm += 12.0;
  machine.anchors.br.x_mm -= 9.0;
  return machine;
}

}  // namespace chaintrue::testing_support
