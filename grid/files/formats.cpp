// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace chaintrue::grid::files {
namespace {

/// "1.12" as (1, 12); empty if the text is not a version.
std::optional<std::pair<int, int>> major_and_minor(std::string_view text) {
  std::pair<int, int> version;
  const char* const end = text.data() + text.size();
  const auto [dot, major_fault] = std::from_chars(text.data(), end, version.first);
  if (major_fault != std::errc{} || dot == end || *dot != '.') return std::nullopt;
  const auto [rest, minor_fault] = std::from_chars(dot + 1, end, version.second);
  if (minor_fault != std::errc{} || rest != end) return std::nullopt;
  return version;
}

bool is_newer(const Format& format, std::string_view found) {
  const auto version = major_and_minor(found);
  return version && *version > *major_and_minor(format.version);
}

}  // namespace

std::string name_of(const Format& format) {
  constexpr std::string_view kBegin = "chaintrue_";
  return std::string(format.file_type.substr(kBegin.size()));
}

Json headed(const Format& format) {
  Json file = Json::object();
  file["file_type"] = format.file_type;
  file["format_version"] = format.version;
  return file;
}

const OlderVersion* find_older(const Format& format, const Json& version) {
  const auto found =
      std::find_if(format.older.begin(), format.older.end(), [&](const OlderVersion& older) {
        return version == older.version;
      });
  return found == format.older.end() ? nullptr : &*found;
}

std::string expected_version(const Format& format, const Json& found) {
  std::string versions;
  for (const OlderVersion& older : format.older)
    versions += fmt::format("\"{}\" or ", older.version);
  versions += fmt::format("\"{}\"", format.version);
  if (found.is_string() && is_newer(format, found.get_ref<const std::string&>())) {
    return fmt::format(
        "{}; this file is of version {}, newer than {}, the newest that this program reads: take "
        "the chaintrue that wrote it, or a newer one",
        versions,
        found.get_ref<const std::string&>(),
        format.version);
  }
  return fmt::format(
      "{}, the version{} that this program reads", versions, format.older.empty() ? "" : "s");
}

}  // namespace chaintrue::grid::files
