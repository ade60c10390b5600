// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/log_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "grid/files/input_error.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::live {

namespace files = grid::files;

void LogFile::open() {
  constexpr int kReadableByAll = 0644;
  descriptor_ =
      path_ == "-"
          ? ::dup(STDOUT_FILENO)
          : ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kReadableByAll);
  if (descriptor_ < 0) error_number_ = errno;
}

LogFile::~LogFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void LogFile::write(std::string_view bytes) {
  if (descriptor_ < 0 && error_number_ == 0) open();
  while (!bytes.empty() && error_number_ == 0) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      error_number_ = errno;
    }
  }
}

void LogFile::check() const {
  if (error_number_ == 0) return;
  throw files::InputError({{files::name_in_messages(path_),
                            "",
                            files::system_words(error_number_),
                            "a place that takes everything the machine prints; what came before is "
                            "there"}});
}

}  // namespace chaintrue::live
