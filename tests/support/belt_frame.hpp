// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A frame of four belts as stated, the true one, and sessions of it.
#pragma once

#include "grid/synthetic/simulated_belts.hpp"

namespace chaintrue::testing_support {

inline model::BeltMachine stated(model::BeltLengths lengths = model::BeltLengths::span) {
  model::BeltMachine machine;
  machine.anchors_known = true;
  machine.lengths = lengths;
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

inline grid::MeasuredBelts belts_session(const grid::synthetic::BeltsSpec& spec,
                                         const model::BeltMachine& actual = truth()) {
  return grid::synthetic::simulate_belts(stated(), actual, spec).value();
}

}  // namespace chaintrue::testing_support
