// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/visiting_order.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

namespace chaintrue::grid {
namespace line_by_line {
namespace {

using ::testing::ElementsAre;

MeasuredPoint at(double x_mm, double y_mm) {
  MeasuredPoint point;
  point.mark = {x_mm, y_mm};
  return point;
}

/// Row by row from the top left, as one reads.
std::vector<MeasuredPoint> marks(int columns, int rows) {
  std::vector<MeasuredPoint> points;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      // By hand, some millimetres off the line.
      points.push_back(at(400.0 * column + 3.0 * (row % 2), -300.0 * row + 2.0 * (column % 3)));
    }
  }
  return points;
}

TEST(VisitNumbers, FollowTheLinesOfThreeByTwoMarks) {
  const auto points = marks(3, 2);
  EXPECT_THAT(visit_numbers(points, {}).value(), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(visit_numbers(points, {.serpentine = true}).value(), ElementsAre(0, 1, 2, 5, 4, 3));
  EXPECT_THAT(visit_numbers(points, {.from_right = true}).value(), ElementsAre(2, 1, 0, 5, 4, 3));
  EXPECT_THAT(visit_numbers(points, {.from_below = true}).value(), ElementsAre(3, 4, 5, 0, 1, 2));
  EXPECT_THAT(visit_numbers(points, {.rows = false}).value(), ElementsAre(0, 2, 4, 1, 3, 5));
  EXPECT_THAT(
      visit_numbers(points, {.rows = false, .serpentine = true, .from_right = true}).value(),
      ElementsAre(4, 3, 0, 5, 2, 1));
}

TEST(VisitNumbers, EachOfTheSixteenOrdersIsAnotherPermutation) {
  const auto points = marks(5, 4);
  std::vector<std::vector<int>> all;
  std::vector<std::string> words;
  for (const VisitingOrder& order : line_by_line_orders()) {
    std::vector<int> numbers = visit_numbers(points, order).value();
    EXPECT_THAT(all, ::testing::Not(::testing::Contains(numbers)));
    all.push_back(numbers);
    words.push_back(in_words(order));
    std::sort(numbers.begin(), numbers.end());
    std::vector<int> each(points.size());
    std::iota(each.begin(), each.end(), 0);
    EXPECT_EQ(numbers, each);
  }
  EXPECT_EQ(all.size(), 16U);
  std::sort(words.begin(), words.end());
  EXPECT_EQ(std::unique(words.begin(), words.end()), words.end());
}

TEST(VisitNumbers, MarksMeasuredAgainComeLast) {
  auto points = marks(3, 2);
  points.insert(points.begin() + 1, points.front());
  EXPECT_THAT(visit_numbers(points, {}).value(), ElementsAre(0, 6, 1, 2, 3, 4, 5));
}

TEST(VisitNumbers, AScatteredSetHasNoLines) {
  std::vector<MeasuredPoint> points;
  for (int k = 0; k < 30; ++k) points.push_back(at(40.0 * ((k * 37) % 50), 40.0 * ((k * 23) % 31)));
  const auto numbers = visit_numbers(points, {});
  ASSERT_FALSE(numbers);
  EXPECT_EQ(numbers.error(), "marks that are in rows; these are not");
}

}  // namespace
}  // namespace line_by_line
}  // namespace chaintrue::grid
