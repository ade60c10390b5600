// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A diagnosis as a document for the terminal and for a browser: the answer first, then its basis. Its
/// sections that consist of text and tables, for chains and belts.
#pragma once

#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// `source` is the input file's name, for the page's last line. Pictures are made if `detail` is
/// page.
[[nodiscard]] Document diagnosis_document(const Diagnosis& diagnosis,
                                          std::string_view source,
                                          Detail detail = Detail::page);

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

// The gain of naming: errors at held-out points and distances.

/// A line of the table.
struct ImprovementRow {
  std::string_view what;
  const diagnosis::HeldOut* held_out = nullptr;
};
/// Rows point into the diagnosis. Precondition: it has a gain. Rows of an extension are left out
/// where nothing was named.
[[nodiscard]] std::vector<ImprovementRow> improvement_rows(const Diagnosis& diagnosis);
/// Distances were held out: no points were read, or too few.
[[nodiscard]] bool is_improvement_of_distances(const diagnosis::HeldOutImprovement& improvement);

/// Precondition: the diagnosis has a gain.
[[nodiscard]] Section improvement_section(const Diagnosis& found);
/// On the points of another grid. Precondition: there is one.
[[nodiscard]] Section transfer_section(const Diagnosis& found);
/// For both; empty if there is no gain.
[[nodiscard]] Light corrected_light(const Diagnosis& found);
[[nodiscard]] std::vector<Figure> figures_of_improvement(const Diagnosis& found);

// Sections specific to a diagnosis of four belts. Precondition of all: it is one of belts.

/// The frame with its residuals, before and with the causes.
[[nodiscard]] Section frame_section(const Diagnosis& found);
/// The anchors before and with the causes.
[[nodiscard]] Section anchors_section(const Diagnosis& found);
/// Errors of the belts and of the tool, before and with the causes.
[[nodiscard]] Section belts_improvement_section(const Diagnosis& found);
[[nodiscard]] Light scale_light(const Diagnosis& found);
[[nodiscard]] std::vector<Figure> figures_of_belts(const Diagnosis& found);

// The section on the verdict without some of the readings.

/// Which readings influence the name. Precondition: the diagnosis has a stability.
[[nodiscard]] Section stability_section(const Diagnosis& found);

// Sections specific to a diagnosis of a test drawing. Precondition of all: it is one of a drawing.

/// The settings in force and as estimated with the causes.
[[nodiscard]] Section drawn_settings_section(const Diagnosis& found);
/// The measures, and their prediction by settings and causes.
[[nodiscard]] Section drawn_measures_section(const Diagnosis& found);
[[nodiscard]] Light drawn_settings_light(const Diagnosis& found);

}  // namespace chaintrue::cli
