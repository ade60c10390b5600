// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reads whole files, and writes files completely or not at all (see pending_file.hpp). "-" is
/// standard input and standard output.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace chaintrue::grid::files {

/// A path's name in messages: itself, or "standard input" for "-".
std::string name_in_messages(const std::filesystem::path& path);
/// \throws InputError if the path cannot be opened, is a directory, or reading fails half-way.
std::string read_whole_file(const std::filesystem::path& path);
/// The file by one of the functions that parse a text: read(parse_grid, "grid.json", {.few = true}).
/// "-" is standard input.
template <class T>
T read(T (*parse)(const std::string& text, const std::string& file),
       const std::filesystem::path& path) {
  return parse(read_whole_file(path), name_in_messages(path));
}
template <class T, class Options>
T read(T (*parse)(const std::string& text, const std::string& file, Options options),
       const std::filesystem::path& path, std::type_identity_t<Options> options = {}) {
  return parse(read_whole_file(path), name_in_messages(path), options);
}
/// \throws InputError if the path is a directory, its directory is missing, or it cannot be
/// written.
void write_whole_file(const std::filesystem::path& path, std::string_view text);

struct OutputFile {
  std::filesystem::path path;
  std::string text;
};
/// All of them or none: no file is renamed before all are completely written. Devices and standard
/// output come last. \throws InputError as write_whole_file, for the first that fails, and if two
/// outputs are the same file; ReaderGone if a pipe's reader is gone.
void write_whole_files(const std::vector<OutputFile>& outputs);

}  // namespace chaintrue::grid::files
