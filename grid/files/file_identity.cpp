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

std::mutex log_mutex;
std::vector<FileIdentity> read_log;

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
  const std::scoped_lock lock(log_mutex);
  if (!contains(read_log, *identity)) read_log.push_back(*identity);
}

void forget_files_read() {
  const std::scoped_lock lock(log_mutex);
  read_log.clear();
}

std::vector<FileIdentity> files_read() {
  const std::scoped_lock lock(log_mutex);
  return read_log;
}

}  // namespace chaintrue::grid::files
