// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The atlas of causes (grid/synthetic/atlas.hpp) as a self-contained page: small pictures side by
/// side, each with a slider for the size of its cause. Without scripts it shows the usual sizes.
#pragma once

#include <string>

#include "grid/synthetic/atlas.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// \param machine its name. Same atlas, same bytes.
[[nodiscard]] std::string atlas_page(const synthetic::Atlas& atlas, const std::string& machine);

}  // namespace chaintrue::cli
