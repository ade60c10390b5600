// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reads a chaintrue_anchors or a chaintrue_belts file for a verb, telling what was assumed.
#pragma once

#include <string>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"

namespace chaintrue::cli {

/// `file` is the name used in messages. \throws grid::files::InputError with every problem.
[[nodiscard]] grid::files::FittedAnchors parse_anchors_input(const std::string& text,
                                                             const std::string& file);
/// At most kMostBeltPoints places; `work` is what they are read for: "a fit".
[[nodiscard]] grid::files::ReadBelts parse_belts_input(const std::string& text,
                                                       const std::string& file,
                                                       const std::string& work);

}  // namespace chaintrue::cli
