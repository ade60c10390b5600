// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The type of a file, for verbs that accept several kinds.
///
/// \code
///   if (kind_of(text, "points.csv") == FileKind::holes) ...
/// \endcode
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::grid::files {

enum class FileKind {
  machine,
  grid,        ///< JSON or CSV
  holes,       ///< JSON or CSV, cut by a machine on two chains, or one that the file does not name
  belt_holes,  ///< JSON, cut by the machine on four belts that the file names
  belts,
  map,
  anchors,
  diagnosis,
  plotter,
  drawing,
  other,  ///< JSON of another type, or of none
};

/// JSON by its "file_type"; any other text is CSV, of holes by its first header and of a grid
/// otherwise. `file` is the name used in messages. \throws InputError for JSON that ends or is malformed
/// before its type is known.
FileKind kind_of(const std::string& text, const std::string& file);

/// "\"chaintrue_grid\" or \"chaintrue_belts\"", as in the "expected" part of messages.
std::string expected_kinds(const std::vector<FileKind>& kinds);
/// What was found: "\"chaintrue_map\"", "a CSV of points"; empty for JSON without a type.
std::string found_kind(const std::string& text, const std::string& file);

/// "; this is a map; did you mean chaintrue report, query, gcode or export?"; empty for a type that
/// no verb accepts.
std::string what_takes(std::string_view file_type);

/// The value of "file_type" in a JSON object; empty if there is none. \throws InputError for a
/// text that is not JSON.
std::string file_type_of(const std::string& text, const std::string& file);

/// True where the text begins as a JSON object or list does.
bool is_json(std::string_view text);

}  // namespace chaintrue::grid::files
