// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A person who goes back and measures what the diagnosis asks for.
#pragma once

#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// Measures in the order of the list, diagnoses again once it is done, and so on until a single
/// cause stands or so many measurements are made.
[[nodiscard]] FollowUp follow_up(generator::SealedSet& set,
                                 grid::MeasuredGrid grid,
                                 grid::diagnosis::Diagnosis found,
                                 const grid::diagnosis::DiagnosisOptions& how,
                                 int measurements);

}  // namespace chaintrue::sealed
