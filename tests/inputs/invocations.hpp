// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How each verb is called: the one table for the tests of inputs, the option matrix and the torture
/// campaign. "@" begins the name of a file of the folder (input_folder.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/cli/option_rules.hpp"

namespace chaintrue::inputs {

/// A verb on one kind of input: a row of invocations.tsv.
struct Invocation {
  std::string verb;  ///< "fit", "gcode check"
  std::string name;  ///< of the kind of input
  cli::Facts facts;  ///< what option_rules.def knows of it
  std::string line;
};
[[nodiscard]] const std::vector<Invocation>& invocations();

/// Valid values of an option that takes neither any number, any file nor one of the choices that --help
/// lists; empty for others.
[[nodiscard]] const std::vector<std::string>& values_of(std::string_view option);
/// The option names a file or folder to write.
[[nodiscard]] bool is_output(std::string_view option);

}  // namespace chaintrue::inputs
