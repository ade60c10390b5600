// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An order of visits that was not recorded, estimated from the readings.
#pragma once

#include <string>

#include "grid/observation/visiting_order.hpp"

namespace chaintrue::grid::diagnosis {

struct VisitingOrderFound {
  VisitingOrder order;  ///< the likeliest
  /// Probability of this order; if the corner is unknown, of its lines and direction from any
  /// corner.
  double probability = 0.0;
  bool corner_known = true;
};

/// "Nobody wrote down in which order the marks were visited. The readings say it: ... (99.8 %). ..." With the name of
/// a session "the marks of C.json".
[[nodiscard]] std::string in_words(const VisitingOrderFound& found, const std::string& session = {});

}  // namespace chaintrue::grid::diagnosis
