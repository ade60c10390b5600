// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The result of a check of a map or of anchors, as a document.
#pragma once

#include "grid/map/check.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// Each residual.
[[nodiscard]] Document map_check_document(const grid::Check& check);
/// Each place with the rms residual of its belts.
[[nodiscard]] Document anchors_check_document(const grid::Check& check);

}  // namespace chaintrue::cli
