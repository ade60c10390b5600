// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_budget.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/diagnosis/trend.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::BudgetLine;
using grid::diagnosis::Diagnosis;

std::string what_words(const BudgetLine& line) {
  switch (line.what) {
    case BudgetLine::What::settings:
      return "settings, and where the sheet lay";
    case BudgetLine::What::cause:
      return cause_title(*line.cause);
    case BudgetLine::What::unexplained:
      return "a pattern that no listed cause makes";
    case BudgetLine::What::noise:
      return "noise of the readings";
    case BudgetLine::What::inseparable:
      break;
  }
  return "in common, cannot be split";
}

std::string changes_words(const BudgetLine& line) {
  switch (line.changes_with) {
    case BudgetLine::ChangesWith::place:
      return "the place";
    case BudgetLine::ChangesWith::order:
      return "the order of the visits";
    case BudgetLine::ChangesWith::direction:
      return "the direction of the move";
    case BudgetLine::ChangesWith::nothing:
      break;
  }
  return "";
}

}  // namespace

std::vector<BudgetRow> budget_rows(const Diagnosis& found) {
  std::vector<BudgetRow> rows;
  if (!found.budget) return rows;
  for (const BudgetLine& line : found.budget->lines) {
    const bool is_a_part = line.what != BudgetLine::What::inseparable;
    rows.push_back({what_words(line),
                    is_a_part ? fmt::format("{:.2f}", std::sqrt(line.mean_square_mm2)) : "",
                    fmt::format("{:.0f} %", 100.0 * line.share + 0.0),
                    line.part_mm ? fmt::format("{:.2f}", *line.part_mm) : "",
                    changes_words(line)});
  }
  return rows;
}

std::string budget_words(const Diagnosis& found) {
  const bool of_distances = is_of_distances(found);
  return fmt::format(
      "As delivered the {} {:.2f} mm rms at these {}. The shares are of its square and add up; what "
      "two parts have in common at these {} belongs to neither.{}",
      of_distances ? "distances erred by" : "tool erred by",
      found.budget->as_delivered_mm,
      name(found.observations),
      name(found.observations),
      of_distances ? ""
                   : " The last column is how much a part of 100 mm comes out wrong in the worst "
                     "corner.");
}

report::Section budget_section(const Diagnosis& found) {
  report::Table table{{{"part"},
                       {"rms, mm", true},
                       {"share", true},
                       {"changes with"},
                       {"a part of 100 mm, mm", true}},
                      {},
                      budget_words(found)};
  for (BudgetRow& row : budget_rows(found)) {
    table.rows.push_back({{std::move(row.what),
                           std::move(row.rms_mm),
                           std::move(row.share),
                           std::move(row.changes_with),
                           std::move(row.part_mm)},
                          false});
  }
  return {"What the error is made of", {std::move(table)}};
}

std::vector<std::string> trend_in_words(const Diagnosis& found) {
  std::vector<std::string> lines;
  for (const auto& change : found.trend->changes) {
    lines.push_back(capitalised(grid::diagnosis::change_in_words(change)) + ".");
  }
  if (found.trend->changes.empty()) {
    lines.emplace_back("Neither diagnosis names a cause that both could test.");
  }
  if (found.trend->as_delivered_before_mm && found.trend->as_delivered_mm) {
    lines.push_back(fmt::format("The error as delivered is {:.2f} mm rms, before {:.2f} mm.",
                                *found.trend->as_delivered_mm,
                                *found.trend->as_delivered_before_mm));
  }
  return lines;
}

report::Section trend_section(const Diagnosis& found) {
  report::Section section{fmt::format("What changed since {}", found.trend->since), {}};
  for (std::string& line : trend_in_words(found)) {
    section.blocks.emplace_back(report::Paragraph{std::move(line)});
  }
  return section;
}

}  // namespace chaintrue::cli
