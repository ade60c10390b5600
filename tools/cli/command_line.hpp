// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What people type, on its way to the parser, and what was probably meant where it says no.
#pragma once

#include <string>
#include <vector>

#include "tools/cli/cli_fwd.hpp"

namespace chaintrue::cli {

/// The words after the program's name; `help fit` becomes `fit --help`.
[[nodiscard]] std::vector<std::string> words_of(int argc, char** argv);

/// "Did you mean --machine?" and the line to type, for a verb or an option that nobody knows; empty
/// where all are known, or where nothing is near.
[[nodiscard]] std::string did_you_mean(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace chaintrue::cli
