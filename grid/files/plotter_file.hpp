// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_plotter files: a V-plotter with its controller's settings, and the result of a test
/// drawing. Unknown keys are errors, except "comment". Same plotter, same bytes.
///
/// \code
///   const KnownPlotter plotter = parse_plotter(text, "plotter.json");
///   write_whole_file("plotter.json", write_plotter(plotter));
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/plotter/found_plotter.hpp"
#include "grid/provenance.hpp"

namespace chaintrue::grid::files {

/// `file` is the name used in messages. \throws InputError with every problem.
KnownPlotter parse_plotter(const std::string& text, const std::string& file);
/// `comments` go under the key "comment", one line each; readers ignore them. \throws
/// std::logic_error where a number is not finite.
std::string write_plotter(const KnownPlotter& plotter,
                          const std::vector<std::string>& comments = {},
                          const std::optional<Provenance>& made_by = std::nullopt);

}  // namespace chaintrue::grid::files
