// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The real G-code files, as parameters of tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace chaintrue::testing_support {

inline const std::filesystem::path kCorpus = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "gcode";

/// A file's name in a form that GoogleTest accepts.
inline std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

}  // namespace chaintrue::testing_support
