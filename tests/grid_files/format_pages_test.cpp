// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reference pages and schemas of the formats: every key is explained, and a machine's ranges are those of the reader.
#include "grid/files/format_pages.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "grid/files/input_error.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "model/machine_ranges.hpp"

namespace chaintrue::grid::files {
namespace {

using nlohmann::json;

/// Keys without a meaning, by their path.
void unexplained(const json& schema, const std::string& way, std::vector<std::string>& found) {
  if (schema.is_array()) {
    for (const json& element : schema) unexplained(element, way, found);
  }
  if (!schema.is_object()) return;
  if (schema.contains("properties")) {
    for (const auto& [key, property] : schema["properties"].items()) {
      const bool head = key == "file_type" || key == "format_version";
      if (!head && !property.contains("description")) found.push_back(way + "/" + key);
      unexplained(property, way + "/" + key, found);
    }
  }
  for (const char* key : {"oneOf", "anyOf", "items", "additionalProperties", "definitions"}) {
    if (!schema.contains(key)) continue;
    for (const auto& part : schema[key].is_array() || std::string(key) == "definitions"
                                ? schema[key]
                                : json::array({schema[key]})) {
      unexplained(part, way, found);
    }
  }
}

TEST(FormatPages, ExplainEveryKey) {
  for (const std::string& name : described_formats()) {
    std::vector<std::string> found;
    unexplained(json::parse(write_format_schema(name)), name, found);
    EXPECT_THAT(found, ::testing::IsEmpty());
  }
}

TEST(FormatPages, GiveTheRangesThatAMachineIsHeldTo) {
  const json machine = json::parse(
      read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good/machine_every_key.json"));
  int tried = 0;
  for (const model::MachineRange& range : model::machine_ranges()) {
    const json::json_pointer place(range.place);
    // A file has a ring or brackets, and the motors' positions depend on one another and the bed.
    if (!machine.contains(place) || range.place.starts_with("/motors")) continue;
    for (const double outside : {range.least, range.most}) {
      json slipped = machine;
      slipped[place] = outside == range.least ? range.least - 1.0 : range.most + 1.0;
      EXPECT_THROW((void)parse_machine(slipped.dump(), "machine.json"), InputError)
          << fmt::format("{} at {}", range.place, slipped[place].get<double>());
      ++tried;
    }
  }
  EXPECT_GT(tried, 30);
}

TEST(FormatPages, RefuseUnknownFormats) {
  EXPECT_THROW((void)write_format_page("holler"), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid::files
