// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An output that appears whole or not at all, written piece by piece.
///
/// The pieces go to a file without the right name, in the folder of the one that is wanted, which
/// then takes the name in one step: whoever looks sees the old file or the new one. Its name is
/// unpredictable and it is made anew (O_EXCL), never opened. Symbolic links are followed, an
/// existing file's rights and owner are kept, one that nobody may write to is refused. Devices,
/// pipes and "-" (standard output) are held in memory and written to at the end, without any
/// temporary file.
///
/// \code
///   PendingFile program("part.true.nc"), page("part.html");
///   program.write(...); page.write(...);
///   take_places({&program, &page});  // both or none
/// \endcode
///
/// Not for two writers of one name at once: the last one wins, whole.
#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::grid::files {

class PendingFile {
 public:
  /// \throws InputError where the path is a folder, lies in none, or may not be written to.
  explicit PendingFile(std::filesystem::path path);
  /// Without take_places nothing stays behind.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// A piece that does not fit on the disk is reported by take_places.
  void write(std::string_view bytes);
  /// Where what was written so far can be read before it takes its place; empty where it is held in
  /// memory.
  [[nodiscard]] std::string flushed();
  [[nodiscard]] const std::string& held() const { return held_; }

 private:
  friend void take_places(const std::vector<PendingFile*>& files);
  void finish();
  void take_name();
  void put_out() const;
  [[noreturn]] void refuse(int error_number);
  void discard();

  std::filesystem::path path_;
  std::filesystem::path target_;  ///< empty where held in memory
  std::string temporary_;
  std::string held_;
  int descriptor_ = -1;
  int slot_ = -1;
  int error_number_ = 0;
};

/// All of them or none: no name is taken before everything lies beside its place. What goes to
/// devices and standard output comes last. \throws InputError for the first that cannot be
/// written, ReaderGone where a pipe's reader left.
void take_places(const std::vector<PendingFile*>& files);

/// The reader of standard output or of a pipe wants no more: not an error of anybody.
class ReaderGone : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "nobody reads the output"; }
};

/// From here on SIGINT, SIGTERM, SIGHUP and SIGPIPE remove what is pending and then end the process
/// as they would have; those that are ignored stay ignored. For a program's main().
void remove_pending_files_on_signals();

}  // namespace chaintrue::grid::files
