// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The page of a fit of four belts.
#pragma once

#include <string_view>

#include "grid/belts/belts_and_holes.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// Frame, anchors with their ellipses, what was foretold, and the tape. `holes` may be null; `name` is
/// the belts', `source` the file's.
[[nodiscard]] report::Document anchors_page(const grid::BeltsFit& fit,
                                        const grid::HolesBesideBelts* holes,
                                        std::string_view name,
                                        std::string_view source);

}  // namespace chaintrue::cli
