// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What an owner is promised of the tool's error, rms and at worst, against what it is: today, with the
/// map, with numbers typed in, with the map that belongs to these, and along the cuts of a program that
/// the map compensates. Hidden machines, whose controller is GroundControl's, by its formulas written
/// here a second time; plotters by theirs.
///
/// \code
///   std::vector<PromisedRow> rows;
///   for (const PromisedSession& session : promised_sessions()) rows.push_back(promised_row(session, seed).value());
///   print(promised_table(rows));
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/map/error_summary.hpp"

namespace chaintrue::sealed {

/// A machine, and how it is measured.
struct PromisedSession {
  std::string_view machine;
  std::string_view way;
};
/// Chains that are worn, on a beam that bends, with settings three times as far off as usual: 28, 60 or
/// 117 marks with lengths read, or the list of start; four belts; and plotters with nothing hidden, of
/// which there is a promise along cuts alone.
[[nodiscard]] std::vector<PromisedSession> promised_sessions();

/// In the order of a row. Belts have no map apart from their anchors.
enum class Promise { today, map, typed, map_after, cuts };
inline constexpr std::size_t kPromises = 5;

struct Promised {
  grid::ErrorSummary stated;
  grid::ErrorSummary truth;
};

struct PromisedRow {
  PromisedSession session;
  std::array<std::optional<Promised>, kPromises> of;
};

/// Nothing where there is no map. \throws std::runtime_error where the hidden machine cannot be measured.
[[nodiscard]] std::optional<PromisedRow> promised_row(const PromisedSession& session, std::uint64_t seed);

/// Per machine, per way and pooled: rms of what is stated and of what is true, and the number of
/// sessions in which the largest error exceeds its stated bound.
[[nodiscard]] std::string promised_table(const std::vector<PromisedRow>& rows);

}  // namespace chaintrue::sealed
