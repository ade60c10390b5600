// SPDX-License-Identifier: GPL-3.0-or-later
// The progress display, by a clock under the test's control; and that long computations report
// their steps.
#include <gmock/gmock.h>

#include <cstdio>
#include <future>
#include <map>
#include <memory>
#include <string>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/map_check.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/synthetic/generator.hpp"
#include "tools/cli/progress_line.hpp"

namespace chaintrue {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

TEST(ProgressState, ReportsShareAndTimeLeft) {
  double now_s = 100.0;
  cli::ProgressState state([&now_s] { return now_s; });
  state.begin("sweep");
  now_s = 102.0;
  EXPECT_EQ(state.words(), "sweep: 2 s");
  state.note_share(0.25);
  EXPECT_EQ(state.words(), "sweep: 2 s, 25 % done, about 6 s left");
  // A step has a separate clock.
  state.note({"the map at the new points", 1, 2, 0.0});
  now_s = 110.0;
  state.note({"the map at the new points", 1, 2, 0.8});
  EXPECT_EQ(state.words(),
            "sweep: 10 s, step 1 of 2, the map at the new points, 80 % done, about 2 s left");
  state.note({"what may have changed", 2, 2});
  EXPECT_EQ(state.words(), "sweep: 10 s, step 2 of 2, what may have changed");
  state.note({"where the holes are cut", 1, 1, 0.0, 3});
  now_s = 111.0;
  state.note_share(2.0);
  EXPECT_EQ(state.words(),
            "sweep: 11 s, where the holes are cut, pass 3, 100 % done, about 0 s left");
  state.note({"settings", 1, 1, -1.0, 4});
  EXPECT_EQ(state.words(), "sweep: 11 s, settings, pass 4 until it converges");
}

/// Everything that was written to it.
std::string text_of(std::FILE* file) {
  std::rewind(file);
  char buffer[4096];
  return {buffer, std::fread(buffer, 1, sizeof buffer, file)};
}

TEST(RepeatedLine, RewritesItselfAndIsErasedAtTheEnd) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  std::promise<void> twice;
  int count = 0;
  {
    const auto words = [&] {
      if (++count == 2) twice.set_value();
      return "at " + std::to_string(count);
    };
    const cli::RepeatedLine line(file.get(), words, milliseconds(0), milliseconds(1));
    twice.get_future().wait();
  }
  EXPECT_THAT(text_of(file.get()), StartsWith("\r\x1b[Kat 1\r\x1b[Kat 2\r\x1b[K"));
  EXPECT_THAT(text_of(file.get()), EndsWith("\r\x1b[K"));
}

TEST(RepeatedLine, IsSilentForShortWork) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  {
    const auto words = [] { return std::string("too early"); };
    const cli::RepeatedLine line(file.get(), words, std::chrono::hours(1), milliseconds(1));
  }
  EXPECT_EQ(text_of(file.get()), "");
}

/// The steps received, each with the last share.
struct Told {
  std::map<int, grid::WorkStep> steps;
  grid::Progress progress() {
    return [this](const grid::WorkStep& step) {
      EXPECT_FALSE(step.what.empty());
      EXPECT_LE(step.number, step.of);
      EXPECT_LE(step.share, 1.0);
      steps[step.number] = step;
    };
  }
  std::vector<int> numbers() const {
    std::vector<int> result;
    for (const auto& [number, step] : steps) result.push_back(number);
    return result;
  }
};

grid::MeasuredGrid demo_grid() {
  return grid::files::read(grid::files::parse_grid, CHAINTRUE_FIXTURES "/grids/seven_by_four.json")
      .grid;
}

TEST(LongWork, FitAndCheckReportEachStep) {
  Told fitted, checked;
  grid::FitOptions options;
  options.progress = fitted.progress();
  const auto map = grid::fit(demo_grid(), options);
  ASSERT_TRUE(map);
  EXPECT_THAT(fitted.numbers(), ElementsAre(1, 2));
  ASSERT_TRUE(grid::check_map(*map, demo_grid(), checked.progress()));
  EXPECT_THAT(checked.numbers(), ElementsAre(1, 2));
  EXPECT_GT(checked.steps[1].share, 0.9);  // 33 of 34 points
}

TEST(LongWork, DiagnosisReportsEachStep) {
  Told told;
  grid::diagnosis::DiagnosisOptions options;
  options.progress = told.progress();
  ASSERT_TRUE(grid::diagnosis::diagnose(demo_grid(), options));
  EXPECT_THAT(told.numbers(), ElementsAre(1, 2, 3, 4));
}

TEST(LongWork, PlanAndSimulationReportTheirShare) {
  Told planned, read;
  grid::HolesPlanRequest request;
  request.progress = planned.progress();
  ASSERT_TRUE(grid::plan_holes(model::Machine{}, request));
  EXPECT_THAT(planned.numbers(), ElementsAre(1, 2));
  EXPECT_GT(planned.steps[1].share, 0.5);
  std::vector<model::Visit> visits(100);
  for (int i = 0; i < 100; ++i) visits[static_cast<std::size_t>(i)].order = i;
  (void)grid::synthetic::read_places(model::Machine{}, {}, visits, model::Model::elastic,
                                     read.progress());
  EXPECT_GT(read.steps[1].share, 0.5);
}

}  // namespace
}  // namespace chaintrue
