// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The outputs of a plan: list, page, program and drawing.
#pragma once

#include <string>
#include <vector>

#include "grid/files/whole_file.hpp"
#include "tools/cli/sheet.hpp"

namespace chaintrue::cli {

/// Paths; empty: not wanted.
struct PlanOutputs {
  std::string list = "-";
  std::string drawing;
  std::string gcode;
  std::string page;
  DrillOptions drill;
  bool json = false;
};

/// The list and, if requested, the page, the program and the answer.
/// \param expected as for add_answer
[[nodiscard]] std::vector<files::OutputFile> sheet_outputs(const Sheet& sheet,
                                                           const Machine& machine,
                                                           const StatedNoise& noise,
                                                           const PlanOutputs& outputs,
                                                           const std::string& expected);

/// With --json, where the list goes into a file: the places in mm, numbers of places in the order of
/// the visits (empty: each once), and members of an object on what is expected.
void add_answer(const std::vector<MarkPoint>& places,
                const std::vector<std::size_t>& visits,
                const std::string& expected,
                const PlanOutputs& outputs,
                std::vector<files::OutputFile>& written);

/// The next step: fill in the list and fit it.
void say_next_of_sheet(const PlanOutputs& outputs, const std::string& machine);

}  // namespace chaintrue::cli
