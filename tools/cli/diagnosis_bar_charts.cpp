// SPDX-License-Identifier: GPL-3.0-or-later
// The diagnosis' certainty and gain.
#include <fmt/format.h>

#include <algorithm>

#include "model/effects/effect.hpp"
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_improvement.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {

using diagnosis::Hypothesis;

namespace {

/// The likeliest ones are shown; the rest is below one per cent.
std::vector<Hypothesis> likeliest_hypotheses(const Diagnosis& found) {
  constexpr double kLeast = 0.002;
  constexpr std::size_t kMost = 12;
  std::vector<Hypothesis> leading;
  for (const Hypothesis& hypothesis : found.hypotheses) {
    if (leading.size() < kMost && (hypothesis.probability >= kLeast || leading.empty()))
      leading.push_back(hypothesis);
  }
  return leading;
}

}  // namespace

Chart probability_chart(const Diagnosis& found) {
  Chart chart{.specification = "probability_bars",
              .title = "How probable each explanation is",
              .caption =
                  "Causes can act together, so the probabilities need not add up to 100 %. Those "
                  "below 0.2 % are omitted. Blue: named by the verdict."};
  DataTable table{"hypotheses", {"what", "probability", "text", "is_named"}, {}};
  for (const Hypothesis& hypothesis : likeliest_hypotheses(found)) {
    std::string what = hypothesis_title(hypothesis);
    bool is_named = false;
    for (const auto& cause : found.causes) {
      if (cause.cause.effect->id != hypothesis.effect || name(cause.cause.side) != hypothesis.side)
        continue;
      is_named = true;
      for (const auto& same : cause.same_as) what += fmt::format(" = {}", cause_title(same.cause));
    }
    table.rows.push_back({what, hypothesis.probability, percent(hypothesis.probability), is_named});
  }
  chart.data.push_back(std::move(table));
  return chart;
}

Chart improvement_chart(const Diagnosis& found) {
  Chart chart{.specification = "gain_bars",
              .title = is_improvement_of_distances(*found.improvement)
                           ? "Error of distances left out, rms"
                           : "Error of the tool at points left out, rms",
              .caption = "The thin line on a bar is its 90 % interval. Left out: " +
                         found.improvement->scheme + "."};
  DataTable table{"rows", {"what", "rms_mm", "low_mm", "high_mm", "most_mm", "color"}, {}};
  const auto color_of = [&](const diagnosis::HeldOut* row) {
    if (row == &found.improvement->extended || row == &found.improvement->extended_and_surface)
      return report::kAfterColor;
    return row == &found.improvement->surface_only ? report::kNeutralColor : report::kBeforeColor;
  };
  for (const ImprovementRow& row : improvement_rows(found)) {
    table.rows.push_back({std::string(row.what),
                          row.held_out->rms_mm,
                          row.held_out->low_mm,
                          row.held_out->high_mm,
                          row.held_out->percentile_95_mm,
                          std::string(color_of(row.held_out))});
  }
  chart.data.push_back(std::move(table));
  chart.signals = {{"floor_mm", found.improvement->noise_floor_mm}};
  return chart;
}

}  // namespace chaintrue::cli
