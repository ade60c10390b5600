// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws at points all over the classic bed, the same in every run.
#pragma once

#include <gtest/gtest.h>

#include "model/kinematics.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::testing_support {

inline model::BedPoint on_the_bed(Random& random) {
  return {random.uniform(-1219.2, 1219.2), random.uniform(-609.6, 609.6)};
}

template <class Law>
void over_the_bed(std::uint64_t seed, int count, const Law& law) {
  Random random(seed);
  for (int n = 0; n < count; ++n) {
    const model::BedPoint p = on_the_bed(random);
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", (" << p.x_mm << ", " << p.y_mm << ")");
    law(p);
  }
}

}  // namespace chaintrue::testing_support
