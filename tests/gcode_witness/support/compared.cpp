// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/compared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tests/gcode_witness/support/program_generator.hpp"

namespace chaintrue::witness {

Answer limited(const std::string& program) {
  gcode::Dialect dialect;
  dialect.step_budget = 100'000;
  return ours(program, dialect);
}

/// Programs for which LinuxCNC 2.9 itself is wrong, by seed: a break in a while loop that is not
/// entered ends a later loop (reduced: o100 while [0] / o100 break / o100 endwhile / o102 do / o102
/// while [1] comes to its end there, though its last loop is endless).
constexpr std::array<std::uint64_t, 1> kLinuxCncErrs = {1180};

LanguageRun compare_language(std::uint64_t first_seed, std::uint64_t count,
                             std::size_t most_reported) {
  constexpr std::uint64_t kBatch = 500;
  LanguageRun run;
  for (std::uint64_t from = 0; from < count; from += kBatch) {
    std::vector<std::string> programs;
    for (std::uint64_t i = from; i < std::min(from + kBatch, count); ++i)
      programs.push_back(random_program(first_seed + i));
    std::vector<Record> asked;
    for (const std::string& program : programs) asked.push_back({"program", program});
    const auto truths = ask_linuxcnc(asked);
    for (std::size_t i = 0; i < programs.size(); ++i) {
      const std::uint64_t seed = first_seed + from + i;
      const Answer linuxcnc = read_truth(truths[i].text);
      run.accepted += linuxcnc.accepted ? 1 : 0;
      const auto difference = unlisted_difference(programs[i], linuxcnc, limited(programs[i]));
      if (!difference || std::ranges::find(kLinuxCncErrs, seed) != kLinuxCncErrs.end()) continue;
      ++run.different;
      if (run.failures.size() < most_reported)
        run.failures.push_back(fmt::format("seed {}: {}\n{}", seed, *difference, programs[i]));
    }
  }
  return run;
}

}  // namespace chaintrue::witness
