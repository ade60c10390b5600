// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A diagnosis as a document for the terminal and for a browser: the answer first, then its basis.
#pragma once

#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// `source` is the input file's name, for the page's last line. Pictures are made if `detail` is
/// page.
Document diagnosis_document(const Diagnosis& diagnosis, std::string_view source,
                            Detail detail = Detail::page);

/// Every section is made from the diagnosis alone.
using SectionOf = Section(const Diagnosis& found);

/// The parts of the error. Precondition: the diagnosis has a budget.
SectionOf budget_section;
/// The named causes with size, probability and remedy. Precondition: a cause is named.
SectionOf causes_section;
/// Possible variables of the rest. Precondition: some law is reported.
SectionOf laws_section;
/// The result for each declared effect. Precondition: there are some.
SectionOf declared_section;
/// The next measurements, numbered. Precondition: there are some.
SectionOf next_section;
/// The relevant hypotheses, and the remainder.
SectionOf probabilities_section;
SectionOf settings_section;
SectionOf outliers_section;
/// Causes that were looked for and are absent.
SectionOf bounds_section;
SectionOf not_testable_section;
/// Assumptions, noise and corrections of the data.
SectionOf remarks_section;

/// The tool, or the distances, before and with the causes. Precondition of this and the next two:
/// readings.
SectionOf arrows_section;
/// The measured residuals, and those that the cause and its rival predict. Precondition: a cause is
/// named.
SectionOf signature_section;
/// Residuals against lengths, angles and visits.
SectionOf residuals_section;

// The gain of naming: errors at held-out points and distances.

/// Precondition: the diagnosis has a gain.
SectionOf improvement_section;
/// On the points of another grid. Precondition: there is one.
SectionOf transfer_section;
/// For both; empty if there is no gain.
Light corrected_light(const Diagnosis& found);
std::vector<Figure> figures_of_improvement(const Diagnosis& found);

// Sections specific to a diagnosis of four belts. Precondition of all: it is one of belts.

/// The frame with its residuals, before and with the causes.
SectionOf frame_section;
/// The anchors before and with the causes.
SectionOf anchors_section;
/// Errors of the belts and of the tool, before and with the causes.
SectionOf belts_improvement_section;
Light scale_light(const Diagnosis& found);
std::vector<Figure> figures_of_belts(const Diagnosis& found);

// The section on the verdict without some of the readings.

/// Which readings influence the name. Precondition: the diagnosis has a stability.
SectionOf stability_section;

// Sections specific to a diagnosis of a test drawing. Precondition of all: it is one of a drawing.

/// The settings in force and as estimated with the causes.
SectionOf drawn_settings_section;
/// The measures, and their prediction by settings and causes.
SectionOf drawn_measures_section;
Light drawn_settings_light(const Diagnosis& found);

}  // namespace chaintrue::cli
