// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Identity of the file that a path names, however it is written: g.json, ./g.json, a link to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace chaintrue::grid::files {

/// Device and inode. Two paths with equal identity are the same file.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t number = 0;
  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

/// The regular file that a path names, symbolic links followed; empty if there is none, or it is a
/// device, a pipe or a folder.
std::optional<FileIdentity> identity_of(const std::filesystem::path& path);
/// The regular file of an open descriptor (1: standard output).
std::optional<FileIdentity> identity_of_descriptor(int descriptor);

/// Every regular file that read_whole_file has read in this process, including files named by other
/// files. Thread safe.
std::vector<FileIdentity> files_read();

// The list behind files_read(). Private to grid/files.

/// Adds the regular file of an open descriptor to files_read().
void note_as_read(int descriptor);
/// The number of a file that was deleted may be that of the next one written.
void forget_files_read();

}  // namespace chaintrue::grid::files
