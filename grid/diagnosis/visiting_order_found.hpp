// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An order of visits that nobody wrote down, found from the readings.
#pragma once

#include <string>

#include "grid/observation/visiting_order.hpp"

namespace chaintrue::grid::diagnosis {

struct VisitingOrderFound {
  VisitingOrder order;  ///< the likeliest
  /// Of this order; where the corner is not known, of its lines and way from any corner.
  double probability = 0.0;
  bool corner_known = true;
};

/// "Nobody wrote down in which order the marks were visited; the readings say: ... (99.8 %)."
[[nodiscard]] std::string in_words(const VisitingOrderFound& found);

}  // namespace chaintrue::grid::diagnosis
