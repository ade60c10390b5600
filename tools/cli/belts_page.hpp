// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The page of a diagnosis of four belts.
#pragma once

#include <string_view>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/page.hpp"

namespace chaintrue::cli {

/// The answer first, then the frame as it is drawn with what each belt reads beside the fit, before
/// and after, and the tables. Precondition: `found.belts`.
[[nodiscard]] report::Page belts_page(const grid::diagnosis::Diagnosis& found,
                                      std::string_view source);

}  // namespace chaintrue::cli
