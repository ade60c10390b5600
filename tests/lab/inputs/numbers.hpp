// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The numbers of an answer, for comparing two answers.
#pragma once

#include <string>
#include <vector>

#include "tests/inputs/input_folder.hpp"

namespace chaintrue::inputs {

/// The numbers of an answer: of JSON every number but those under a key that repeats the input, of
/// other text every number. Texts that name files or seeds are none.
std::string numbers_of(const Ran& ran, const std::vector<std::string>& echoes);

}  // namespace chaintrue::inputs
