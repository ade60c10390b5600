// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pages as the command makes them.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::report::testing {

/// The content of `file` after a shell line with the command, in a separate folder.
std::string made_by(const std::string& line, const std::string& file);
std::string page_of(const grid::diagnosis::Diagnosis& found);

/// The likeliest law and its best rival among the sample's points.
[[nodiscard]] grid::diagnosis::Diagnosis diagnosis_with_laws();
/// For holes with one bad distance, and two measurements to come.
grid::diagnosis::Diagnosis diagnosis_of_holes();
inline constexpr int kSampleDistances = 20;

}  // namespace chaintrue::report::testing
