// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Measures what the diagnosis proposes.
#pragma once

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"

namespace chaintrue::sealed {

/// Measures in the order of the list, repeats the diagnosis after each round, until a single cause remains or eight are
/// measured. \returns whether the right one remains.
bool follow_up(generator::SealedSet& set, grid::MeasuredGrid grid, grid::diagnosis::Diagnosis found,
               const grid::diagnosis::DiagnosisOptions& how);

}  // namespace chaintrue::sealed
