// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The gain of naming: errors at held-out points and distances.
#pragma once

#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// A line of the table.
struct ImprovementRow {
  std::string_view what;
  const grid::diagnosis::HeldOut* held_out = nullptr;
};
/// Rows point into the diagnosis. Precondition: it has a gain. Rows of an extension are left out
/// where nothing was named.
[[nodiscard]] std::vector<ImprovementRow> improvement_rows(const grid::diagnosis::Diagnosis& diagnosis);
/// Distances were held out: no points were read, or too few.
[[nodiscard]] bool is_improvement_of_distances(const grid::diagnosis::HeldOutImprovement& improvement);

/// Precondition: the diagnosis has a gain.
[[nodiscard]] report::Section improvement_section(const grid::diagnosis::Diagnosis& found);
/// On the points of another grid. Precondition: there is one.
[[nodiscard]] report::Section transfer_section(const grid::diagnosis::Diagnosis& found);
/// For both; empty if there is no gain.
[[nodiscard]] report::Light corrected_light(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] std::vector<report::Figure> figures_of_improvement(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
