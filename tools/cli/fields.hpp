// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The same named values as a line of a table (CSV) and as a JSON object.
///
/// \code
///   const Fields fields = {{"x_mm", "100.0"}, {"left_mm", ""}};
///   csv_names(fields);  // x_mm,left_mm
///   csv_values(fields); // 100.0,
///   json_of(fields);    // {"x_mm": 100.0, "left_mm": null}
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "tools/cli/names.hpp"

namespace chaintrue::cli {

struct Field {
  std::string name;
  std::string text;      ///< as printed; empty: unknown
  bool is_word = false;  ///< quoted in JSON
};

using Fields = std::vector<Field>;

/// Lines end with a line break.
std::string csv_names(const Fields& fields);
std::string csv_values(const Fields& fields);
std::string json_of(const Fields& fields);

}  // namespace chaintrue::cli
