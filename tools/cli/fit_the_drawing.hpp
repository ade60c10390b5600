// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// fit of a V-plotter's test drawing: its settings as they are, and what the next drawing is like.
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

/// \throws files::InputError for a drawing with a slip, which is named; nothing is written then.
int fit_the_drawing(const DrawingFitCommand& command);

}  // namespace chaintrue::cli
