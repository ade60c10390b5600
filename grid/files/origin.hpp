// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What kind of file a text is, as far as this program writes that kind, and whether a person's
/// work would be lost with it.
///
/// A map, a diagnosis, a page or a compensated program is made from something else and can be made
/// again. A grid, a set of holes, a machine or a list may hold what somebody measured or typed:
/// such a file counts as this program's only while nothing in it has changed since it was written,
/// which its signature tells: a comment with the content's hash.
///
/// \code
///   write_whole_file("plan.csv", signed_text(marks, Origin::list));
///   if (origin_of(read_whole_file("plan.csv")) == Origin::list) ...  // nobody filled it in
/// \endcode
#pragma once

#include <string>
#include <string_view>

namespace chaintrue::grid::files {

enum class Origin {
  foreign,  ///< not recognised: a person's, or another program's
  changed,  ///< of a kind that this program writes, but with something in it that it did not write
  map,
  diagnosis,
  anchors,
  measured,  ///< chaintrue_grid, chaintrue_holes or chaintrue_belts
  machine,
  answer,  ///< what a simulation hid
  check,
  page,         ///< HTML
  drawing,      ///< SVG
  program,      ///< G-code
  table,        ///< results: CSV, lines of JSON, words
  list,         ///< to be filled in, or to be typed into another program
  description,  ///< of a file format: its page or its schema
};

/// Never fails: whatever is not recognised is foreign.
[[nodiscard]] Origin origin_of(std::string_view text);

/// The text as it goes into a file of its kind: with the signature where the kind has one.
[[nodiscard]] std::string signed_text(const std::string& text, Origin kind);

}  // namespace chaintrue::grid::files
