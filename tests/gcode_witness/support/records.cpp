// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/records.hpp"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

namespace chaintrue::witness {

std::string write_records(const std::vector<Record>& records) {
  std::string text;
  for (const Record& record : records) {
    text += fmt::format("=== {} {}\n{}\n", record.name, record.text.size(), record.text);
  }
  return text;
}

std::vector<Record> read_records(std::string_view text) {
  std::vector<Record> records;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::istringstream header{std::string(text.substr(0, end))};
    std::string marker;
    Record record;
    std::size_t bytes = 0;
    header >> marker >> record.name >> bytes;
    if (!header || marker != "===" || end == std::string_view::npos ||
        text.size() < end + 1 + bytes + 1) {
      throw std::runtime_error(fmt::format("no record begins with '{}'", text.substr(0, end)));
    }
    record.text = text.substr(end + 1, bytes);
    text.remove_prefix(end + 1 + bytes + 1);
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace chaintrue::witness
