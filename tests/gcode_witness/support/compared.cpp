// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/compared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tests/gcode_witness/support/program_generator.hpp"
#include "tests/gcode_witness/support/shrink.hpp"

namespace chaintrue::witness {
namespace {

/// Many programs in one batch.
std::vector<std::optional<std::string>> differences(const std::vector<std::string>& programs,
                                                    std::size_t* accepted = nullptr) {
  std::vector<Record> asked;
  for (const std::string& program : programs) asked.push_back({"program", program});
  const auto truths = ask_linuxcnc(asked);
  std::vector<std::optional<std::string>> found;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const Answer linuxcnc = read_truth(truths[i].text);
    if (accepted != nullptr && linuxcnc.accepted) ++*accepted;
    found.push_back(unlisted_difference(programs[i], linuxcnc, limited(programs[i])));
  }
  return found;
}

std::vector<bool> differ(const std::vector<std::string>& programs) {
  std::vector<bool> result;
  for (const auto& found : differences(programs)) result.push_back(found.has_value());
  return result;
}

}  // namespace

Answer limited(const std::string& program) {
  gcode::Dialect dialect;
  dialect.step_budget = 100'000;
  return ours(program, dialect);
}

/// Programs for which LinuxCNC 2.9 itself is wrong, by seed: a break in a while loop that is not
/// entered ends a later loop (reduced: o100 while [0] / o100 break / o100 endwhile / o102 do / o102
/// while [1] comes to its end there, though its last loop is endless).
constexpr std::array<std::uint64_t, 1> kLinuxCncErrs = {1180};

LanguageRun compare_language(std::uint64_t first_seed,
                             std::uint64_t count,
                             std::size_t most_reduced) {
  constexpr std::uint64_t kBatch = 500;
  LanguageRun run;
  for (std::uint64_t from = 0; from < count; from += kBatch) {
    std::vector<std::string> programs;
    for (std::uint64_t i = from; i < std::min(from + kBatch, count); ++i)
      programs.push_back(random_program(first_seed + i));
    const auto found = differences(programs, &run.accepted);
    for (std::size_t i = 0; i < programs.size(); ++i) {
      if (!found[i]) continue;
      if (std::find(kLinuxCncErrs.begin(), kLinuxCncErrs.end(), first_seed + from + i) !=
          kLinuxCncErrs.end()) {
        continue;
      }
      ++run.different;
      if (run.failures.size() >= most_reduced) continue;
      const std::string small = shrink(programs[i], differ);
      run.failures.push_back(fmt::format("seed {}:\n{}{}",
                                         first_seed + from + i,
                                         small,
                                         differences({small}).front().value_or(*found[i])));
    }
  }
  return run;
}

}  // namespace chaintrue::witness
