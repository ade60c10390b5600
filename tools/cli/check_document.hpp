// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a check of a map or of anchors found, as a document.
#pragma once

#include "grid/belts/anchors_check.hpp"
#include "grid/map/map_check.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

[[nodiscard]] report::Document check_document(const grid::MapCheck& check);
[[nodiscard]] report::Document check_document(const grid::AnchorsCheck& check);

}  // namespace chaintrue::cli
