// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the command for the tests of inputs: files of every kind in one folder, each run in an empty
/// folder of its own, and the numbers of what it answered.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace chaintrue::inputs {

struct Ran {
  int code = -1;
  std::string out;
  std::string err;
  /// Name and content of what was written.
  std::map<std::string, std::string> files;
};

class Workshop {
 public:
  /// Files of every kind. What the command makes itself, it makes once a run names it: the workshop is
  /// built anew for each test, and few need all.
  Workshop();
  ~Workshop();
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  /// Commands with "; " between, in one empty folder; "@" begins the name of a file of the workshop.
  /// What the last one ended with, and every file that is there then. Throws where a file that is
  /// named cannot be made.
  [[nodiscard]] Ran run(const std::string& lines) const;
  [[nodiscard]] std::string text_of(const std::string& file) const;
  void write(const std::string& file, const std::string& text) const;

 private:
  void make_what_is_missing(const std::string& lines) const;
  std::filesystem::path folder_;
  /// By the file: the lines of those that are not made yet.
  mutable std::map<std::string, std::string> lines_;
};

/// The numbers of an answer: of JSON every number but those under a key that repeats the input, of
/// other text every number. Texts that name files or seeds are none.
[[nodiscard]] std::string numbers_of(const Ran& ran, const std::vector<std::string>& echoes);

}  // namespace chaintrue::inputs
