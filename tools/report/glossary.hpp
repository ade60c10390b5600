// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Technical terms of the pages: listed at the end of a page, and as hover text where a term first
/// occurs in a paragraph.
#pragma once

#include <string_view>

#include "tools/report/document.hpp"

namespace chaintrue::report {

struct Term {
  std::string_view word;
  std::string_view meaning;
};
inline constexpr Term kTerms[] = {
    {"rms",
     "root mean square: the typical size of errors of either sign, with large ones weighted "
     "more"},
    {"one sigma",
     "one standard deviation: two of three values are within it, nineteen of twenty "
     "within twice as much"},
    {"mark", "a place on the sheet where the tool or the chains were measured"},
    {"map", "the true chain lengths for every place on the bed, computed from the marks"},
    {"uncorrected", "the machine with the settings in force when it was measured"},
    {"calibrated", "with the settings that fit the readings best"},
    {"left out",
     "not used by the fit, one reading or one block of the bed at a time; the error of predicting "
     "it tests the fit"},
    {"residual", "the reading minus what was expected"},
    {"chain zero", "the constant error of a chain's readings due to a wrong zero"},
    {"noise", "the differences of repeated readings"},
    {"pitch", "the length of one link, 6.35 mm when it is new"},
    {"catenary", "the curve in which a chain hangs"},
    {"extrapolated", "beyond the measured part of the bed"},
};

/// A folded section with all of them.
Section glossary();

}  // namespace chaintrue::report
