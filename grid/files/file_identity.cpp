// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/file_identity.hpp"

#include <sys/stat.h>

#include <mutex>

#include "grid/containers.hpp"

namespace chaintrue::grid::files {
namespace {

std::optional<FileIdentity> identity_from(const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  return FileIdentity{static_cast<std::uint64_t>(status.st_dev),
                      static_cast<std::uint64_t>(status.st_ino)};
}

struct ReadLog {
  std::mutex mutex;
  std::vector<FileIdentity> files;
};

ReadLog& read_log() {
  static ReadLog log;
  return log;
}

}  // namespace

std::optional<FileIdentity> identity_of(const std::filesystem::path& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return identity_from(status);
}

std::optional<FileIdentity> identity_of_descriptor(int descriptor) {
  struct stat status = {};
  if (::fstat(descriptor, &status) != 0) return std::nullopt;
  return identity_from(status);
}

void note_as_read(int descriptor) {
  const auto identity = identity_of_descriptor(descriptor);
  if (!identity) return;
  ReadLog& log = read_log();
  const std::scoped_lock lock(log.mutex);
  if (!contains(log.files, *identity)) log.files.push_back(*identity);
}

void forget_files_read() {
  ReadLog& log = read_log();
  const std::scoped_lock lock(log.mutex);
  log.files.clear();
}

std::vector<FileIdentity> files_read() {
  ReadLog& log = read_log();
  const std::scoped_lock lock(log.mutex);
  return log.files;
}

}  // namespace chaintrue::grid::files
