// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/planning/measurement_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace chaintrue::grid {
namespace {

struct Asked {
  std::size_t marks;
  std::size_t second;
};

class SecondVisits : public testing::TestWithParam<Asked> {
 protected:
  std::vector<std::size_t> visits() const {
    return with_second_visits(GetParam().marks, GetParam().second);
  }
};

TEST_P(SecondVisits, RepeatTheRequestedMarks) {
  const auto all = visits();
  EXPECT_EQ(all.size(), GetParam().marks + GetParam().second);
  std::vector<std::size_t> first;
  for (const std::size_t mark : all) {
    if (std::find(first.begin(), first.end(), mark) == first.end()) first.push_back(mark);
  }
  ASSERT_EQ(first.size(), GetParam().marks);
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
  for (const std::size_t mark : first) EXPECT_LE(std::count(all.begin(), all.end(), mark), 2);
}

TEST_P(SecondVisits, EveryVisitLiesBetweenTwoVisitsOfAMark) {
  const auto all = visits();
  for (std::size_t moved = 1; moved < all.size(); ++moved) {
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(moved);
    const bool is_spanned = std::any_of(all.begin(), at, [&](std::size_t mark) {
      return std::find(at, all.end(), mark) != all.end();
    });
    EXPECT_TRUE(is_spanned) << moved;
  }
}

TEST_P(SecondVisits, NoMarkIsVisitedTwiceInARow) {
  const auto all = visits();
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

INSTANTIATE_TEST_SUITE_P(Lists, SecondVisits,
                         testing::Values(Asked{28, 4}, Asked{12, 4}, Asked{12, 1}, Asked{13, 3},
                                         Asked{200, 8}),
                         [](const auto& asked) {
                           return std::to_string(asked.param.marks) + "_" +
                                  std::to_string(asked.param.second);
                         });

TEST(SecondVisitsOfNone, VisitEachMarkOnce) {
  EXPECT_EQ(with_second_visits(3, 0), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_THROW((void)with_second_visits(11, 4), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid
