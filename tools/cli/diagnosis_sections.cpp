// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_sections.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::BudgetLine;

/// Improbable hypotheses are not listed.
constexpr double kWorthALine = 0.001;

std::string what_words(const BudgetLine& line) {
  constexpr std::string_view kWords[] = {"settings, and position of the sheet", "",
                                         "a pattern that no listed cause explains",
                                         "remaining in these readings"};  // by What
  if (line.what == BudgetLine::What::cause) return cause_title(*line.cause);
  return std::string(kWords[as_size(line.what)]);
}

std::string_view changes_words(const BudgetLine& line) {
  constexpr std::string_view kWords[] = {"", "the place", "the order of the visits",
                                         "the direction of the move"};  // by ChangesWith
  return kWords[as_size(line.changes_with)];
}

std::string budget_words(const Diagnosis& found) {
  const bool of_distances = is_of_distances(found);
  const std::string today = found.tool_today
                                ? fmt::format("The error over the measured part is {} mm. ",
                                              about_mm(found.tool_today->rms_mm))
                                : "";
  return fmt::format(
      "{}The parts are computed at these {} only: there the {} {:.2f} mm rms, uncorrected. The "
      "second number is the error without this part.{}",
      today, name(found.observations), of_distances ? "distances erred by" : "tool erred by",
      found.budget->uncalibrated_mm,
      of_distances ? "" : " A part of 100 mm: its error in the worst corner.");
}

}  // namespace

Section budget_section(const Diagnosis& found) {
  Table table{.columns = {{.page_heading = "part", .width = 38},
                          number_column("rms, mm", 8),
                          {.heading = "without it",
                           .is_number = true,
                           .page_heading = "rms without it, mm",
                           .width = 12},
                          {.heading = "part of 100 mm",
                           .is_number = true,
                           .page_heading = "a part of 100 mm, mm",
                           .width = 16},
                          {.heading = "changes with", .gap = 3}}};
  for (const BudgetLine& line : found.budget->lines) {
    // The common part of two is not a separate part, and may be negative.
    if (line.what == BudgetLine::What::inseparable) continue;
    table.add({what_words(line), std::sqrt(line.mean_square_mm2), line.without_mm, line.part_mm,
               changes_words(line)});
  }
  return {"What the error is made of", {std::move(table), Paragraph{budget_words(found)}}};
}

Section causes_section(const Diagnosis& found) {
  List list;
  for (const Cause& cause : found.causes) {
    Item& item = list.items.emplace_back(
        Item{fmt::format("{}: {}  (probability {}{})", cause_title(cause.cause),
                         sizes_in_words(cause.cause, cause.parameters), percent(cause.probability),
                         cause.order_assumed ? ", order of visits assumed" : "")});
    item.items = {{std::string(cause.cause.effect->cause)},
                  {fmt::format("remedy: {}", cause.cause.effect->remedy)}};
    for (const auto& same : cause.same_as) {
      item.items.push_back(
          {fmt::format("no {} can distinguish it from {}: {}", name(found.observations),
                       cause_title(same.cause), sizes_in_words(same.cause, same.parameters)),
           {{fmt::format("remedy: {}", same.cause.effect->remedy)}}});
    }
  }
  Section section{found.verdict == Verdict::named_set ? "One of these causes"
                  : found.causes.size() > 1           ? "Causes"
                                                      : "Cause",
                  {std::move(list)}};
  if (auto charts = cause_charts(found); !charts.empty())
    section.blocks.emplace_back(ChartRow{std::move(charts)});
  return section;
}

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

Chart probability_chart(const Diagnosis& found) {
  Chart chart{.specification = "probability_bars",
              .title = "How probable each explanation is",
              .caption =
                  "Causes can act together, so the probabilities need not add up to 100 %. Those "
                  "below 0.2 % are omitted. Blue: named by the verdict."};
  DataTable table{"hypotheses", {"what", "probability", "text", "is_named"}};
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

}  // namespace

Section probabilities_section(const Diagnosis& found) {
  Table table{.columns = {{.is_number = true, .width = 13}, {.gap = 2}}};
  for (const auto& hypothesis : found.hypotheses) {
    if (hypothesis.probability < kWorthALine) continue;
    table.add({percent(hypothesis.probability), hypothesis_title(hypothesis)});
  }
  Chart chart = probability_chart(found);
  chart.alternative = std::move(table);
  Section section{"Separate probabilities: causes can act together", {std::move(chart)}};
  if (!found.belts && !found.drawing) section.say(left_over_sentence(found.left_over));
  return section;
}

namespace {

using diagnosis::Removal;

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

Table removals_table(const Diagnosis& found) {
  constexpr std::size_t kShown = 8;
  std::vector<const Removal*> order;
  for (const Removal& removal : found.stability->removals) order.push_back(&removal);
  grid::stable_sort(order, [](const Removal* a, const Removal* b) {
    return a->stands != b->stands ? b->stands : a->support > b->support;
  });
  const std::size_t changes = count_where(order, [](const Removal* r) { return !r->stands; });
  order.resize(std::min(order.size(), kShown + changes));
  Table table{{{"left out"},
               {std::string(name(found.observations)), true},
               {"probability then", true},
               {"odds reduced by a factor of", true},
               {"named then"}},
              {},
              fmt::format("With all {} its probability is {}. Shown: those that change the "
                          "verdict, and the {} other most influential ones.",
                          name(found.observations), percent(found.stability->probability), kShown)};
  for (const Removal* removal : order) {
    constexpr double kMost = 6.9;  // a thousand
    const double factor = std::exp(removal->support);
    table.add({left_out_name(found, *removal), fmt::format("{}", removal->points),
               percent(removal->probability),
               removal->support > kMost ? std::string("above 1000")
                                        : fixed(factor, factor < 10.0 ? 1 : 0),
               verdict_without(*removal)},
              !removal->stands);
  }
  return table;
}

}  // namespace

Section stability_section(const Diagnosis& found) {
  Section section{.title =
                      fmt::format("Does the name depend on a few {}?", name(found.observations))};
  section.blocks.emplace_back(removals_table(found));
  const auto& removals = found.stability->removals;
  section.is_folded = all_of(removals, &Removal::stands);
  return section;
}

}  // namespace chaintrue::cli
