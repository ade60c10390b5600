// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the error is made of and what of it changed, in the words of the text and the page.
#pragma once

#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/page.hpp"

namespace chaintrue::cli {

/// A line of the table, as it is printed; empty where there is nothing to say.
struct BudgetRow {
  std::string what;
  std::string rms_mm;
  std::string share;
  std::string part_mm;
  std::string changes_with;
};
/// Largest first.
[[nodiscard]] std::vector<BudgetRow> budget_rows(const grid::diagnosis::Diagnosis& diagnosis);
/// What the columns mean, in a sentence or two.
[[nodiscard]] std::string budget_words(const grid::diagnosis::Diagnosis& diagnosis);
/// Precondition: the diagnosis has a budget.
[[nodiscard]] report::Section budget_section(const grid::diagnosis::Diagnosis& diagnosis);

/// A sentence a change. Precondition of both: an earlier diagnosis was given.
[[nodiscard]] std::vector<std::string> trend_in_words(const grid::diagnosis::Diagnosis& diagnosis);
[[nodiscard]] report::Section trend_section(const grid::diagnosis::Diagnosis& diagnosis);

}  // namespace chaintrue::cli
