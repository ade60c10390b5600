// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The answers of chaintrue query as a table and as JSON, for maps of either kind.
#pragma once

#include <string>
#include <vector>

#include "grid/map/length_map.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// A map of either kind.
struct AskedMap {
  const grid::LengthMap& map;
  int digits = 6;  ///< of lengths
  /// The names of the first two lengths in messages.
  const char* first = "left";
  const char* second = "right";
  /// Replaces the map's reason why a point has no answer; empty: the map's.
  std::string no_answer = {};
};

/// One line of the answer; missing numbers are empty cells, or omitted.
struct AnswerLine {
  BedPoint point;
  tl::expected<grid::LengthsAnswer, grid::MapFailure> answer;
};

[[nodiscard]] std::string as_csv(const AskedMap& asked, const std::vector<AnswerLine>& lines);
[[nodiscard]] std::string as_json(const AskedMap& asked, const std::vector<AnswerLine>& lines);

}  // namespace chaintrue::cli
