// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The columns that a diagnosis weighs, for other methods: settings calibrated without a cause and taken
/// out, every cause of the catalogue at every place, nothing rejected.
#pragma once

#include "grid/diagnosis/evidence.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "planted/judge/baselines.hpp"

namespace chaintrue::planted {

struct Prepared {
  grid::diagnosis::RegressorSystem system;
  grid::diagnosis::MarginalisedSystem marginalised;
};
/// \throws std::runtime_error in the words of the diagnosis if there is no such system.
[[nodiscard]] Prepared prepare(const grid::MeasuredGrid& grid);

[[nodiscard]] Regression regression_of(const Prepared& prepared);
/// Probabilities of the diagnosis' comparison where no smooth pattern is among the hypotheses. Each class has
/// the name of its first member.
[[nodiscard]] Scores scores_without_discrepancy(const Prepared& prepared);

}  // namespace chaintrue::planted
