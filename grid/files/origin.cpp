// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/origin.hpp"

#include <algorithm>

#include "grid/containers.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/json_text.hpp"
#include "grid/files/provenance_record.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::string_view kSignature =
    "Written by chaintrue and not changed since, if its content has the hash ";
constexpr std::string_view kMark = "<!-- made by chaintrue -->";
constexpr std::string_view kPageHead = "<!DOCTYPE html>\n";

/// A kind that may hold what somebody measured or typed.
bool is_signed(Origin kind) { return kind == Origin::measured || kind == Origin::machine; }

/// foreign if the text is not of a known format.
Origin origin_by_type(const Json& document) {
  if (!document.is_object() || !document.contains("file_type")) return Origin::foreign;
  const Json& type = document.at("file_type");
  const Format* format = type.is_string() ? format_of(type.get<std::string>()) : nullptr;
  return format == nullptr ? Origin::foreign : format->origin;
}

/// The last words of the description of a file format's kind.
constexpr std::string_view kPageOfFormat = "` writes this page from the reader's tables.";
constexpr std::string_view kSchemaOfFormat =
    "{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n  \"title\": \"chaintrue_";

/// The first words of results.
constexpr std::string_view kTables[] = {
    "# Kinematics for Klipper, written by chaintrue export klipper: ",
    "/* Kinematics for LinuxCNC, written by chaintrue export linuxcnc: ",
    "cell,machine,effects,used_on,",
    "x_mm,y_mm,left_mm,right_mm,left_sigma_mm,right_sigma_mm,status\n",
    "x_mm,y_mm,status\n",
    "line,kind,x_mm,y_mm,z_mm,left_mm,right_mm,",
    "[\n  {\"x_mm\": ",
    "{\"line\": ",
    "{\"x_mm\": "};

/// The comments of a file's root, one by one.
Words comments_of(const Json& document) {
  Words comments;
  const Json comment = document.value("comment", Json::array());
  for (const Json& line : comment.is_array() ? comment : Json::array({comment})) {
    if (line.is_string()) comments.push_back(line.get<std::string>());
  }
  return comments;
}

bool is_as_signed(const Json& document) {
  return contains(comments_of(document), std::string(kSignature) + content_hash(document));
}

Origin origin_of_json(const std::string& text) {
  Json document;
  try {
    document = parse_json(text, "");
  } catch (const InputError&) {
    return Origin::foreign;
  }
  const Origin origin = origin_by_type(document);
  return is_signed(origin) && !is_as_signed(document) ? Origin::changed : origin;
}

/// The last line of a signed list.
std::string signature_line(std::string_view text) {
  return "# " + std::string(kSignature) + content_hash(Json(std::string(text))) + "\n";
}

Origin origin_of_list(std::string_view text) {
  const std::size_t begin = text.rfind("# " + std::string(kSignature));
  if (begin == npos) return Origin::foreign;
  return text.substr(begin) == signature_line(text.substr(0, begin)) ? Origin::list
                                                                     : Origin::changed;
}

std::string signed_json(const std::string& text, Origin kind) {
  const Json document = parse_json(text, "");
  if (origin_by_type(document) != kind) return text;
  Words comments = comments_of(document);
  std::erase_if(comments, [](const std::string& own) { return own.starts_with(kSignature); });
  comments.push_back(std::string(kSignature) + content_hash(document));
  Json out = Json::object();
  for (const auto& [key, value] : document.items()) {
    if (key == "comment") continue;
    out[key] = value;
    if (key != "format_version") continue;
    out["comment"] = comments.size() == 1 ? Json(comments.front()) : Json(comments);
  }
  return print_json(out);
}

}  // namespace

Origin origin_of(std::string_view text) {
  for (const std::string_view head : kTables) {
    if (text.starts_with(head)) return Origin::table;
  }
  if (text.starts_with(kSchemaOfFormat) || has(text, kPageOfFormat)) return Origin::description;
  if (text.starts_with("{")) return origin_of_json(std::string(text));
  if (text.starts_with(std::string(kPageHead) + std::string(kMark))) return Origin::page;
  const std::string_view first_line = text.substr(0, text.find('\n'));
  if (first_line.starts_with("<svg") && first_line.ends_with(kMark)) return Origin::drawing;
  if (first_line.starts_with("(compensated by chaintrue") ||
      first_line.starts_with("(chaintrue plan:") || first_line.starts_with("(chaintrue square:") ||
      first_line.starts_with("; chaintrue start:")) {
    return Origin::program;
  }
  if (has(text, "\nMeasured less map  ")) return Origin::table;
  return origin_of_list(text);
}

std::string signed_text(const std::string& text, Origin kind) {
  if (text.starts_with("{") && is_signed(kind)) return signed_json(text, kind);
  if (kind == Origin::list && !text.starts_with("{")) return text + signature_line(text);
  if (kind == Origin::page && text.starts_with(kPageHead))
    return std::string(kPageHead) + std::string(kMark) + "\n" + text.substr(kPageHead.size());
  if (kind == Origin::drawing && text.starts_with("<svg")) {
    const std::size_t end = text.find('\n');
    return text.substr(0, end) + std::string(kMark) + text.substr(std::min(end, text.size()));
  }
  return text;
}

}  // namespace chaintrue::grid::files
