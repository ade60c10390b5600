// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reads a chaintrue_anchors file for a verb, telling what was assumed.
#pragma once

#include <string>

#include "grid/files/anchors_file.hpp"

namespace chaintrue::cli {

/// `file` is the name used in messages. \throws grid::files::InputError with every problem.
[[nodiscard]] grid::files::FittedAnchors parse_anchors_input(const std::string& text,
                                                             const std::string& file);

}  // namespace chaintrue::cli
