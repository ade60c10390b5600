// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How to add a verb: one file (fit.cpp defines add_fit) and one line in verbs.def. This header
/// includes what every such file needs: options, inputs, outputs, messages.
///
/// \code
///   void add_fit(Verb app) {
///     auto [verb, c] = app.add_verb<FitCommand>("fit", "...", "Example: ...", run_fit);
///     verb.has({{"grid", required(reads(c.grid)), "Measured points"}, ...});
///   }
/// \endcode
#pragma once

#include "tools/cli/input_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {

#define CHAINTRUE_VERB(id) void add_##id(Verb app);
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB

/// The verbs below export.
void add_export_map(Verb export_verb);

}  // namespace chaintrue::cli
