// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The long runs:
///
///     gcode_witness_long follow [COUNT [SEED [SHARE SHARES]]]    compensated programs on a simulated machine, ten thousand by default
///     gcode_witness_long language [COUNT [SEED]]                 our interpreter compared with LinuxCNC's
///     gcode_witness_long output [COUNT [SEED]]                   compensated output read by both
///     gcode_witness_long generate FOLDER                         the programs that the tests store with their answers
///
/// Exit code 1 for any difference; each difference is printed with its seed.
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "grid/files/whole_file.hpp"
#include "tests/gcode_witness/support/compared.hpp"
#include "tests/gcode_witness/support/follow_run.hpp"
#include "tests/gcode_witness/support/output_run.hpp"
#include "tests/gcode_witness/support/program_generator.hpp"

namespace chaintrue::witness {
namespace {

constexpr std::size_t kMostReported = 20;

int reported(const std::vector<std::string>& failures, std::size_t count) {
  for (const std::string& failure : failures) fmt::print("{}\n\n", failure);
  return count == 0 ? 0 : 1;
}

int run_follow(std::uint64_t count, std::uint64_t seed, std::uint64_t share, std::uint64_t shares) {
  const FollowRun run = follow(CHAINTRUE_FIXTURES, {seed, count, kMostReported, share, shares});
  fmt::print("{} programs from seed {}: {} compensated, {} changed outputs judged, {} wrong\n",
             run.programs, seed, run.compensated, run.judged_moved, run.failed);
  return reported(run.failures, run.failed);
}

int run_language(std::uint64_t count, std::uint64_t seed) {
  const LanguageRun run = compare_language(seed, count, kMostReported);
  fmt::print("{} programs from seed {}: {} accepted by LinuxCNC, {} differ\n", count, seed,
             run.accepted, run.different);
  return reported(run.failures, run.different);
}

int run_output(std::uint64_t count, std::uint64_t seed) {
  const OutputRun run = compare_output(CHAINTRUE_FIXTURES, seed, count, true, kMostReported);
  fmt::print("{} outputs from seed {}: {} differ\n", run.outputs, seed, run.different);
  return reported(run.failures, run.different);
}

int generate(const std::string& folder) {
  std::vector<Record> language;
  std::vector<Record> path;
  GeneratorOptions options;
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    language.push_back({fmt::format("seed_{}", seed), random_program(seed)});
  options.scope = Scope::path;
  for (std::uint64_t seed = 1; seed <= 120; ++seed)
    path.push_back({fmt::format("seed_{}", seed), random_program(seed, options)});
  grid::files::write_whole_file(folder + "/generated.records", write_records(language));
  grid::files::write_whole_file(folder + "/follower.records", write_records(path));
  return 0;
}

int run(const std::vector<std::string>& words) {
  const auto number = [&](std::size_t at, std::uint64_t otherwise) {
    return words.size() > at ? std::strtoull(words[at].c_str(), nullptr, 10) : otherwise;
  };
  const std::string what = words.empty() ? "" : words[0];
  if (what == "generate" && words.size() == 2) return generate(words[1]);
  if (what == "follow")
    return run_follow(number(1, 10000), number(2, 1), number(3, 0), number(4, 1));
  if (what == "language" || what == "output") {
    if (!linuxcnc_missing().empty()) {
      fmt::print("{}\n", linuxcnc_missing());
      return 2;
    }
    return what == "language" ? run_language(number(1, 5000), number(2, 1))
                              : run_output(number(1, 1000), number(2, 1));
  }
  fmt::print("gcode_witness_long follow|language|output [COUNT [SEED]] | generate FOLDER\n");
  return 2;
}

}  // namespace
}  // namespace chaintrue::witness

int main(int argc, char** argv) {
  try {
    return chaintrue::witness::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print("{}\n", error.what());
    return 3;
  }
}
