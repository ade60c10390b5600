// SPDX-License-Identifier: GPL-3.0-or-later
// Logs cut at a line, and with a line deleted, doubled or garbled: an answer or a plain refusal.
// A few seconds of lines; more logs, and the causes named in them, are tests/lab/real_machines/damaged_logs_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "tests/grid_files/damaged_logs.hpp"

namespace chaintrue::grid::files::every_line {
namespace {

TEST(EveryLine, IsReadOrRefusedWhenDamaged) {
  const std::string log = read_whole_file(CHAINTRUE_FIXTURES "/good/maslow4_log.txt");
  const auto whole = diagnosis::fit_with_causes(parse_maslow4(log, "log.txt").belts);
  ASSERT_TRUE(whole);
  int logs = 0, answered = 0;
  constexpr std::size_t kStep = 14;  // some ten seconds
  testing_support::damage_every(log, kStep, [&](testing_support::Damage how, const std::string& text) {
    const bool is_one_line = how != testing_support::Damage::cut;
    logs += is_one_line ? 1 : 0;
    try {
      const Maslow4Import read = parse_maslow4(text, "log.txt");
      if (!read.is_enough) return;
      const auto fit = diagnosis::fit_with_causes(read.belts);
      if (!fit) return;
      answered += is_one_line ? 1 : 0;
      for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
        // An anchor that is 6 sigmas, and a centimetre, from that of the whole log is a wrong answer.
        EXPECT_LT(std::abs(fit->coordinates[i].fitted_mm - whole->coordinates[i].fitted_mm),
                  std::max(10.0, 6.0 * fit->coordinates[i].sigma_mm))
            << fit->coordinates[i].name << " of\n"
            << text;
      }
    } catch (const InputError& error) {
      EXPECT_FALSE(error.problems().empty());
      for (const InputProblem& problem : error.problems()) EXPECT_FALSE(problem.expected.empty() && problem.sentence.empty());
    }
  });
  // The required share.
  EXPECT_GE(answered, std::ceil(0.85 * logs)) << "seed " << testing_support::kDamageSeed;
}

}  // namespace
}  // namespace chaintrue::grid::files::every_line
