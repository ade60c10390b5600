// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/chain_rows.hpp"
#include "grid/diagnosis/periodogram.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {
namespace {

using grid::row_of;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::NormalPlot;
using grid::diagnosis::Periodogram;
using grid::diagnosis::PointPicture;
using grid::diagnosis::Removal;
using model::Side;
using report::Chart;
using report::DataTable;
using report::Paragraph;
using report::Section;
using report::Table;

/// From this chance down something is said to stand out.
constexpr double kSurprising = 0.01;

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

struct Series {
  std::vector<double> lengths_mm, before_mm, after_mm;
};

Series series_of(const Diagnosis& found, Side chain) {
  Series series;
  for (const PointPicture& point : found.points) {
    if (point.bad) continue;
    series.lengths_mm.push_back(point.lengths[chain]);
    series.before_mm.push_back(point.chain_before_mm[row_of(chain)]);
    series.after_mm.push_back(point.chain_after_mm[row_of(chain)]);
  }
  return series;
}

/// Just below a link: that of the link itself is among the periods.
double shortest_mm(const Diagnosis& found) {
  return 0.9 * found.extended_machine.sprocket.pitch_mm;
}

double turn_mm(const Diagnosis& found) {
  const model::Sprocket& sprocket = found.extended_machine.sprocket;
  return sprocket.teeth * sprocket.pitch_mm;
}

struct Waves {
  std::vector<double> periods_mm, before, after;
  double level = 0.0;
  [[nodiscard]] double highest(const std::vector<double>& power) const {
    return *std::max_element(power.begin(), power.end());
  }
};

Waves waves_of(const Diagnosis& found, const Series& series) {
  constexpr int kDraws = 499;
  const Periodogram periodogram(series.lengths_mm, shortest_mm(found));
  return {periodogram.periods_mm(),
          periodogram.power(series.before_mm),
          periodogram.power(series.after_mm),
          periodogram.level(kSurprising, kDraws, found.seed)};
}

/// The highest of each run of neighbouring periods: as many as a screen shows.
std::vector<std::size_t> runs(const Waves& waves) {
  constexpr double kRuns = 360.0;
  const double whole = std::log(waves.periods_mm.front() / waves.periods_mm.back());
  std::vector<std::size_t> chosen;
  long last = -1;
  for (std::size_t k = 0; k < waves.periods_mm.size(); ++k) {
    const long run =
        std::lround(kRuns * std::log(waves.periods_mm.front() / waves.periods_mm[k]) / whole);
    const auto height = [&](std::size_t i) { return std::max(waves.before[i], waves.after[i]); };
    if (run != last) {
      chosen.push_back(k);
    } else if (height(k) > height(chosen.back())) {
      chosen.back() = k;
    }
    last = run;
  }
  return chosen;
}

Chart waves_chart(const Diagnosis& found, const Waves& waves, Side chain) {
  const bool has_after = !found.causes.empty();
  Chart chart{.specification = "periodogram",
              .title = fmt::format("Waves along the {} chain", chain_name(chain)),
              .caption = chain == Side::left
                             ? "Noise alone crosses the broken line, anywhere, in 1 of 100 "
                               "sessions. Any smooth error shows as long waves."
                             : ""};
  DataTable table{"waves", {"period_mm", "before", "after"}, {}};
  double top = waves.level;
  for (const std::size_t k : runs(waves)) {
    const double after = has_after ? waves.after[k] : 0.0;
    table.rows.push_back({waves.periods_mm[k], waves.before[k], after});
    top = std::max({top, waves.before[k], after});
  }
  DataTable known{"known", {"period_mm", "what"}, {}};
  known.rows.push_back({found.extended_machine.sprocket.pitch_mm, std::string("a link")});
  known.rows.push_back({turn_mm(found), std::string("a turn")});
  chart.data = {std::move(table), std::move(known)};
  chart.signals = {{"shortest_mm", waves.periods_mm.back()},
                   {"longest_mm", waves.periods_mm.front()},
                   {"top", std::min(1.0, 1.12 * top)},
                   {"level", waves.level},
                   {"first_label", std::string("calibrated")},
                   {"second_label", std::string(has_after ? "with the cause" : "")},
                   {"first_color", std::string(report::kBeforeColor)},
                   {"second_color", std::string(report::kAfterColor)}};
  return chart;
}

/// What is left at the two periods that a sprocket and a link have, in a sentence.
std::string at_known_periods(const Diagnosis& found, const Series& series, Side chain) {
  const Periodogram periodogram(series.lengths_mm, shortest_mm(found));
  const auto part = [&](double period_mm) {
    const double power = periodogram.power_at(period_mm, series.after_mm);
    return std::pair(power, grid::diagnosis::chance_at_one_period(power, series.after_mm.size()));
  };
  const auto [turn, turn_chance] = part(turn_mm(found));
  const auto [link, link_chance] = part(found.extended_machine.sprocket.pitch_mm);
  return fmt::format(
      "What is left of the {} chain: a wave of one sprocket turn ({:g} mm) is {} of it (as much by "
      "chance: {}), one of a link ({:g} mm) {} ({}).",
      chain_name(chain),
      turn_mm(found),
      share_percent(turn),
      share_percent(turn_chance),
      found.extended_machine.sprocket.pitch_mm,
      share_percent(link),
      share_percent(link_chance));
}

std::string_view what_is_plotted(const Diagnosis& found) {
  switch (found.observations) {
    case grid::diagnosis::Observations::points:
      return "Both chains at every good point";
    case grid::diagnosis::Observations::distances:
      return "Every good distance";
    case grid::diagnosis::Observations::belts:
      return "Every good reading of a belt";
    case grid::diagnosis::Observations::drawing:
      return "Every good measure";
    case grid::diagnosis::Observations::both:
      break;
  }
  return "Both chains at every good point, and every good distance";
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

bool waves_can_be_sought(const Diagnosis& found) {
  constexpr std::size_t kFewestPoints = 16;
  for (const Side chain : model::kSides) {
    const Series series = series_of(found, chain);
    if (series.lengths_mm.size() < kFewestPoints) return false;
    const auto [low, high] =
        std::minmax_element(series.lengths_mm.begin(), series.lengths_mm.end());
    if (*high - *low <= turn_mm(found)) return false;
  }
  return true;
}

Section waves_section(const Diagnosis& found) {
  Section section{.title = "Waves along the chains", .is_folded = true};
  report::ChartRow row;
  for (const Side chain : model::kSides) {
    const Series series = series_of(found, chain);
    const Waves waves = waves_of(found, series);
    const bool stands_out =
        std::max(waves.highest(waves.before), waves.highest(waves.after)) > waves.level;
    if (stands_out) {
      row.charts.push_back(waves_chart(found, waves, chain));
    } else {
      section.blocks.emplace_back(Paragraph{fmt::format(
          "No wave of any length on the {} chain stands out from noise.", chain_name(chain))});
    }
    section.blocks.emplace_back(Paragraph{at_known_periods(found, series, chain)});
  }
  if (!row.charts.empty()) section.blocks.insert(section.blocks.begin(), std::move(row));
  return section;
}

Section normal_section(const Diagnosis& found) {
  const NormalPlot& plot = *found.normal_plot;
  const bool is_normal = plot.p_value >= kSurprising;
  Section section{.title = "Is what is left only noise?", .is_folded = is_normal};
  section.blocks.emplace_back(Paragraph{fmt::format(
      "{} Its size is {:.2f} times what you said the readings are good to.",
      is_normal ? fmt::format("What is left is spread as normal noise is (as odd by chance: {}).",
                              share_percent(plot.p_value))
                : fmt::format("What is left is not spread as normal noise is (by chance: {}): too "
                              "many large errors are slips or a few bad points; bounds and chances "
                              "on this page are then too small.",
                              share_percent(plot.p_value)),
      found.noise_factor)});
  Chart chart{
      .specification = "normal_plot",
      .title = "What is left, against normal noise",
      .caption = fmt::format(
          "{}, divided by their rms. In 95 of 100 sessions of noise all dots lie in the band.",
          what_is_plotted(found))};
  DataTable table{"quantiles", {"value", "expected", "low", "high"}, {}};
  double reach = 2.5;
  double expected = 2.0;
  for (std::size_t i = 0; i < plot.values.size(); ++i) {
    table.rows.push_back({plot.values[i], plot.expected[i], plot.low[i], plot.high[i]});
    reach =
        std::max({reach, std::abs(plot.values[i]), std::abs(plot.low[i]), std::abs(plot.high[i])});
  }
  chart.data = {std::move(table)};
  chart.signals = {{"reach", 1.05 * reach}, {"reach_of_noise", 1.05 * expected}};
  section.blocks.emplace_back(std::move(chart));
  return section;
}

}  // namespace chaintrue::cli
