// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// fit of a V-plotter's test drawing: its true settings, and a prediction of the next drawing.
#pragma once

#include <string>

#include "tools/cli/input_file.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

struct DrawingFitCommand {
  Verb verb;
  InputFile file;
  std::string output;
  bool verbose = false;
  bool json = false;
};

/// \throws InputError for a drawing with a mistake, which is reported; nothing is written then.
int fit_the_drawing(const DrawingFitCommand& command);

}  // namespace chaintrue::cli
