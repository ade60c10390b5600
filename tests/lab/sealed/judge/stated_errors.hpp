// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stated errors of maps against the true ones: hidden machines, each with one effect of the
/// catalogue at its usual size or with none, measured in the ways and layouts of docs. Chain
/// lengths are read at 28, 60 or 117 marks with six second visits; distances are taped between nine
/// holes, where the effect is one that holes can have.
///
/// \code
///   for (const std::string& kind : stated_kinds()) rows.push_back(stated_row(kind, 0));
///   print(stated_table(rows));
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sealed/judge/map_errors.hpp"

namespace chaintrue::sealed {

/// One machine with the plain map of its readings and the map on the causes that are found.
struct StatedRow {
  std::string kind;
  std::string way;  ///< 28, 60, 117 or holes
  int machine = 0;
  bool is_built = false;  ///< on causes
  MapErrors plain;
  MapErrors own;  ///< no places in both: one of the fits failed
};

/// Effects of the catalogue, "nothing", and holes alone with a tape whose zero is off by so much
/// ("tape_zero_5") or stated to be known exactly.
[[nodiscard]] std::vector<std::string> stated_kinds();
/// Machine k of a kind. \throws std::runtime_error if the hidden machine cannot be measured.
[[nodiscard]] StatedRow stated_row(const std::string& kind, int k);

/// The row of a set of chains at points.
[[nodiscard]] StatedRow row_of_set(std::string kind, const generator::SealedSet& set);

/// A line of a file of rows, and back; nothing where the line is none.
[[nodiscard]] std::string line_of(const StatedRow& row);
[[nodiscard]] std::optional<StatedRow> row_of(std::string_view line);

/// Per kind (those of stated_kinds() first), per way and pooled: rms of the true over rms of the
/// stated errors, and the coverage of the 95 % intervals.
[[nodiscard]] std::string stated_table(const std::vector<StatedRow>& rows);

}  // namespace chaintrue::sealed
