// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What people type, on its way to the parser, and what was probably meant where it says no.
#pragma once

#include <string>
#include <vector>

#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

/// The words for the parser; `help fit` becomes `fit --help`.
[[nodiscard]] std::vector<std::string> words_of(std::vector<std::string> typed);

/// The sentence about a verb or an option that nobody knows, with the one that was probably meant or
/// where to look; empty where all are known.
[[nodiscard]] std::string did_you_mean(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace chaintrue::cli
