// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Causes as effects of a machine; a cause whose place is uncertain is spread over its possible
/// places. Private to grid/diagnosis.
#pragma once

#include <vector>

#include "grid/diagnosis/causes_fit.hpp"

namespace chaintrue::grid::diagnosis {

struct ActingCause {
  Cause cause;
  std::vector<model::AppliedEffect> effects;
};
[[nodiscard]] std::vector<ActingCause> over_places(const std::vector<Cause>& causes);

/// Its place, if a step or bend depends on it and it is uncertain; else null.
[[nodiscard]] const ParameterEstimate* unsure_place(const Cause& cause);

/// A share of the cause, and the distance of its place from the likeliest.
[[nodiscard]] model::AppliedEffect applied_at(const Cause& cause,
                                              const ParameterEstimate& place,
                                              double off,
                                              double share);

/// Readings of machines on which the causes act. Effects at a visit apply to the session whose
/// visits were analysed: the first with an order.
[[nodiscard]] Measured with_effects(const Measured& measured,
                                    const std::vector<ActingCause>& causes);

}  // namespace chaintrue::grid::diagnosis
