// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A sweep's report: the error against the number of points, one panel a factor.
#pragma once

#include <vector>

#include "grid/files/sweep_store.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

[[nodiscard]] report::Document sweep_page(const grid::sweep::SweepSpec& spec,
                                      const std::vector<grid::files::LevelError>& errors);

}  // namespace chaintrue::cli
