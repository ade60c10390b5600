// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/sources.hpp"

#include <algorithm>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/file_identity.hpp"

namespace chaintrue::grid::files {
namespace {

std::vector<SourceFile>& sources_of_this_thread() {
  thread_local std::vector<SourceFile> sources;
  return sources;
}

std::optional<std::vector<SourceFile>>& stated_sources() {
  thread_local std::optional<std::vector<SourceFile>> sources;
  return sources;
}

}  // namespace

std::string_view version() { return CHAINTRUE_VERSION; }

std::string name_without_folders(const std::filesystem::path& path) {
  return path == "-" ? "standard input" : path.filename().string();
}

std::vector<SourceFile> sources_read() {
  return stated_sources().value_or(sources_of_this_thread());
}

void state_sources(std::vector<SourceFile> sources) { stated_sources() = std::move(sources); }

void note_source(SourceFile source) {
  std::vector<SourceFile>& sources = sources_of_this_thread();
  if (!contains(sources, source)) sources.push_back(std::move(source));
}

void forget_sources() {
  sources_of_this_thread().clear();
  stated_sources().reset();
  forget_files_read();
}

std::vector<std::string> changed_since(const Provenance& then, const std::vector<SourceFile>& now) {
  std::vector<std::string> changed;
  for (const SourceFile& given : now) {
    const auto has_name = [&](const SourceFile& one) { return one.name == given.name; };
    const bool was_there = any_of(then.inputs, has_name);
    const bool is_same = contains(then.inputs, given);
    if (was_there && !is_same) changed.push_back(given.name);
  }
  return changed;
}

}  // namespace chaintrue::grid::files
