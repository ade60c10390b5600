// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of four belts as a document for the terminal and for a browser.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/belts/belts_error.hpp"
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
Document anchors_document(const FittedBelts& fitted, std::string_view name,
                          std::string_view source);

/// The machine's error, today and with these anchors.
std::string headline_of(const BeltsFit& fit, const std::optional<BeltsError>& error);
/// Why these anchors must not be pasted: their error exceeds kMostToCutWithMm or, if it is unknown,
/// their uncertainty does. Otherwise empty.
std::string not_to_paste(const BeltsFit& fit, const std::optional<BeltsError>& error);

/// The least certain anchors, the causes, the error of one belt's reading, and the machine's figure
/// for it.
Section agreement_section(const FittedBelts& fitted, const std::optional<BeltsError>& error);
/// Errors at left-out readings, rejected readings, the scale and the holes.
Section tests_section(const FittedBelts& fitted);

}  // namespace chaintrue::cli
