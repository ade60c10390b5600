// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Causes as effects of a machine, a cause whose place is not sure spread over the places where it may stand.
/// Private to grid/diagnosis.
#pragma once

#include <vector>

#include "grid/diagnosis/causes_fit.hpp"

namespace chaintrue::grid::diagnosis {

struct ActingCause {
  Cause cause;
  std::vector<model::AppliedEffect> effects;
};
[[nodiscard]] std::vector<ActingCause> over_places(const std::vector<Cause>& causes);

/// Its place, where a step or a bend depends on it and it is not sure; else null.
[[nodiscard]] const ParameterEstimate* unsure_place(const Cause& cause);

/// So much of the cause, its place so far from the likeliest.
[[nodiscard]] model::AppliedEffect applied_at(const Cause& cause,
                                              const ParameterEstimate& place,
                                              double off,
                                              double share);

/// Readings of machines on which the causes act.
/// What happened at a visit happened in the one session whose visits were weighed: the first with an
/// order.
[[nodiscard]] Measured with_effects(const Measured& measured,
                                    const std::vector<ActingCause>& causes);

}  // namespace chaintrue::grid::diagnosis
