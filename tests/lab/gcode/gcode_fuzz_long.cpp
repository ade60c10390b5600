// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The long run: `gcode_fuzz SECONDS SEED [FILE...]`. A program that fails is written to
/// gcode_fuzz_failure.nc; with KEEP=1 in the environment every program is written before it runs, so
/// that one that crashes is there too.
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/fuzz/gcode_fuzz.hpp"

int main(int argc, char** argv) {
  using namespace chaintrue::gcode::fuzz;
  std::uint64_t seconds = 600;
  std::uint64_t seed = 1;
  if (argc > 1) std::from_chars(argv[1], argv[1] + std::strlen(argv[1]), seconds);
  if (argc > 2) std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), seed);
  auto corpus = seeds();
  for (int i = 3; i < argc; ++i) {
    std::ifstream file(argv[i], std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    corpus.push_back(text.str());
  }
  const auto keep = [](const std::string& program) {
    std::ofstream("gcode_fuzz_failure.nc", std::ios::binary) << program;
  };
  const bool keep_all = std::getenv("KEEP") != nullptr;
  Mutator mutator(corpus, seed);
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t programs = 0;
  double slowest_s = 0.0;
  while (std::chrono::steady_clock::now() - begin < std::chrono::seconds(seconds)) {
    const std::string program = mutator.next();
    if (keep_all) keep(program);
    const auto start = std::chrono::steady_clock::now();
    const std::string wrong = run(program);
    slowest_s = std::max(
        slowest_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    ++programs;
    if (wrong.empty()) continue;
    keep(program);
    fmt::print("seed {}, program {}: {}\n", seed, programs, wrong);
    return 1;
  }
  fmt::print("seed {}: {} programs in {} s, the slowest took {:.2f} s; nothing wrong\n", seed,
             programs, seconds, slowest_s);
  return 0;
}
