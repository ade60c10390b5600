// SPDX-License-Identifier: GPL-3.0-or-later
// Questions about numbers; how often a slip is named is build/input_slips.
#include <gtest/gtest.h>

#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::slips {
namespace {

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

}  // namespace
}  // namespace chaintrue::slips
