// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of four belts as a document for the terminal and for a browser.
#pragma once

#include <string_view>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/belts/point_indices.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The input of the fit; null if not available.
struct FittedBelts {
  const BeltsFit& fit;
  const grid::HolesWithBelts* holes = nullptr;
  /// The anchors' file has neither the taped distances nor the machine's message.
  const MeasuredBelts* belts = nullptr;
  grid::PointIndices indices{};  ///< of the points in their file
};

/// The agreement of the belts, the frame, the anchors, errors at left-out readings, the scale and
/// the tape. `name` is the belts', `source` the file's.
[[nodiscard]] Document anchors_document(const FittedBelts& fitted,
                                        std::string_view name,
                                        std::string_view source);

}  // namespace chaintrue::cli
