// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a diagnosis that are words and tables, of chains and of belts.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The parts of the error. Precondition: the diagnosis has a budget.
[[nodiscard]] report::Section budget_section(const grid::diagnosis::Diagnosis& found);
/// The named causes with size, probability and remedy. Precondition: a cause is named.
[[nodiscard]] report::Section causes_section(const grid::diagnosis::Diagnosis& found);
/// Possible variables of the rest. Precondition: some law is reported.
[[nodiscard]] report::Section laws_section(const grid::diagnosis::Diagnosis& found);
/// The result for each declared effect. Precondition: there are some.
[[nodiscard]] report::Section declared_section(const grid::diagnosis::Diagnosis& found);
/// The next measurements, numbered. Precondition: there are some.
[[nodiscard]] report::Section next_section(const grid::diagnosis::Diagnosis& found);
/// The relevant hypotheses, and the remainder.
[[nodiscard]] report::Section probabilities_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section settings_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section outliers_section(const grid::diagnosis::Diagnosis& found);
/// What was looked for and is absent.
[[nodiscard]] report::Section bounds_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section not_testable_section(const grid::diagnosis::Diagnosis& found);
/// Assumptions, noise and corrections of the data.
[[nodiscard]] report::Section remarks_section(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
