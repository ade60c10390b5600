// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A sweep's report: the error against the number of points, one panel a factor.
#pragma once

#include <vector>

#include "grid/files/sweep_store.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

[[nodiscard]] Document sweep_page(const sweep::SweepSpec& spec,
                                  const std::vector<files::LevelError>& errors);

}  // namespace chaintrue::cli
