// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// fixtures/gcode/corpus: programs with LinuxCNC's stored answers.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/gcode_witness/support/canonical.hpp"

namespace chaintrue::witness {

/// The record files of programs written by hand; `generated` and `follower` are random programs.
inline constexpr std::array kThemes = {"arcs",    "cycles", "expressions", "flow", "hazards",
                                       "machine", "motion", "offsets",     "words"};

struct StoredProgram {
  std::string name;
  std::string text;
  std::string answer;  ///< as linuxcnc_moves.py wrote it
  Answer linuxcnc;     ///< the same, parsed
};

std::string corpus_folder(const std::string& fixtures);

/// The programs of one record file, in its order. \throws std::runtime_error if an answer is missing.
std::vector<StoredProgram> stored_programs(const std::string& fixtures, const std::string& theme);

}  // namespace chaintrue::witness
