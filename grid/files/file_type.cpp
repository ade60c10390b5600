// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/file_type.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/csv_table.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::string_view kTypeKey = "file_type";

/// Stops the parser at the value of "file_type" of the outermost object.
class TypeFinder : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t& text) override {
    if (is_type_) {
      found = true;
      type = text;
      return false;
    }
    return value();
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    is_type_ = depth_ == 1 && name == kTypeKey;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

  bool found = false;
  std::string type;

 private:
  bool value() {
    is_type_ = false;
    return true;
  }
  bool open() {
    ++depth_;
    return value();
  }
  bool close() {
    --depth_;
    return true;
  }

  int depth_ = 0;
  bool is_type_ = false;
};

FileKind kind_of_csv(std::string_view text) {
  const std::vector<std::string> header = csv_header(text);
  const bool is_of_holes =
      !header.empty() && (header.front() == "hole" || header.front().starts_with("from"));
  return is_of_holes ? FileKind::holes : FileKind::grid;
}

/// Only a machine on four belts has anchors.
bool names_belts(const std::string& text, const std::string& file) {
  Problems problems(file);
  const Json json = parse_json(text, problems);
  const auto machine = json.find("machine");
  return machine != json.end() && machine->is_object() && machine->contains("anchors");
}

std::string words_of(FileKind kind) {
  if (kind == FileKind::belt_holes) return R"("chaintrue_holes" of a machine on four belts)";
  const auto named = std::find_if(
      kFormats.begin(), kFormats.end(), [&](const Format* one) { return one->kind == kind; });
  return kind == FileKind::other ? "" : fmt::format("\"{}\"", (*named)->file_type);
}

}  // namespace

bool is_json(std::string_view text) {
  text = without_byte_order_mark(text);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  // "[EMC]" is a section of an ini file, "[true]" is JSON that no reader takes.
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const bool is_section =
      text[first] == '[' && first + 1 < text.size() && is_letter(text[first + 1]);
  return text[first] == '{' || (text[first] == '[' && !is_section);
}

std::string file_type_of(const std::string& text, const std::string& file) {
  TypeFinder finder;
  (void)Json::sax_parse(text, &finder);
  if (finder.found) return finder.type;
  // If no type precedes the first syntax error: the whole text, read as leniently as files are.
  Problems problems(file);
  const Json json = parse_json(text, problems);
  if (!json.is_object()) return {};
  const auto type = json.find(kTypeKey);
  return type != json.end() && type->is_string() ? type->get<std::string>() : std::string();
}

std::string what_takes(std::string_view file_type) {
  const Format* format = format_of(file_type);
  if (format == nullptr || format->noun.empty()) return {};
  return format->is_result()
             ? fmt::format(
                   "; this is {}, no measurement: give the file that chaintrue {} was given, "
                   "or the one that it wrote with -o",
                   format->noun,
                   format->verbs)
             : fmt::format("; this is {}; did you mean chaintrue {}?", format->noun, format->verbs);
}

FileKind kind_of(const std::string& text, const std::string& file) {
  if (!is_json(text)) return kind_of_csv(text);
  const Format* format = format_of(file_type_of(text, file));
  if (format == nullptr || format->kind != FileKind::holes)
    return format == nullptr ? FileKind::other : format->kind;
  return names_belts(text, file) ? FileKind::belt_holes : FileKind::holes;
}

std::string expected_kinds(const std::vector<FileKind>& kinds) {
  const auto takes = [&](FileKind kind) { return contains(kinds, kind); };
  std::string words;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
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
