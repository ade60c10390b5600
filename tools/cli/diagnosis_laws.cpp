// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The section of a diagnosis on laws: variables of the part that no listed cause explains.
#include <fmt/format.h>

#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::Law;

/// Hints are worded as hints, and not given for a law that is only possible.
std::vector<Item> details_of(const Law& law, const Diagnosis& found) {
  std::vector<Item> details;
  if (law.probability < diagnosis::kLawLikely) return details;
  details.push_back({fmt::format("on average it {}: {} of the residual of the {}",
                                 average_in_words(law, found.observations),
                                 diagnosis::percent(law.share),
                                 found.belts ? "anchors" : "settings")});
  if (law.held_out) {
    const auto& [inside, outside] = *law.held_out;
    details.push_back(
        {fmt::format("every fourth place left out: predicted to {:.2f} mm with the law, {:.2f} "
                     "without; a quarter of the bed left out: {:.2f} with it, {:.2f} without",
                     inside.with_mm,
                     inside.without_mm,
                     outside.with_mm,
                     outside.without_mm)});
  }
  if (law.shape_probability < diagnosis::kLawClaimed) {
    details.push_back({fmt::format("probability of this shape: {}",
                                   diagnosis::percent(law.shape_probability))});
  }
  const std::vector<std::string> hints = found.belts
                                             ? diagnosis::hints_of(law, found.belts->machine)
                                             : diagnosis::hints_of(law, found.extended_machine);
  for (const std::string& hint : hints) details.push_back({"a hint: " + hint});
  return details;
}

}  // namespace

Section laws_section(const Diagnosis& found) {
  const std::vector<Law>& laws = found.unexplained->laws;
  List list;
  for (const Law& law : laws) {
    Item& item = list.items.emplace_back(Item{
        fmt::format("{}: {}", capitalised(in_words(law)), diagnosis::percent(law.probability))});
    item.items = details_of(law, found);
  }
  Section section{"What the remaining error may depend on", {std::move(list)}};
  if (!laws.front().points.empty()) {
    section.blocks.emplace_back(law_charts(found));
    if (!found.points.empty())
      for (ChartRow& row : law_rest_charts(found)) section.blocks.emplace_back(std::move(row));
  }
  const bool is_claimed = laws.front().probability >= diagnosis::kLawClaimed;
  section.blocks.emplace_back(
      Paragraph{is_claimed && found.belts ? "No listed cause explains this."
                : is_claimed ? "No listed cause explains this. --law writes it as a declared "
                               "cause, to be named, edited and used with --effects."
                             : fmt::format("These {} do not show which of these acts, if any.",
                                           name(found.observations))});
  return section;
}

Section declared_section(const Diagnosis& found) {
  using Says = diagnosis::DeclaredAnswer::Says;
  Table table{{{.width = 34}, {}, {.gap = 2}}, {}, ""};
  for (const auto& [cause, says, probability] : found.declared) {
    const char* words = says == Says::confirmed ? "confirmed: it acts here"
                        : says == Says::denied
                            ? "denied: with the values in the file it would have shown"
                        : says == Says::open ? "left open: measure more points"
                                             : "not testable with these readings";
    table.rows.push_back(
        {{cause_title(cause),
          words,
          says == Says::not_testable ? Cell{} : Cell(diagnosis::percent(probability))}});
  }
  return {"Declared effects", {std::move(table)}};
}

}  // namespace chaintrue::cli
