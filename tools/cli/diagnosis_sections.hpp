// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a diagnosis' page that are words and tables alone.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/page.hpp"

namespace chaintrue::cli {

/// What is named, with its size, probability and remedy. Precondition: a cause is named.
[[nodiscard]] report::Section causes_section(const grid::diagnosis::Diagnosis& found);
/// The next measurements, numbered. Precondition: there are some.
[[nodiscard]] report::Section next_in_a_table(const grid::diagnosis::Diagnosis& found);
/// Every cause that was tested, and what became of it.
[[nodiscard]] report::Section terms_section(const grid::diagnosis::Diagnosis& found);
/// What was looked for and is absent, and what these points cannot show.
[[nodiscard]] report::Section bounds_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section outliers_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Section settings_section(const grid::diagnosis::Diagnosis& found);
/// Assumptions, noise and corrections of the data.
[[nodiscard]] report::Section method_section(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
