// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/glossary.hpp"

#include <utility>

namespace chaintrue::report {
namespace {

constexpr Term kTerms[] = {
    {"rms", "root mean square: the usual size of errors of either sign, large ones counted more"},
    {"one sigma", "two values of three lie within it, nineteen of twenty within twice of it"},
    {"mark", "a place on the sheet at which the tool, or the chains, were measured"},
    {"map", "the true chain lengths for every place of the bed, made from the marks"},
    {"uncorrected", "the machine with the settings that it had when it was measured"},
    {"calibrated", "the settings moved to where they fit the readings best"},
    {"left out",
     "one reading, or one block of the bed at a time, that the fit did not use: the error of "
     "predicting it tests the fit"},
    {"residual", "the reading minus what was expected"},
    {"chain zero",
     "how much too long or short a chain reads everywhere, because its zero is "
     "wrong"},
    {"noise", "the differences of repeated readings"},
    {"pitch", "the length of one link, 6.35 mm when it is new"},
    {"catenary", "the curve in which a chain hangs"},
    {"extrapolated", "beyond the measured part of the bed"},
};

}  // namespace

std::span<const Term> terms() { return kTerms; }

Section glossary() {
  Table table{.columns = {{"Word"}, {"What it means here"}}, .rows = {}, .caption = {}};
  for (const Term& term : kTerms) table.rows.push_back({{term.word, term.meaning}, false});
  Section section{"Words", {}};
  section.is_folded = true;
  section.blocks.emplace_back(std::move(table));
  return section;
}

}  // namespace chaintrue::report
