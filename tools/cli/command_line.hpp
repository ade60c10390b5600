// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Prepares command lines for the parser, and suggests what was meant if it rejects one.
#pragma once

#include <string>
#include <vector>

#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

/// The words for the parser; `help fit` becomes `fit --help`.
[[nodiscard]] std::vector<std::string> words_of(std::vector<std::string> typed);

/// The message about an unknown verb or option, with the probable one or where to look; empty if
/// all are known.
[[nodiscard]] std::string did_you_mean(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace chaintrue::cli
