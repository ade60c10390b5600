// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a verb joins the command: one pair of files (fit.hpp not needed; fit.cpp defines add_fit),
/// one line in verbs.def.
///
/// \code
///   void add_fit(Verb app, Run& run) {
///     auto options = std::make_shared<FitOptions>();
///     Verb verb = app.add_verb("fit", "...");
///     verb.footer("Example:\n  chaintrue fit grid.json -o map.json");
///     verb.when_chosen([options, &run] { run = [options] { return run_fit(*options); }; });
///   }
/// \endcode
#pragma once

#include <functional>

#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

/// The command's exit codes, a promise to scripts.
enum ExitCode {
  kDone = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kNotSupportedOrOutside = 4,
  kInternal = 5,
};

/// What the chosen verb will do; throws files::InputError for bad input.
using Run = std::function<int()>;

#define CHAINTRUE_VERB(id) void add_##id(Verb app, Run& run);
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB

}  // namespace chaintrue::cli
