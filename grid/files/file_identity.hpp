// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which file a path means, whatever it is called: `g.json`, `./g.json`, a link to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace chaintrue::grid::files {

/// Device and number on the device. Two paths with one identity are one file.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t number = 0;
  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

/// The regular file behind a path, symbolic links followed; nothing where there is none, or a
/// device, a pipe or a folder.
[[nodiscard]] std::optional<FileIdentity> identity_of(const std::filesystem::path& path);
/// The regular file that an open descriptor (1: standard output) goes to.
[[nodiscard]] std::optional<FileIdentity> identity_of_descriptor(int descriptor);

/// Every regular file that read_whole_file has read in this process, also those that only another
/// file named. Safe from any thread.
[[nodiscard]] std::vector<FileIdentity> files_read();

}  // namespace chaintrue::grid::files
