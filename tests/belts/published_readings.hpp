// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Readings of real machines. They stay in ../shared/data, which is not part of a checkout.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::testing_support {

/// Empty without the shared data.
inline std::optional<grid::files::Maslow4Import> published_readings(const std::string& file,
                                                                    int run = 1) {
  const auto path = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4" / file;
  if (!std::filesystem::exists(path)) return std::nullopt;
  grid::files::Maslow4Options options;
  options.part.run = run;
  return grid::files::parse_maslow4(grid::files::read_whole_file(path), file, options);
}

}  // namespace chaintrue::testing_support
