// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Units that are held out together where a gain is measured.
#pragma once

#include <cstddef>
#include <vector>

#include "grid/diagnosis/observations.hpp"

namespace chaintrue::grid::diagnosis {

/// Units held out together, and what they are.
struct HeldOutBlocks {
  std::vector<std::vector<std::size_t>> units;  ///< empty where there are too few units
  bool of_the_bed = false;                      ///< or each hole with all distances that end there
};

/// What is held out tells of the tool where chains were read at marks enough, else of distances.
[[nodiscard]] HeldOutBlocks held_out_blocks(const ObservationSet& session);

}  // namespace chaintrue::grid::diagnosis
