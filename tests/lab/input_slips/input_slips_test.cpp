// SPDX-License-Identifier: GPL-3.0-or-later
// An excerpt of build/input_slips: every kind of slip once, and clean sessions of every way.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/input_checks/number_checks.hpp"
#include "input_slips/judge/kinds.hpp"

namespace chaintrue::slips {
namespace {

using ::testing::IsEmpty;

class EveryKind : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EveryKind, IsNamed) {
  const Kind& kind = kinds()[GetParam()];
  const Outcome outcome = try_kind(kind, 1);
  EXPECT_TRUE(outcome.is_named) << word(kind.way) << ", " << kind.id << ": "
                                << ::testing::PrintToString(outcome.reported.messages) << ", expected "
                                << outcome.expected.place << " "
                                << outcome.expected.words.front();
}

INSTANTIATE_TEST_SUITE_P(Slips, EveryKind, ::testing::Range(std::size_t{0}, kinds().size()));

class CleanSession : public ::testing::TestWithParam<int> {};

TEST_P(CleanSession, IsReadWithoutMessages) {
  constexpr std::uint64_t kFirst = 500;
  const auto seed = kFirst + static_cast<std::uint64_t>(GetParam());
  EXPECT_THAT(false_alarms(kWays[GetParam() % 4], seed), IsEmpty());
}

TEST(NumberSlips, SuggestTheLikelyNumber) {
  const auto question_for = [](double written, double meant) {
    for (const auto& slip : grid::input_checks::number_errors(written, true)) {
      if (slip.value == meant) return slip.question;
    }
    return std::string("nothing");
  };
  EXPECT_EQ(question_for(536.5, 563.5), "is it 563.5 rather than 536.5?");
  EXPECT_EQ(question_for(536.5, -536.5), "is the minus missing?");
  EXPECT_EQ(question_for(-536.5, 536.5), "is there a minus too many?");
  EXPECT_EQ(question_for(53.5, 5365.5), "nothing");  // two digits dropped: two slips
  EXPECT_EQ(question_for(53.5, 563.5), "is it 563.5 rather than 53.5?");
  EXPECT_EQ(question_for(536.5, 436.5),
            "is it 436.5 rather than 536.5 (the tape held at its 100 mm mark)?");
  EXPECT_EQ(question_for(100.0, 2540.0), "is it in inches, 2540 mm?");
}

INSTANTIATE_TEST_SUITE_P(Twenty, CleanSession, ::testing::Range(0, 20));

}  // namespace
}  // namespace chaintrue::slips
