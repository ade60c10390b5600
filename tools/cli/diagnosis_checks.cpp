// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::cli {
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
  const auto changes =
      std::count_if(order.begin(), order.end(), [](const Removal* r) { return !r->stands; });
  order.resize(std::min(order.size(), kShown + static_cast<std::size_t>(changes)));
  Table table{{{"left out"},
               {std::string(name(found.observations)), true},
               {"probability then", true},
               {"odds reduced by a factor of", true},
               {"named then"}},
              {},
              fmt::format("With all {} its probability is {}. Shown: those that change the "
                          "verdict, and the {} other most influential ones.",
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
                      fmt::format("Does the name depend on a few {}?", name(found.observations))};
  section.blocks.emplace_back(removals_table(found));
  const auto& removals = found.stability->removals;
  section.is_folded = grid::all_of(removals, [](const Removal& removal) { return removal.stands; });
  return section;
}

}  // namespace chaintrue::cli
