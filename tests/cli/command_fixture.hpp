// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the command as a script does: in a temporary folder, with its exit code and both streams.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace chaintrue::testing_support {

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A map, a diagnosis or anchors without where they come from, and without the hash of that.
inline std::string without_origin(std::string text) {
  const std::size_t begin = text.find(",\n  \"made_by\": ");
  if (begin == std::string::npos) return text;
  return text.erase(begin, text.rfind("\n}") - begin);
}

class CommandFixture : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = std::filesystem::temp_directory_path() / "chaintrue-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return run_line("chaintrue " + arguments);
  }
  /// Runs any shell line in the folder.
  [[nodiscard]] Outcome run_line(const std::string& shell) const {
    const std::string line = "cd " + folder_.string() +
                             " && PATH=$(dirname " CHAINTRUE_COMMAND "):$PATH && { " + shell +
                             "\n} >out.txt 2>err.txt";
    const int status = std::system(line.c_str());
    return {WEXITSTATUS(status), content_of(folder_ / "out.txt"), content_of(folder_ / "err.txt")};
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(folder_ / name);
  }

  std::filesystem::path folder_;
};

}  // namespace chaintrue::testing_support
