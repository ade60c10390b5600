// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Simulated sessions on the default machine with hidden effects, and the options of a diagnosis
/// that computes the verdict only.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/synthetic/generator.hpp"

namespace chaintrue::grid::diagnosis::testing_support {

/// 7 x 4 marks in random order, six repeated visits, 0.2 mm for a chain and 0.3 mm for a mark, as
/// stated; times `noise`.
inline synthetic::SyntheticSpec usual_session(std::uint64_t seed,
                                              const std::vector<model::AppliedEffect>& hidden = {},
                                              double noise = 1.0) {
  synthetic::SyntheticSpec spec;
  spec.order = synthetic::VisitingOrder::random;
  spec.repeats = 6;
  spec.noise = {.length_mm = 0.2 * noise, .position_mm = 0.3 * noise};
  spec.stated = StatedNoise{0.2 * noise, 0.3 * noise, 12.0};
  spec.hidden = hidden;
  spec.seed = seed;
  return spec;
}

inline MeasuredGrid session_of(const std::vector<model::AppliedEffect>& hidden, std::uint64_t seed,
                               int columns = 7, int rows = 4, const model::Machine& machine = {}) {
  synthetic::SyntheticSpec spec = usual_session(seed, hidden);
  spec.design.columns = columns;
  spec.design.rows = rows;
  return synthetic::generate(machine, spec).value().grid;
}

inline DiagnosisOptions verdict_alone() {
  DiagnosisOptions options;
  options.improvement = false;
  options.next_measurements = false;
  return options;
}

inline Analysis analysis_of(const Measured& measured,
                            const DiagnosisOptions& options = verdict_alone()) {
  return analyse(observations_of(measured).value(), options).value();
}

}  // namespace chaintrue::grid::diagnosis::testing_support
