// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The gain of naming: errors at held-out points and distances.
#pragma once

#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// A line of the table.
struct ImprovementRow {
  std::string_view what;
  const diagnosis::HeldOut* held_out = nullptr;
};
/// Rows point into the diagnosis. Precondition: it has a gain. Rows of an extension are left out
/// where nothing was named.
[[nodiscard]] std::vector<ImprovementRow> improvement_rows(const Diagnosis& diagnosis);
/// Distances were held out: no points were read, or too few.
[[nodiscard]] bool is_improvement_of_distances(const diagnosis::HeldOutImprovement& improvement);

/// Precondition: the diagnosis has a gain.
[[nodiscard]] Section improvement_section(const Diagnosis& found);
/// On the points of another grid. Precondition: there is one.
[[nodiscard]] Section transfer_section(const Diagnosis& found);
/// For both; empty if there is no gain.
[[nodiscard]] Light corrected_light(const Diagnosis& found);
[[nodiscard]] std::vector<Figure> figures_of_improvement(const Diagnosis& found);

}  // namespace chaintrue::cli
