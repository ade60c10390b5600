// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Processes that tests start, as a script does.
#pragma once

#include <filesystem>
#include <string>

namespace chaintrue::testing_support {

struct Outcome {
  int code = -1;  ///< -1: ended by a signal
  std::string out;
  std::string err;
};

/// Runs a shell line in a folder, with this build's `chaintrue` in the path. What it writes is in out.txt and err.txt.
[[nodiscard]] Outcome run_line(const std::filesystem::path& folder, const std::string& shell);

/// "'/path/of/the/file'", for such a line.
std::string quoted(const std::filesystem::path& path);

}  // namespace chaintrue::testing_support
