// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the command for the tests of inputs: files of every kind in one folder, each run in an empty
/// folder, and the numbers of its answer.
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
  /// Name and content of the written files.
  std::map<std::string, std::string> files;
};

class Workshop {
 public:
  /// Makes the files of every kind; throws if one cannot be made.
  Workshop();
  ~Workshop();
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  /// Runs commands separated by "; " in one empty folder; "@" begins the name of a file of the
  /// workshop. Returns the result of the last one, and every file that exists then.
  [[nodiscard]] Ran run(const std::string& lines) const;
  [[nodiscard]] std::string text_of(const std::string& file) const;
  void write(const std::string& file, const std::string& text) const;

 private:
  void make(const std::string& line) const;
  std::filesystem::path folder_;
};

/// The numbers of an answer: of JSON every number except those under a key that repeats the input,
/// of other text every number. Texts that name files or seeds are not numbers.
[[nodiscard]] std::string numbers_of(const Ran& ran, const std::vector<std::string>& echoes);

}  // namespace chaintrue::inputs
