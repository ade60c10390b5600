// SPDX-License-Identifier: GPL-3.0-or-later
// Logs cut at a line, and with a line deleted, doubled or garbled: an answer or a plain refusal.
// An excerpt of a few seconds; every line of every log:
//   build/tests/files_tests --gtest_also_run_disabled_tests --gtest_filter='EveryLine.*'
#include <gtest/gtest.h>

#include <cmath>

#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "tests/grid_files/damaged_logs.hpp"

namespace chaintrue::grid::files::every_line {
namespace {

using testing_support::damage_every;
using testing_support::Damage;
using testing_support::kDamageSeed;

struct Counted {
  int logs = 0;
  int answered = 0;
  int far = 0;
};

/// Reads and fits a damaged log; anything but an answer or a refusal fails the test.
void read_one(const std::string& text, const BeltsFit& whole, Counted& counted) {
  ++counted.logs;
  try {
    const Maslow4Import read = parse_maslow4(text, "log.txt");
    if (!read.is_enough) return;
    const auto fit = diagnosis::fit_with_causes(read.belts);
    if (!fit) return;
    ++counted.answered;
    // An anchor that is 6 sigmas, and a centimetre, from that of the whole log is a wrong answer.
    for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
      const double off_mm =
          std::abs(fit->coordinates[i].fitted_mm - whole.coordinates[i].fitted_mm);
      if (off_mm > 10.0 && off_mm > 6.0 * fit->coordinates[i].sigma_mm) {
        ++counted.far;
        ADD_FAILURE() << fit->coordinates[i].name << " is off by " << off_mm << " mm of\n" << text;
        break;
      }
    }
  } catch (const InputError& error) {
    ASSERT_FALSE(error.problems().empty());
    for (const InputProblem& problem : error.problems()) EXPECT_FALSE(problem.expected.empty());
  }
}

/// Every `step`th line of a log, damaged in each way.
void damage(const std::string& text, std::size_t step, Counted& cut, Counted& one_line) {
  const auto whole = diagnosis::fit_with_causes(parse_maslow4(text, "log.txt").belts);
  ASSERT_TRUE(whole);
  damage_every(text, step, [&](Damage how, const std::string& damaged) {
    read_one(damaged, *whole, how == Damage::cut ? cut : one_line);
  });
}

void expect_answers(const Counted& cut, const Counted& one_line) {
  fmt::print("seed {}: cut {} of {} answered; one bad line {} of {} answered, {} wrongly\n",
             kDamageSeed,
             cut.answered,
             cut.logs,
             one_line.answered,
             one_line.logs,
             one_line.far);
  // The share that is asked for.
  EXPECT_GE(one_line.answered, std::ceil(0.85 * one_line.logs)) << "seed " << kDamageSeed;
}

TEST(EveryLine, OfTheFixtureCutDeletedDoubledOrGarbledGetsAnAnswerOrARefusal) {
  Counted cut;
  Counted one_line;
  const std::string text =
      read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good/maslow4_log.txt");
  // Some ten seconds.
  damage(text, 14, cut, one_line);
  expect_answers(cut, one_line);
}

TEST(EveryLine, DISABLED_OfTheFixtureAndOfPublishedReadings) {
  Counted cut;
  Counted one_line;
  damage(read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good/maslow4_log.txt"),
         1,
         cut,
         one_line);
  const std::filesystem::path folder = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4";
  for (const char* file : {"concrete_anchors.txt", "frame_rebuilt.txt", "mini_frame.txt"}) {
    if (!std::filesystem::exists(folder / file)) continue;
    damage(read_whole_file(folder / file), 1, cut, one_line);
  }
  expect_answers(cut, one_line);
}

}  // namespace
}  // namespace chaintrue::grid::files::every_line
