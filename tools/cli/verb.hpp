// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How to add a verb: one pair of files (fit.hpp not needed; fit.cpp defines add_fit), one line in
/// verbs.def.
///
/// \code
///   void add_fit(Verb app) {
///     auto options = std::make_shared<FitOptions>();
///     Verb verb = app.add_verb("fit", "...");
///     verb.footer("Example:\n  chaintrue fit grid.json -o map.json");
///     verb.runs(options, run_fit);
///   }
/// \endcode
#pragma once

#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

/// The command's exit codes, on which scripts may rely.
enum ExitCode {
  kDone = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kNotSupportedOrOutside = 4,
  kInternal = 5,
};

#define CHAINTRUE_VERB(id) void add_##id(Verb app);
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB

/// Below import and export.
void add_import_maslow4(Verb import);
void add_import_plotter(Verb import);
void add_export_plotter(Verb export_verb);
void add_export_map(Verb export_verb);

}  // namespace chaintrue::cli
