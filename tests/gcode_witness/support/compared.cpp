// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/compared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "tests/gcode_witness/support/program_generator.hpp"

namespace chaintrue::witness {

Answer limited(const std::string& program) {
  gcode::Dialect dialect;
  dialect.step_budget = 100'000;
  return ours(program, dialect);
}

/// Whether the program triggers a bug of LinuxCNC 2.9: a break that is skipped because the condition of
/// its while loop is false also ends a later do loop. Smallest example: o100 while [0] / o100 break /
/// o100 endwhile / o102 do / o102 while [1] ends, although the last loop is endless.
bool linuxcnc_errs(const std::string& program) {
  static const std::regex kBreakNotReached(R"(while \[#30 LT [01]\]\n.*\n.* if .*\n.* break\n)");
  return std::regex_search(program, kBreakNotReached);
}

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
      const Answer linuxcnc = read_truth(truths[i].text);
      run.accepted += linuxcnc.accepted ? 1 : 0;
      const auto difference = unlisted_difference(programs[i], linuxcnc, limited(programs[i]));
      if (!difference || linuxcnc_errs(programs[i])) continue;
      ++run.different;
      if (run.failures.size() < most_reported)
        run.failures.push_back(
            fmt::format("seed {}: {}\n{}", first_seed + from + i, *difference, programs[i]));
    }
  }
  return run;
}

}  // namespace chaintrue::witness
