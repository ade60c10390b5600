// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files embedded in a page at build time: "vega" (Debian's modules, in the order in which they
/// load), "chart" (charts/<name>.vg.json) and "asset" (the page's style, script and licence
/// notices, and drawings of how to take a reading).
#pragma once

#include <string_view>
#include <vector>

namespace chaintrue::report {

struct EmbeddedFile {
  std::string_view name;
  std::string_view text;
};

/// All files of a kind, in the order in which they were embedded.
std::vector<EmbeddedFile> embedded_files(std::string_view kind);

/// \throws std::invalid_argument if there is no file of that kind and name.
std::string_view embedded_text(std::string_view kind, std::string_view name);

}  // namespace chaintrue::report
