// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Mutated G-code through the whole pipeline: interpreter, compensator, output read back. Nothing
/// may crash or hang, and no output may contain NaN or infinity.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace chaintrue::gcode::fuzz {

/// Runs the bytes through the pipeline; returns what is wrong with the outcome, empty if nothing.
std::string run(const std::string& program);

/// Mutates programs of a corpus: bytes, words, lines, and words of other programs.
class Mutator {
 public:
  Mutator(std::vector<std::string> corpus, std::uint64_t seed);
  std::string next();

 private:
  std::size_t below(std::size_t bound) {
    return bound == 0 ? 0 : static_cast<std::size_t>(random_() % bound);
  }
  void mutate_bytes(std::string& text);
  void mutate_tokens(std::string& text);
  void mutate_lines(std::string& text);

  std::vector<std::string> corpus_;
  std::mt19937_64 random_;
};

/// Small programs that cover every part of the language.
std::vector<std::string> seeds();

}  // namespace chaintrue::gcode::fuzz
