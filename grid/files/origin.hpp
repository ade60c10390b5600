// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The kind of a text among those that this program writes, and whether a user's work would be lost
/// if it were overwritten.
///
/// A map, a diagnosis, a page or a compensated program is computed and can be computed again. A
/// grid, a set of holes, a machine or a list may contain measurements or typed values: such a file
/// counts as this program's only if it is unchanged since it was written, which is checked by its
/// signature, a comment with the content's hash.
///
/// \code
///   write_whole_file("plan.csv", signed_text(marks, Origin::list));
///   if (origin_of(read_whole_file("plan.csv")) == Origin::list) ...  // not filled in
/// \endcode
#pragma once

#include <string>
#include <string_view>

namespace chaintrue::grid::files {

enum class Origin {
  foreign,  ///< not recognised: a user's, or another program's
  changed,  ///< of a kind that this program writes, but changed since
  map,
  diagnosis,
  anchors,
  measured,  ///< chaintrue_grid, chaintrue_holes, chaintrue_belts or chaintrue_drawing
  machine,   ///< chaintrue_machine or chaintrue_plotter
  answer,    ///< the truth of a simulation
  check,
  page,         ///< HTML
  drawing,      ///< SVG
  program,      ///< G-code
  table,        ///< results: CSV, lines of JSON, text
  list,         ///< to be filled in, or typed into another program
  description,  ///< of a file format: its page or its schema
};

/// Never fails: unrecognised texts are foreign.
Origin origin_of(std::string_view text);

/// The text to be written: with the signature if the kind has one.
std::string signed_text(const std::string& text, Origin kind);

}  // namespace chaintrue::grid::files
