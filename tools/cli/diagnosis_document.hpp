// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A diagnosis as a document for the terminal and for a browser: the answer first, then its basis.
#pragma once

#include <string_view>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// `source` is the input file's name, for the page's last line. Pictures are made if `detail` is
/// page.
[[nodiscard]] Document diagnosis_document(const Diagnosis& diagnosis,
                                          std::string_view source,
                                          Detail detail = Detail::page);

}  // namespace chaintrue::cli
