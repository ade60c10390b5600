// SPDX-License-Identifier: GPL-3.0-or-later
// How sure the diagnosis is, what it gains and what the points can tell apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/effects/effect.hpp"
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_improvement.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::Hypothesis;
using report::Chart;
using report::DataTable;

namespace {

/// The surest that the bars show; the rest is below a percent.
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
                  "Each for itself: causes can act together, so these need not add up to 100 %. "
                  "Below 0.2 % is left out. Blue: what the verdict names."};
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
  const auto color_of = [&](const grid::diagnosis::HeldOut* row) {
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

Chart separation_chart(const Diagnosis& found) {
  Chart chart{
      .specification = "separation_matrix",
      .title =
          fmt::format("How much two causes look the same to these {}", name(found.observations)),
      .caption = fmt::format("0: nothing in common; 1: no number of such {} tells them apart.",
                             name(found.observations))};
  std::vector<std::string> names;
  const auto number_of = [&names](const std::string& what) {
    const auto at = std::find(names.begin(), names.end(), what);
    if (at != names.end()) return static_cast<double>(at - names.begin() + 1);
    names.push_back(what);
    return static_cast<double>(names.size());
  };
  DataTable cells{"cells", {"row", "column", "first", "second", "rho", "needed"}, {}};
  for (const auto& pair : found.separations) {
    const std::string first = cause_title(pair.first), second = cause_title(pair.second);
    const double a = number_of(first), b = number_of(second);
    const std::string needed = std::isfinite(pair.signal_to_noise_needed)
                                   ? fmt::format("{:.1f}", pair.signal_to_noise_needed)
                                   : "never";
    cells.rows.push_back({a, b, first, second, pair.collinearity, needed});
    cells.rows.push_back({b, a, second, first, pair.collinearity, needed});
  }
  DataTable list{"names", {"number", "what"}, {}};
  for (std::size_t i = 0; i < names.size(); ++i)
    list.rows.push_back({static_cast<double>(i + 1), names[i]});
  chart.data = {std::move(list), std::move(cells)};
  return chart;
}

}  // namespace chaintrue::cli
