// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The file that everything received is saved to, the moment it comes: a line that is not complete
/// too, so that whatever ends the program or the machine, the file holds all of it.
///
/// \code
///   LogFile file("maslow4.log");
///   file.write(bytes);
///   file.check();   // throws where the disk is full
/// \endcode
#pragma once

#include <atomic>
#include <string>
#include <string_view>
#include <utility>

namespace chaintrue::live {

class LogFile {
 public:
  /// The file is made anew with the first byte: a machine that is not there leaves none, and an older
  /// log stays.
  explicit LogFile(std::string path) : path_(std::move(path)) {}
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  /// From one thread at a time. An error is kept for check().
  void write(std::string_view bytes);
  /// \throws files::InputError where something could not be written.
  void check() const;

 private:
  void open();

  std::string path_;
  int descriptor_ = -1;
  std::atomic<int> error_number_{0};
};

}  // namespace chaintrue::live
