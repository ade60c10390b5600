// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The verbs and options of the command from its --help, so that the campaign covers all of them.
#pragma once

#include <string>
#include <vector>

#include "torture/run.hpp"

namespace chaintrue::torture {

struct Option {
  std::string name;                  ///< "--output"
  std::string short_name;            ///< "-o", or empty
  std::string type;                  ///< TEXT, INT, FLOAT; empty: a flag
  std::vector<std::string> choices;  ///< where only these are taken
  int values = 1;                    ///< how many values it takes
};

/// "fit", "gcode check", ...
[[nodiscard]] std::vector<std::string> verbs_of(const Command& command);
/// The options of one of them, without --help itself.
[[nodiscard]] std::vector<Option> options_of(const Command& command, const std::string& verb);

}  // namespace chaintrue::torture
