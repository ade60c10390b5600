// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Each file format as a reference page (Markdown) and as a JSON Schema (draft 7, json-schema.org),
/// by which editors complete and check such files. Both come from the tables that the readers go by:
/// every key, unit, range and default. Same program, same bytes.
///
/// A schema says less than a reader: how keys depend on one another, and whether points and machine
/// fit together, is for chaintrue itself.
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
[[nodiscard]] std::vector<std::string> described_formats();

/// \throws std::invalid_argument for a name that is none of them.
[[nodiscard]] std::string write_format_schema(std::string_view name);
[[nodiscard]] std::string write_format_page(std::string_view name);

}  // namespace chaintrue::grid::files
