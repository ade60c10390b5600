// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The verbs and options of the command from its --help, so that tests cover all of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace chaintrue::inputs {

struct Option {
  std::string name;                  ///< "--output"
  std::string type;                  ///< TEXT, INT, FLOAT; empty: a flag
  std::vector<std::string> choices;  ///< where only these are taken
  int values = 1;                    ///< how many values it takes
};

/// Prints the help of a verb ("" for all).
using Help = std::function<std::string(const std::string& verb)>;

/// "fit", "gcode check", ...
std::vector<std::string> verbs_in(const Help& help);
/// The options of one of them, without --help itself.
std::vector<Option> options_in(const std::string& help);

}  // namespace chaintrue::inputs
