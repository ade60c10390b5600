// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A folder with a file of every kind, in which the command runs.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/files.hpp"

namespace chaintrue::inputs {

struct Ran {
  int code = -1;
  std::string out;
  std::string err;
  std::map<std::string, std::string> files;  ///< name and content of what was written
};

using Rows = std::vector<std::vector<std::string>>;
/// The cells, between tabs, of a table in tests/; its lines with # are comments. Empty last cells may lack.
/// \throws std::runtime_error without the table.
Rows rows_of(const std::string& table);

class InputFolder {
 public:
  /// Files made by the command are made when a run first names them.
  InputFolder();

  /// Commands with "; " between, in one empty folder; "@" begins the name of a file of this folder.
  /// Returns how the last one ended and all files that were written. Throws if a file that is named
  /// cannot be made.
  Ran run(const std::string& lines) const;
  std::string text_of(const std::string& file) const;
  void write(const std::string& file, const std::string& text) const;
  /// Further files that the command makes: a table of the lines, each with its "-o @name" at the end.
  void add_made_files(const std::string& table);

 private:
  void make_missing_files(const std::string& lines) const;
  testing_support::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
  mutable std::map<std::string, std::string> lines_;  ///< of files that are not made yet
};

/// With `by` for every `what`.
std::string replaced(std::string text, const std::string& what, const std::string& by);

}  // namespace chaintrue::inputs
