// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a diagnosis that consist of text and tables, for chains and belts.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The parts of the error. Precondition: the diagnosis has a budget.
[[nodiscard]] Section budget_section(const Diagnosis& found);
/// The named causes with size, probability and remedy. Precondition: a cause is named.
[[nodiscard]] Section causes_section(const Diagnosis& found);
/// Possible variables of the rest. Precondition: some law is reported.
[[nodiscard]] Section laws_section(const Diagnosis& found);
/// The result for each declared effect. Precondition: there are some.
[[nodiscard]] Section declared_section(const Diagnosis& found);
/// The next measurements, numbered. Precondition: there are some.
[[nodiscard]] Section next_section(const Diagnosis& found);
/// The relevant hypotheses, and the remainder.
[[nodiscard]] Section probabilities_section(const Diagnosis& found);
[[nodiscard]] Section settings_section(const Diagnosis& found);
[[nodiscard]] Section outliers_section(const Diagnosis& found);
/// Causes that were looked for and are absent.
[[nodiscard]] Section bounds_section(const Diagnosis& found);
[[nodiscard]] Section not_testable_section(const Diagnosis& found);
/// Assumptions, noise and corrections of the data.
[[nodiscard]] Section remarks_section(const Diagnosis& found);

}  // namespace chaintrue::cli
