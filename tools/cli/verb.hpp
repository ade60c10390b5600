// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How to add a verb: one pair of files (fit.hpp not needed; fit.cpp defines add_fit), one line in
/// verbs.def. This header includes what every such file needs: options, inputs, outputs, messages.
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

#include <memory>

#include "tools/cli/input_file.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {

#define CHAINTRUE_VERB(id) void add_##id(Verb app);
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB

/// Below import and export.
void add_import_maslow4(Verb import);
void add_import_plotter(Verb import);
void add_export_map(Verb export_verb);

}  // namespace chaintrue::cli
