// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An output file that is written piece by piece and appears complete or not at all.
///
/// The pieces go to a temporary file in the target's folder, which is then renamed in one step:
/// readers see either the old file or the new one. Its name is unpredictable and it is created with
/// O_EXCL. Symbolic links are followed, also to where no file is yet; permissions and owner of an
/// existing file are kept, a file without write permission is rejected. Output to devices, pipes and
/// "-" (standard output) is held in memory and written at the end, without a temporary file.
///
/// \code
///   PendingFile program("part.true.nc"), page("part.html");
///   program.write(...); page.write(...);
///   take_places({&program, &page});  // both or none
/// \endcode
///
/// With two writers of the same name the last one wins, with its complete file.
#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::grid::files {

struct PendingName;

class PendingFile {
 public:
  /// \throws InputError if the path is a folder, its folder does not exist, or it may not be
  /// written to.
  explicit PendingFile(std::filesystem::path path);
  /// Removes the temporary file unless take_places was called.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// An error, such as a full disk, is reported by take_places.
  void write(std::string_view bytes);
  /// A file with what was written so far, before it takes its place; empty if the output is held in
  /// memory.
  std::string flushed();
  const std::string& held() const { return held_; }

 private:
  friend void take_places(const std::vector<PendingFile*>& files);
  void finish();
  void take_name();
  void put_out() const;
  [[noreturn]] void refuse(int error_number);
  void discard();

  std::filesystem::path path_;
  std::filesystem::path target_;  ///< empty if held in memory
  std::string temporary_;
  std::string held_;
  int descriptor_ = -1;
  PendingName* slot_ = nullptr;
  int error_number_ = 0;
};

/// Renames all of them or none: no file is renamed before all are completely written, and where one
/// fails, output to devices and standard output included, the others are as they were. \throws
/// InputError for the first that cannot be written, ReaderGone, with the files in place, if a pipe's
/// reader is gone.
void take_places(const std::vector<PendingFile*>& files);

/// The reader of standard output or of a pipe has closed it: not an error.
class ReaderGone : public std::exception {
 public:
  const char* what() const noexcept override { return "the output was closed by its reader"; }
};

/// After this call SIGINT, SIGTERM, SIGHUP and SIGPIPE remove pending files and then end the
/// process as before; ignored signals stay ignored. For a program's main().
void remove_pending_files_on_signals();

}  // namespace chaintrue::grid::files
