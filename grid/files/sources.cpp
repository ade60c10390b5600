// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/sources.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/containers.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/sha256.hpp"

namespace chaintrue::grid::files {
namespace {

thread_local std::vector<SourceFile> noted_sources;
thread_local std::optional<std::vector<SourceFile>> stated_sources;
thread_local std::vector<std::filesystem::path> read_paths;

}  // namespace

std::string_view version() { return CHAINTRUE_VERSION; }

std::string name_without_folders(const std::filesystem::path& path) {
  return path == "-" ? "standard input" : path.filename().string();
}

std::vector<SourceFile> sources_read() { return stated_sources.value_or(noted_sources); }

void state_sources(std::vector<SourceFile> sources) { stated_sources = std::move(sources); }

void note_source(SourceFile source) {
  if (!contains(noted_sources, source)) noted_sources.push_back(std::move(source));
}

void forget_sources() {
  noted_sources.clear();
  stated_sources.reset();
  read_paths.clear();
}

std::vector<std::filesystem::path> files_read() { return read_paths; }

void note_as_read(std::filesystem::path path) { read_paths.push_back(std::move(path)); }

Words changed_since(const Provenance& then, const std::vector<SourceFile>& now) {
  Words changed;
  for (const SourceFile& given : now) {
    const bool was_there = any_of(then.inputs, having(&SourceFile::name, given.name));
    const bool is_same = contains(then.inputs, given);
    if (was_there && !is_same) changed.push_back(given.name);
  }
  return changed;
}

namespace {

RECORD_OF(SourceFile, "a file that was read")
REQUIRED(name, "Its name, without folders.")
REQUIRED(sha256, "SHA-256 of its bytes, 64 hexadecimal digits, as sha256sum prints it.")
END_RECORD;

}  // namespace

Record<Provenance> provenance_record() {
  RECORD(Provenance, "where a result comes from")
  REQUIRED(version, "Version of chaintrue.")
  REQUIRED(verb, "Verb of the command, or function, that made it.")
  REQUIRED(options,
           "Options as given, with files without their folders and without those that "
           "name an output.")
  REQUIRED(inputs, "The files that were read, in order.");
}

Json with_made_by(Json document, const std::optional<Provenance>& made_by) {
  if (made_by) document["made_by"] = provenance_record().write(*made_by);
  return document;
}

std::optional<Provenance> made_by_of(const std::string& text, const std::string& file) {
  Problems problems(file);
  const Json document = parse_json(text, problems);
  if (!document.is_object() || !document.contains("made_by")) return std::nullopt;
  return provenance_record().read(Cursor(document, problems).child("made_by"));
}

namespace {

/// A number's text depends on its value alone, however it was written.
std::string hashed_text(const Json& value, bool is_root) {
  if (value.is_number()) return fmt::format("{}", value.get<double>() + 0.0);
  if (!value.is_structured()) return compact_json(value);
  std::string text = value.is_object() ? "{" : "[";
  for (const auto& [key, element] : value.items()) {
    if (value.is_object()) {
      if (key == "comment" || (is_root && key == "content_hash")) continue;
      text += compact_json(key) + ":";
    }
    text += hashed_text(element, false) + ",";
  }
  return text + (value.is_object() ? "}" : "]");
}

}  // namespace

std::string content_hash(const Json& document) { return sha256(hashed_text(document, true)); }

std::string print_with_hash(Json document) {
  std::string hash = content_hash(document);
  document["content_hash"] = std::move(hash);
  return print_json(document);
}

void check_content(const Cursor& at) {
  const Cursor hash = at.child("content_hash");
  if (hash.json() != content_hash(at.json())) {
    hash.expect(
        "the hash of this file's content: the file was changed or damaged after it was written; "
        "fit the points again",
        ProblemKind::content_hash);
  }
}

}  // namespace chaintrue::grid::files
