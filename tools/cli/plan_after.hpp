// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan FILE --after: what to measure next, as a list for the workshop, as lines for the
/// files that were diagnosed, and as a drawing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/input_file.hpp"

namespace chaintrue::cli {

struct PlanAfterOptions {
  std::string file;  ///< a grid, holes or belts
  std::string after;
  Words with;  ///< the other files of the same diagnosis
  std::string machine;
  std::string output = "-";
  std::string drawing;
};

/// Facts on which options depend. \throws InputError for a file of another kind.
Facts facts_after(const InputFile& file);

/// \param file the options' file, opened
/// \throws InputError. Returns an exit code.
int plan_after(const PlanAfterOptions& options, const InputFile& file);

/// What to measure next, as texts: the list for the workshop, the lines to fill in, and the drawing
/// (SVG).
struct FollowUpTexts {
  std::string list;
  std::string csv;  ///< empty for belts, which have no CSV
  std::string json;
  std::string drawing;
};
/// Empty if the diagnosis used other readings.
std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found,
                                             const grid::Measured& measured);
std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found, const MeasuredBelts& belts);

}  // namespace chaintrue::cli
