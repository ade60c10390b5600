// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sections specific to a diagnosis of a test drawing. Precondition of all: it is one of a drawing.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The settings in force and as estimated with the causes.
[[nodiscard]] Section drawn_settings_section(const Diagnosis& found);
/// The measures, and their prediction by settings and causes.
[[nodiscard]] Section drawn_measures_section(const Diagnosis& found);
[[nodiscard]] Light drawn_settings_light(const Diagnosis& found);

}  // namespace chaintrue::cli
