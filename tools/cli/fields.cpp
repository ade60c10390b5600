// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/fields.hpp"

#include <fmt/format.h>

namespace chaintrue::cli {
namespace {

std::string csv_line(const Fields& fields, std::string Field::*what) {
  return fmt::format("{}\n", fmt::join(mapped(fields, what), ","));
}

}  // namespace

std::string csv_names(const Fields& fields) { return csv_line(fields, &Field::name); }

std::string csv_values(const Fields& fields) { return csv_line(fields, &Field::text); }

std::string json_of(const Fields& fields) {
  Words members;
  for (const auto& [name, text, is_word] : fields) {
    const std::string_view quote = is_word ? "\"" : "";
    members.push_back(fmt::format("\"{0}\": {1}{2}{1}", name, quote, text.empty() ? "null" : text));
  }
  return fmt::format("{{{}}}", fmt::join(members, ", "));
}

}  // namespace chaintrue::cli
