// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random programs through both interpreters, and how they differ.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/gcode_witness/support/canonical.hpp"
#include "tests/gcode_witness/support/linuxcnc.hpp"

namespace chaintrue::witness {

/// Programs with comparable answers, of each hundred random ones.
inline constexpr std::size_t kLeastAccepted = 80;

struct LanguageRun {
  std::size_t accepted = 0;   ///< by LinuxCNC
  std::size_t different = 0;  ///< without those for which LinuxCNC is wrong (compared.cpp)
  /// Seed, difference and program, of the first few.
  std::vector<std::string> failures;
};

/// Our answer, with a small budget of steps for endless programs.
Answer limited(const std::string& program);

/// Seeds from the first on; runs LinuxCNC.
LanguageRun compare_language(std::uint64_t first_seed, std::uint64_t count,
                             std::size_t most_reported);

}  // namespace chaintrue::witness
