// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A diagnosis like that of a 7 x 4 grid, from made-up numbers: every list has an entry, every
/// optional part is present (fixtures/good/diagnosis_sample.json).
#pragma once

#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::testing {

/// A left chain 0.12 % long, distinguished from its rival, two settings off, one bad point.
diagnosis::Diagnosis sample_diagnosis();
/// Nothing found, without gain, next measurements, order or bad points.
diagnosis::Diagnosis quiet_diagnosis();

inline constexpr int kSamplePoints = 28;

}  // namespace chaintrue::grid::testing
