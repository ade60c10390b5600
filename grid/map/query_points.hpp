// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Batch queries: each answer equals that of the point alone, to the last bit, or is its failure.
///
/// \code
///   const std::vector<model::MarkPoint> path = {{0.0, 0.0}, {10.0, 0.0}};
///   std::vector<MapAnswerOrFailure> answers(path.size());
///   query(map, path, answers);
///   for (const auto& answer : answers) if (answer) use(answer->lengths);
/// \endcode
#pragma once

#include <span>
#include <stdexcept>
#include <tl/expected.hpp>

#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid {

using MapAnswerOrFailure = tl::expected<MapAnswer, MapFailure>;
using MapLengthsOrFailure = tl::expected<MapLengths, MapFailure>;

/// answers[k] = map.query(marks[k]); nothing is allocated.
/// \throws std::invalid_argument if the spans differ in length.
inline void query(const CompensationMap& map, std::span<const MarkPoint> marks,
                  std::span<MapAnswerOrFailure> answers) {
  if (marks.size() != answers.size()) throw std::invalid_argument("an answer for each mark");
  for (const auto k : each_index(marks)) answers[k] = map.query(marks[k]);
}

/// Lengths and their derivative alone, some ten times faster (CompensationMap::lengths).
inline void lengths(const CompensationMap& map, std::span<const MarkPoint> marks,
                    std::span<MapLengthsOrFailure> answers) {
  if (marks.size() != answers.size()) throw std::invalid_argument("an answer for each mark");
  for (const auto k : each_index(marks)) answers[k] = map.lengths(marks[k]);
}

}  // namespace chaintrue::grid
