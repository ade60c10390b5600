// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files that a result is made from, and the version that makes it.
///
/// \code
///   const Provenance made_by{std::string(version()), "fit", {"--surface direct"}, sources_read()};
/// \endcode
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/provenance.hpp"

namespace chaintrue::grid::files {

/// For this program: "0.1.0".
std::string_view version();

/// A name without folders; "standard input" for "-".
[[nodiscard]] std::string name_without_folders(const std::filesystem::path& path);

/// What read_whole_file() has read on this thread, in that order, each file once for each content.
std::vector<SourceFile> sources_read();
/// For a file that is read in another way.
void note_source(SourceFile source);
/// Starts again, on a thread that does several pieces of work; files_read() is empty then, too.
void forget_sources();
/// What read_whole_file() has read on this thread, including files named by other files. Standard input
/// is /dev/stdin.
std::vector<std::filesystem::path> files_read();
void note_as_read(std::filesystem::path path);
/// What sources_read() says from now on, until forget_sources(): the files that are read on this thread
/// were written for a piece of work, of what these held.
void state_sources(std::vector<SourceFile> sources);

/// The provenance in a map's, diagnosis' or anchors' file; empty if it has none. For a file that
/// was read.
std::optional<Provenance> made_by_of(const std::string& text, const std::string& file);

/// The inputs with the same name as one of `now` but another content.
std::vector<std::string> changed_since(const Provenance& then, const std::vector<SourceFile>& now);

}  // namespace chaintrue::grid::files
