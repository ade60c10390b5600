// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The provenance that a verb writes with its results, and its display in a report.
#pragma once

#include <optional>
#include <vector>

#include "grid/provenance.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// For the chosen verb: its options, except those that name outputs or only change printing, and
/// every file read so far.
grid::Provenance made_by(Verb verb);

/// "Where this comes from", folded; nothing is added if it is unknown.
void add_made_by(const std::optional<grid::Provenance>& made_by, std::vector<Section>& sections);

/// A note on standard error if an input has the same name as a source of this result but another
/// content.
void report_difference(const InputFile& result);

}  // namespace chaintrue::cli
