// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/file_type.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/csv_table.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {
namespace {

FileKind kind_of_csv(std::string_view text) {
  const Words header = csv_header(text);
  const bool is_of_holes =
      !header.empty() && (header.front() == "hole" || header.front().starts_with("from"));
  return is_of_holes ? FileKind::holes : FileKind::grid;
}

/// Empty if there is none.
std::string file_type_in(const Json& document) {
  return document.is_object() && document.contains("file_type") && document["file_type"].is_string()
             ? document["file_type"].get<std::string>()
             : "";
}

/// As far as it is JSON. \throws InputError if it ends or is malformed before its type is known.
Json head_of(const std::string& text, const std::string& file) {
  Problems problems(file);
  Json head = parse_head(text, problems);
  if (file_type_in(head).empty()) problems.throw_if_any();
  return head;
}

std::string words_of(FileKind kind) {
  if (kind == FileKind::belt_holes) return R"("chaintrue_holes" of a machine on four belts)";
  if (kind == FileKind::other) return "";
  const auto* named = find_where(kFormats, having(&Format::kind, kind));
  return fmt::format("\"{}\"", (*named)->file_type);
}

}  // namespace

const Format* format_of(std::string_view file_type) {
  const auto* found = find_where(kFormats, having(&Format::file_type, file_type));
  return found != nullptr ? *found : nullptr;
}

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

bool is_json(std::string_view text) {
  text = without_byte_order_mark(text);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == npos) return false;
  // "[EMC]" is a section of an ini file, "[true]" is JSON that no reader accepts.
  const bool is_section =
      text[first] == '[' && first + 1 < text.size() && is_letter(text[first + 1]);
  return text[first] == '{' || (text[first] == '[' && !is_section);
}

std::string file_type_of(const std::string& text, const std::string& file) {
  return file_type_in(head_of(text, file));
}

std::string what_takes(std::string_view file_type) {
  const Format* format = format_of(file_type);
  if (format == nullptr || format->noun.empty()) return {};
  return format->anew.empty()
             ? fmt::format(
                   "; this is {}, not a measurement: use the input of chaintrue {}, or the file "
                   "that it wrote with -o",
                   format->noun, format->verbs)
             : fmt::format("; this is {}; did you mean chaintrue {}?", format->noun, format->verbs);
}

FileKind kind_of(const std::string& text, const std::string& file) {
  if (!is_json(text)) return kind_of_csv(text);
  const Json head = head_of(text, file);
  const Format* format = format_of(file_type_in(head));
  if (format == nullptr) return FileKind::other;
  // Only a machine on four belts has anchors.
  const Json machine = head.value("machine", Json());
  return format->kind == FileKind::holes && machine.contains("anchors") ? FileKind::belt_holes
                                                                        : format->kind;
}

std::string expected_kinds(const std::vector<FileKind>& kinds) {
  const auto takes = [&](FileKind kind) { return contains(kinds, kind); };
  std::string words;
  for (const auto k : each_index(kinds)) {
    // Both kinds of holes have one name.
    if (kinds[k] == FileKind::belt_holes && takes(FileKind::holes)) continue;
    const bool is_last = k + 1 == kinds.size();
    words += (words.empty() ? "" : is_last ? " or " : ", ") + words_of(kinds[k]);
  }
  return words;
}

std::string found_kind(const std::string& text, const std::string& file) {
  if (!is_json(text))
    return kind_of_csv(text) == FileKind::holes ? "a CSV of holes" : "a CSV of points";
  if (kind_of(text, file) == FileKind::belt_holes) return words_of(FileKind::belt_holes);
  const std::string type = file_type_of(text, file);
  return type.empty() ? "" : fmt::format("\"{}\"", type);
}

}  // namespace chaintrue::grid::files
