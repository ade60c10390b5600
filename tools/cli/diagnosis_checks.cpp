// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/cli/diagnosis_words.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::PointPicture;
using grid::diagnosis::Removal;
using report::Chart;
using report::DataTable;
using report::Section;
using report::Table;

std::string left_out_name(const Diagnosis& found, const Removal& removal) {
  switch (removal.what) {
    case Removal::What::column:
      return fmt::format("column at x = {} mm", std::lround(removal.at_mm));
    case Removal::What::row:
      return fmt::format("row at y = {} mm", std::lround(removal.at_mm));
    case Removal::What::distance:
      return "distance " + words_of_ends(found.distances.at(removal.index));
    case Removal::What::hole:
      return fmt::format("hole {} with all its distances", found.holes.at(removal.index).name);
    case Removal::What::point:
      break;
  }
  return point_name(removal.index);
}

std::string verdict_without(const Removal& removal) {
  if (removal.stands) return "the same";
  if (removal.causes.empty()) return "nothing is named";
  std::string text;
  for (const auto& cause : removal.causes) {
    text += fmt::format("{}{}", text.empty() ? "" : "; ", cause_title(cause));
  }
  return text;
}

Chart support_chart(const Diagnosis& found) {
  Chart chart{.specification = "name_support",
              .title = "How much each point counts for the name",
              .caption =
                  "Blue: without the point the name would be less sure; vermilion: surer. Area: "
                  "natural logarithm of the change in its odds. A dark rim: without this point the "
                  "name would change."};
  constexpr std::size_t kLabels = 3;
  std::vector<const Removal*> points;
  for (const Removal& removal : found.stability->removals) {
    if (removal.what == Removal::What::point) points.push_back(&removal);
  }
  std::vector<const Removal*> heaviest = points;
  std::stable_sort(heaviest.begin(), heaviest.end(), [](const Removal* a, const Removal* b) {
    return a->support > b->support;
  });
  if (heaviest.size() > kLabels) heaviest.resize(kLabels);
  double largest = 0.0;
  std::map<std::size_t, const PointPicture*> pictures;
  for (const PointPicture& picture : found.points) pictures[picture.index] = &picture;
  DataTable table{
      "points", {"name", "label", "x_mm", "y_mm", "support", "stands", "text", "verdict"}, {}};
  std::vector<report::Arrow> marks;
  for (const Removal* removal : points) {
    const auto picture = pictures.find(removal->index);
    if (picture == pictures.end()) continue;
    const model::MarkPoint& mark = picture->second->mark;
    const bool is_labelled =
        !removal->stands || std::find(heaviest.begin(), heaviest.end(), removal) != heaviest.end();
    largest = std::max(largest, std::abs(removal->support));
    marks.push_back({.x_mm = mark.x_mm, .y_mm = mark.y_mm});
    table.rows.push_back({point_name(removal->index),
                          is_labelled ? fmt::format("{}", removal->index + 1) : std::string(),
                          mark.x_mm,
                          mark.y_mm,
                          removal->support,
                          removal->stands,
                          percent(removal->probability),
                          verdict_without(*removal)});
  }
  const model::Bed& bed = found.extended_machine.bed;
  chart.data = {std::move(table)};
  chart.signals = report::bed_signals(
      {-0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm}, marks);
  chart.signals.push_back({"largest", std::max(largest, 1e-6)});
  return chart;
}

Table removals_table(const Diagnosis& found) {
  constexpr std::size_t kShown = 8;
  std::vector<const Removal*> order;
  for (const Removal& removal : found.stability->removals) order.push_back(&removal);
  std::stable_sort(order.begin(), order.end(), [](const Removal* a, const Removal* b) {
    return a->stands != b->stands ? b->stands : a->support > b->support;
  });
  const auto changes =
      std::count_if(order.begin(), order.end(), [](const Removal* r) { return !r->stands; });
  order.resize(std::min(order.size(), kShown + static_cast<std::size_t>(changes)));
  Table table{{{"left out"},
               {std::string(name(found.observations)), true},
               {"probability then", true},
               {"its odds fall by a factor of", true},
               {"named then"}},
              {},
              fmt::format("With all {} it has {}. Shown: those that change the verdict, and the {} "
                          "others that count most.",
                          name(found.observations),
                          percent(found.stability->probability),
                          kShown)};
  for (const Removal* removal : order) {
    constexpr double kMost = 6.9;  // a thousand
    const double factor = std::exp(removal->support);
    table.rows.push_back({{left_out_name(found, *removal),
                           fmt::format("{}", removal->points),
                           percent(removal->probability),
                           removal->support > kMost ? std::string("above 1000")
                                                    : fixed(factor, factor < 10.0 ? 1 : 0),
                           verdict_without(*removal)},
                          !removal->stands});
  }
  return table;
}

}  // namespace

Section stability_section(const Diagnosis& found) {
  Section section{.title =
                      fmt::format("Does the name hang on a few {}?", name(found.observations))};
  section.blocks.emplace_back(removals_table(found));
  const auto& removals = found.stability->removals;
  // Distances have no place on the bed.
  if (std::any_of(removals.begin(), removals.end(), [](const Removal& removal) {
        return removal.what == Removal::What::point;
      })) {
    section.blocks.emplace_back(support_chart(found));
  }
  section.is_folded = std::all_of(
      removals.begin(), removals.end(), [](const Removal& removal) { return removal.stands; });
  return section;
}

}  // namespace chaintrue::cli
