// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a diagnosis that are words and tables, of chains and of belts.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// What the error is made of. Precondition: the diagnosis has a budget.
[[nodiscard]] report::Section budget_section(const grid::diagnosis::Diagnosis& found);
/// What is named, with its size, probability and remedy. Precondition: a cause is named.
[[nodiscard]] report::Section causes_section(const grid::diagnosis::Diagnosis& found);
/// What the rest may be a function of. Precondition: some law is reported.
[[nodiscard]] report::Section laws_section(const grid::diagnosis::Diagnosis& found);
/// What a session says of each effect of the user's own. Precondition: there are some.
[[nodiscard]] report::Section declared_section(const grid::diagnosis::Diagnosis& found);
/// The next measurements, numbered. Precondition: there are some.
[[nodiscard]] report::Section next_section(const grid::diagnosis::Diagnosis& found);
/// Every hypothesis that is worth a line, and what is left over.
[[nodiscard]] report::Section probabilities_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section settings_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section outliers_section(const grid::diagnosis::Diagnosis& found);
/// What was looked for and is absent.
[[nodiscard]] report::Section bounds_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section not_testable_section(const grid::diagnosis::Diagnosis& found);
/// Assumptions, noise and corrections of the data.
[[nodiscard]] report::Section remarks_section(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
