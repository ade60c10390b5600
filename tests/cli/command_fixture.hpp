// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the command as a script does: in a temporary folder, with its exit code and both streams.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/files.hpp"
#include "tests/support/process.hpp"

namespace chaintrue::testing_support {

inline std::string content_of(const std::filesystem::path& path) { return read_text(path); }

/// A map, a diagnosis or anchors without where they come from, and without the hash of that.
inline std::string without_origin(std::string text) {
  const std::size_t begin = text.find(",\n  \"made_by\": ");
  if (begin == std::string::npos) return text;
  return text.erase(begin, text.rfind("\n}") - begin);
}

class CommandFixture : public testing::Test {
 protected:
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return run_line("chaintrue " + arguments);
  }
  /// The same of a command that must succeed.
  Outcome done(const std::string& arguments) const {
    Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments << "\n" << outcome.out << outcome.err;
    return outcome;
  }
  /// Runs any shell line in the folder.
  [[nodiscard]] Outcome run_line(const std::string& shell) const {
    return testing_support::run_line(folder_, shell);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

 private:
  TemporaryFolder temporary_;

 protected:
  std::filesystem::path folder_ = temporary_.path();
};

}  // namespace chaintrue::testing_support
