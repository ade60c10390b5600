// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/failure.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <tl/expected.hpp>

namespace chaintrue {
namespace failure_tests {

enum class Why { slack, outside };
std::string_view sentence_of(Why why) {
  return why == Why::slack ? "a chain hangs slack" : "the place lies outside";
}
/// Has no sentence: failures of whole tasks give their own.
enum class TaskWhy { no_machine };

TEST(Failure, WithoutATextHasTheReasonsText) {
  const Failure<Why> failure = Why::slack;
  EXPECT_EQ(failure.sentence(), "a chain hangs slack");
  EXPECT_EQ(failure, Why::slack);
  EXPECT_NE(failure, Why::outside);
}

TEST(Failure, NamesTheSubjectOfATask) {
  const Failure<TaskWhy> failure(TaskWhy::no_machine, "grid.csv names no machine");
  EXPECT_EQ(failure.sentence(), "grid.csv names no machine");
  EXPECT_EQ(failure, TaskWhy::no_machine);
}

TEST(Failure, EndsWithTheUnderlyingReason) {
  const Failure<Why> failure = Failure<Why>(Why::outside).because_of("a chain hangs slack");
  EXPECT_EQ(failure.sentence(), "the place lies outside: a chain hangs slack");
  EXPECT_EQ(failure, Why::outside) << "the reason alone is compared with a reason";
  EXPECT_NE(failure, Failure<Why>(Why::outside));
}

TEST(Failure, WithAPlaceKeepsItsReason) {
  const auto below = Failure<Why>(Why::slack).because_of("too short").at(7);
  EXPECT_EQ(below.place, 7);
  EXPECT_EQ(below.sentence(), "a chain hangs slack: too short");
  EXPECT_EQ(Failure<TaskWhy>(TaskWhy::no_machine, "words").at(7).sentence(), "words");
}

TEST(Failure, ConvertsFromItsReasonInAnExpected) {
  const auto asked = []() -> tl::expected<double, Failure<Why>> {
    return tl::unexpected(Why::outside);
  };
  ASSERT_FALSE(asked());
  EXPECT_EQ(asked().error(), Why::outside);
}

}  // namespace failure_tests
}  // namespace chaintrue
