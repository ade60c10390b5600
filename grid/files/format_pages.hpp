// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Each file format as a reference page (Markdown) and as a JSON Schema (draft 7, json-schema.org),
/// which editors use to complete and check such files. Both come from the tables that the readers
/// use: every key, unit, range and default. Same program, same bytes.
///
/// A schema checks less than a reader: dependencies between keys, and whether points and machine fit
/// together, are checked by chaintrue only.
///
/// \code
///   write_whole_file("machine.schema.json", write_format_schema("machine"));
/// \endcode
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::grid::files {

/// machine, grid, holes, map, diagnosis, sweep.
std::vector<std::string> described_formats();

/// \throws std::invalid_argument for any other name.
std::string write_format_schema(std::string_view name);
std::string write_format_page(std::string_view name);

}  // namespace chaintrue::grid::files
