// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue import maslow4: the log of a router on four belts becomes a chaintrue_belts file.
#pragma once

#include <string>

#include "grid/files/maslow4_log.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

/// What a log does not say, from options of the same names.
struct LogReading {
  std::string settings;
  std::string lengths;
  std::string orientation;
};
void add_log_reading(Verb verb, LogReading& reading);
/// \throws grid::files::InputError where the settings' file cannot be read.
[[nodiscard]] grid::files::Maslow4Options options_of(const LogReading& reading);

void add_import_maslow4(Verb import, Run& run);

}  // namespace chaintrue::cli
