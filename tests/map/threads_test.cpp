// SPDX-License-Identifier: GPL-3.0-or-later
// One map evaluated by many threads, and many fits at once: the same bits as sequentially.
#include <gtest/gtest.h>

#include <vector>

#include "grid/files/map_file.hpp"
#include "grid/map/fit.hpp"
#include "tests/map/synthetic_grid.hpp"
#include "tests/support/in_threads.hpp"

namespace chaintrue {
namespace {

constexpr int kThreads = 4;

grid::MeasuredGrid session(std::uint64_t seed) {
  return grid::synthetic::generate(model::Machine{}, testing_support::usual_spec(seed))
      .value()
      .grid;
}

std::vector<double> answers(const grid::CompensationMap& map) {
  std::vector<double> numbers;
  for (double x = -1200.0; x <= 1200.0; x += 200.0) {
    for (double y = -600.0; y <= 600.0; y += 200.0) {
      const auto answer = map.query({x, y});
      if (!answer) continue;
      numbers.insert(numbers.end(), {answer->lengths.left_mm, answer->sigma.right_mm});
      if (const auto mark = map.inverse(answer->lengths)) numbers.push_back(mark->x_mm);
    }
  }
  return numbers;
}

TEST(MapInThreads, OneMapGivesEveryThreadTheSameBits) {
  const auto map = grid::fit(session(3));
  ASSERT_TRUE(map);
  const std::vector<double> alone = answers(*map);
  ASSERT_GT(alone.size(), 200U);
  std::vector<std::vector<double>> reply(kThreads);
  std::vector<std::function<void()>> asking;
  for (auto& numbers : reply) asking.emplace_back([&] { numbers = answers(*map); });
  testing_support::run_in_threads(asking);
  for (const auto& numbers : reply) EXPECT_EQ(numbers, alone);
}

TEST(MapInThreads, FitsAtTheSameTimeGiveTheBytesOfFitsInTurn) {
  std::vector<std::string> alone;
  for (std::uint64_t seed = 0; seed < kThreads; ++seed) {
    alone.push_back(grid::files::write_map(grid::fit(session(seed)).value()));
  }
  std::vector<std::string> together(kThreads);
  std::vector<std::function<void()>> fitting;
  for (std::size_t seed = 0; seed < kThreads; ++seed) {
    fitting.emplace_back(
        [&, seed] { together[seed] = grid::files::write_map(grid::fit(session(seed)).value()); });
  }
  testing_support::run_in_threads(fitting);
  EXPECT_EQ(together, alone);
}

}  // namespace
}  // namespace chaintrue
