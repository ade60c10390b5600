// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Simulated sessions on the default machine with hidden effects, and the options of a diagnosis
/// that computes the verdict only.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/synthetic/generator.hpp"

namespace chaintrue::grid::diagnosis::testing_support {

/// Random order, six repeated visits, 0.2 mm for a chain and 0.3 mm for a mark, as stated.
inline MeasuredGrid session_of(const std::vector<model::AppliedEffect>& hidden,
                               std::uint64_t seed,
                               int columns = 7,
                               int rows = 4,
                               const model::Machine& machine = {}) {
  synthetic::SyntheticSpec spec;
  spec.design.columns = columns;
  spec.design.rows = rows;
  spec.order = synthetic::VisitingOrder::random;
  spec.repeats = 6;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
  spec.stated = StatedNoise{0.2, 0.3, 12.0};
  spec.hidden = hidden;
  spec.seed = seed;
  return synthetic::generate(machine, spec).value().grid;
}

inline DiagnosisOptions verdict_alone() {
  DiagnosisOptions options;
  options.improvement = false;
  options.next_measurements = false;
  return options;
}

}  // namespace chaintrue::grid::diagnosis::testing_support
