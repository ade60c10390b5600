// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map's certificate: one page to print. What error to expect, with its interval; what was
/// measured; what is named; what remains.
#pragma once

#include <string_view>

#include "grid/map/compensation_map.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// `source` is the map's file, for the footer.
[[nodiscard]] Document certificate(const CompensationMap& map, std::string_view source);

}  // namespace chaintrue::cli
