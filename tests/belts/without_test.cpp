// SPDX-License-Identifier: GPL-3.0-or-later
// Places left out by hand: --without 7,12.
#include <gmock/gmock.h>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "tests/belts/simulated_belts.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::content_of;
using testing_support::Outcome;
using testing_support::without_origin;

class Without : public testing_support::CommandFixture {};

TEST_F(Without, PlacesThatAreLeftOutHaveNoPart) {
  grid::SimulatedBelts set = grid::simulate({.seed = 8, .columns = 6, .rows = 5});
  set.belts.name = "a frame";
  write("all.json", grid::files::write_belts(set.belts));
  grid::MeasuredBelts less = set.belts;
  less.points.erase(less.points.begin() + 11);
  less.points.erase(less.points.begin() + 6);
  write("less.json", grid::files::write_belts(less));
  ASSERT_EQ(run("fit all.json --without 7,12 -o without.json").code, 0);
  ASSERT_EQ(run("fit less.json -o less_anchors.json").code, 0);
  EXPECT_EQ(without_origin(content_of(folder_ / "without.json")),
            without_origin(content_of(folder_ / "less_anchors.json")));
  ASSERT_EQ(run("fit all.json -o anchors.json").code, 0);
  EXPECT_NE(without_origin(content_of(folder_ / "without.json")),
            without_origin(content_of(folder_ / "anchors.json")));
  const Outcome diagnosed = run("diagnose all.json --without 7,12 -o d.json");
  ASSERT_EQ(diagnosed.code, 0) << diagnosed.err;
  ASSERT_EQ(run("diagnose less.json -o less_d.json").code, 0);
  EXPECT_EQ(without_origin(content_of(folder_ / "d.json")),
            without_origin(content_of(folder_ / "less_d.json")));
}

TEST_F(Without, TheOthersKeepTheirNumbers) {
  grid::SimulatedBelts set = grid::simulate({.seed = 9});
  set.belts.points[30].lengths_mm.tr += 60.0;
  write("belts.json", grid::files::write_belts(set.belts));
  const Outcome fit = run("fit belts.json --without 7,12 -v -o anchors.json");
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr("the top right belt at point 31"));
  const auto anchors =
      grid::files::parse_anchors(content_of(folder_ / "anchors.json"), "anchors.json").fit;
  ASSERT_EQ(anchors.bad.size(), 1U);
  EXPECT_EQ(anchors.bad[0].point, 30U);
  const Outcome diagnosed = run("diagnose belts.json --without 12,7 -o d.json");
  ASSERT_EQ(diagnosed.code, 0) << diagnosed.err;
  EXPECT_THAT(diagnosed.err + diagnosed.out, HasSubstr("the top right belt at point 31"));
}

TEST_F(Without, APlaceThatEndsNowhereCanBeLeftOut) {
  grid::SimulatedBelts set = grid::simulate({.seed = 10});
  set.belts.points[4].lengths_mm = {900.0, 950.0, 1000.0, 4000.0};
  write("belts.json", grid::files::write_belts(set.belts));
  const Outcome refused = run("fit belts.json -o anchors.json");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("/points/4"));
  EXPECT_EQ(run("fit belts.json --without 5 -o anchors.json").code, 0);
}

TEST_F(Without, WhatIsNoPointIsBadInput) {
  grid::SimulatedBelts set = grid::simulate({.seed = 11, .columns = 5, .rows = 5});
  set.belts.distances.push_back({std::size_t{2}, std::size_t{20}, 1000.0, 1.0});
  const auto& from = set.places[2];
  const auto& to = set.places[20];
  set.belts.distances[0].distance_mm = std::hypot(from.x_mm - to.x_mm, from.y_mm - to.y_mm);
  write("belts.json", grid::files::write_belts(set.belts));
  for (const char* verb : {"fit", "diagnose"}) {
    const auto answer = [&](const std::string& numbers) {
      const Outcome got =
          run(std::string(verb) + " belts.json --without " + numbers + " -o out.json");
      EXPECT_EQ(got.code, 3) << verb << " " << numbers << "\n" << got.err;
      EXPECT_FALSE(exists("out.json"));
      return got.err;
    };
    EXPECT_THAT(answer("26"), AllOf(HasSubstr("found 26"), HasSubstr("counted from 1: 1 to 25")));
    EXPECT_THAT(answer("0"), HasSubstr("as in 7,12"));
    EXPECT_THAT(answer("1,"), HasSubstr("as in 7,12"));
    EXPECT_THAT(answer("x"), HasSubstr("as in 7,12"));
    EXPECT_THAT(answer("1.5"), HasSubstr("as in 7,12"));
    EXPECT_THAT(answer("3"), HasSubstr("leave the distance out of the file, or the point in"));
    // The point of the distance keeps its place where one before it is left out.
    const Outcome fine = run(std::string(verb) + " belts.json --without 1 -o fine.json --force");
    EXPECT_EQ(fine.code, 0) << fine.err;
  }
  const std::string fixtures = CHAINTRUE_FIXTURES;
  const Outcome chains = run("fit " + fixtures + "/good/grid_plain.csv --machine " + fixtures +
                             "/machines/classic.json --without 3 -o map.json");
  EXPECT_EQ(chains.code, 3);
  EXPECT_THAT(chains.err, HasSubstr("it is of points of a chaintrue_belts file"));
}

}  // namespace
}  // namespace chaintrue
