// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a diagnosis that are pictures.
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/distance_charts.hpp"

namespace chaintrue::cli {

Section arrows_section(const Diagnosis& found) {
  if (is_of_distances(found)) return {"What it does to the distances", {distance_chart(found)}};
  Section section{"What it does to the tool", {}};
  for (ChartRow& row : arrow_charts(found)) section.blocks.emplace_back(std::move(row));
  if (!found.distances.empty()) section.blocks.emplace_back(distance_chart(found));
  return section;
}

Section signature_section(const Diagnosis& found) {
  Section section{"Why this cause", {}};
  section.blocks.emplace_back(
      Paragraph{"Measured errors next to the effect of the cause, both after refitting the "
                "settings. The cause is right if both pictures agree and only noise remains."});
  for (Chart& chart : strip_charts(found)) section.blocks.emplace_back(std::move(chart));
  if (!found.distances.empty()) section.blocks.emplace_back(distance_strip_chart(found));
  return section;
}

Section residuals_section(const Diagnosis& found) {
  Section section{"What the error follows", {}};
  if (is_of_distances(found)) {
    section.blocks.emplace_back(distance_scatter_charts(found));
    section.blocks.emplace_back(
        Paragraph{"Distances do not show the chain's length at a hole or the order of the holes, "
                  "so drift, skipped links and friction cannot be detected."});
    return section;
  }
  for (ChartRow& row : length_charts(found)) section.blocks.emplace_back(std::move(row));
  section.blocks.emplace_back(angle_charts(found));
  if (has_order(found)) {
    section.blocks.emplace_back(order_charts(found));
  } else {
    section.blocks.emplace_back(
        Paragraph{"The order in which the points were visited is not recorded, so drift, skipped "
                  "links and friction cannot be detected."});
  }
  if (!found.distances.empty()) section.blocks.emplace_back(distance_scatter_charts(found));
  return section;
}

}  // namespace chaintrue::cli
