// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a verb writes of where its results come from, and how a report shows it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/provenance.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// Of the verb that was chosen: the options that were given, but those that name outputs or only
/// change what is printed, and every file that was read so far.
[[nodiscard]] grid::Provenance made_by(Verb verb);

/// "Where this comes from", folded; nothing is added where that is not known.
void add_made_by(const std::optional<grid::Provenance>& made_by,
                 std::vector<report::Section>& sections);

/// A note on standard error where a file that was read now has the name of one that this result was
/// made from, and another content.
void say_what_changed(const InputFile& result);

}  // namespace chaintrue::cli
