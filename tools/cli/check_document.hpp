// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a check of a map or of anchors found, as a document.
#pragma once

#include "grid/map/check.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// Each residual by itself.
[[nodiscard]] report::Document map_check_document(const grid::Check& check);
/// Each place with the root mean square of what its belts miss.
[[nodiscard]] report::Document anchors_check_document(const grid::Check& check);

}  // namespace chaintrue::cli
