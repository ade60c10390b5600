// SPDX-License-Identifier: GPL-3.0-or-later
// Work without a reasonable limit is rejected with a message before it begins; affordable work is
// done.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

class Limits : public testing_support::CommandFixture {
 protected:
  [[nodiscard]] Outcome timed(const std::string& arguments, std::chrono::seconds most) const {
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome = run(arguments);
    EXPECT_LT(std::chrono::steady_clock::now() - start, most) << arguments;
    return outcome;
  }
  static std::string fixture(const std::string& name) {
    return std::string(CHAINTRUE_FIXTURES) + "/" + name;
  }
  void simulate(int points, const std::string& output) const {
    ASSERT_EQ(run(fmt::format("simulate --machine {} --random {} --length-noise-mm 0.2 "
                              "--position-noise-mm 0.3 --seed 1 -o {}",
                              fixture("machines/classic.json"),
                              points,
                              output))
                  .code,
              0);
  }
};

// A rejection reads a file and no more; ten seconds allow for a loaded machine.
constexpr std::chrono::seconds kBeforeWork(10);
// Half a second's work; without limits it does not end in a minute.
constexpr std::chrono::seconds kNoWork(30);
// Some seconds' work on a loaded machine; a naive implementation needs minutes and gigabytes.
constexpr std::chrono::seconds kSeconds(60);

TEST_F(Limits, ADiagnosisOfThousandsOfPointsIsRefusedAtOnce) {
  simulate(1300, "many.json");
  const Outcome outcome = timed("diagnose many.json", kBeforeWork);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              HasSubstr("many.json: 1300 points are more than a diagnosis takes (1200): leave some "
                        "out"));
}

TEST_F(Limits, ACheckTakesRepeatsAsTheirMean) {
  ASSERT_EQ(run("fit " + fixture("grids/seven_by_four.json") + " -o m.json").code, 0);
  const Outcome query = run("query m.json -900 300 0 0 900 -400");
  ASSERT_EQ(query.code, 0);
  std::string once = "x_mm,y_mm,left_mm,right_mm\n";
  std::string often = once;
  std::size_t line = query.out.find('\n') + 1;
  while (line < query.out.size()) {
    std::size_t cells = line;
    for (int i = 0; i < 4; ++i) cells = query.out.find(',', cells) + 1;
    const std::string row = query.out.substr(line, cells - 1 - line) + "\n";
    once += row;
    for (int i = 0; i < 700; ++i) often += row;
    line = query.out.find('\n', line) + 1;
  }
  write("once.csv", once);
  write("often.csv", often);
  const std::string noise = " --noise-length-mm 0.2 --noise-position-mm 0.3";
  const Outcome one = run("check m.json once.csv" + noise);
  const Outcome many = timed("check m.json often.csv" + noise, kNoWork);
  EXPECT_EQ(one.code, 0);
  EXPECT_EQ(many.code, 0);
  EXPECT_THAT(many.out, HasSubstr("The map is still valid"));
}

TEST_F(Limits, ACheckTakesFiveThousandPoints) {
  ASSERT_EQ(run("fit " + fixture("grids/seven_by_four.json") + " -o m.json").code, 0);
  simulate(5000, "many.json");
  const Outcome outcome = timed("check m.json many.json", kSeconds);
  EXPECT_LE(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("point 5000, right chain"));
}

TEST_F(Limits, ACheckOfTooManyPointsIsRefusedAtOnce) {
  ASSERT_EQ(run("fit " + fixture("grids/seven_by_four.json") + " -o m.json").code, 0);
  simulate(20001, "many.json");
  const Outcome outcome = timed("check m.json many.json", kBeforeWork);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("20001 points are more than a check takes (20000)"));
}

TEST_F(Limits, AFitOfTooManyPointsIsRefusedAtOnce) {
  simulate(10001, "many.json");
  const Outcome outcome = timed("fit many.json -o m.json", kBeforeWork);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("10001 points are more than a fit takes (10000)"));
  EXPECT_FALSE(exists("m.json"));
}

TEST_F(Limits, BeltsOfTooManyPlacesAreRefusedAtOnce) {
  const std::string belts = fixture("belts/thirty_one_places.json");
  auto many = nlohmann::json::parse(content_of(belts));
  auto points = nlohmann::json::array();
  for (int i = 0; i < 20001; ++i) {
    const double x = 700.0 + 0.07 * i;
    const double y = 500.0 + (i * 263) % 1000;
    points.push_back({{"order", i},
                      {"tl_mm", std::hypot(x, y - 2060.0)},
                      {"tr_mm", std::hypot(x - 2925.0, y - 2060.0)},
                      {"bl_mm", std::hypot(x, y)},
                      {"br_mm", std::hypot(x - 2950.0, y)}});
  }
  many["points"] = points;
  write("many.json", many.dump());
  const Outcome fit = timed("fit many.json -o a.json", kBeforeWork);
  EXPECT_EQ(fit.code, 3);
  EXPECT_THAT(fit.err, HasSubstr("20001 places are more than a fit takes (20000)"));
  ASSERT_EQ(run("fit " + belts + " -o a.json").code, 0);
  const Outcome check = timed("check a.json many.json", kBeforeWork);
  EXPECT_EQ(check.code, 3);
  EXPECT_THAT(check.err, HasSubstr("20001 places are more than a check takes (20000)"));
}

// Each position may be bad: a naive search takes the cube of their number for each of them.
TEST_F(Limits, ACheckOfAnchorsTakesThousandsOfPlaces) {
  const std::string belts = fixture("belts/thirty_one_places.json");
  ASSERT_EQ(run("fit " + belts + " -o a.json").code, 0);
  ASSERT_EQ(run("simulate --belts a.json --grid 60x50 --length-noise-mm 0.9 -o many.json").code, 0);
  const Outcome outcome = timed("check a.json many.json", kNoWork);
  EXPECT_LE(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("point 2999"));
}

/// Holes on a lattice with the given number of distances between them, as commanded, with repeats.
std::string holes(int count, int distances) {
  std::string text = content_of(std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json");
  text =
      R"({"file_type": "chaintrue_holes", "format_version": "1.0", "name": "many", "machine": )" +
      text + R"(, "holes": [)";
  std::vector<std::pair<double, double>> places;
  for (int i = 0; i < count; ++i) {
    places.emplace_back(-1100.0 + 2200.0 * (i % 20) / 19.0, -500.0 + 130.0 * (i / 20));
    text += fmt::format(R"({}{{"name": "H{}", "x_mm": {}, "y_mm": {}}})",
                        i == 0 ? "" : ", ",
                        i,
                        places.back().first,
                        places.back().second);
  }
  text += R"(], "distances": [)";
  for (int k = 0; k < distances; ++k) {
    const auto a = static_cast<std::size_t>(k % count);
    const auto b = static_cast<std::size_t>((k + 1 + k / count % (count - 1)) % count);
    text += fmt::format(
        R"({}{{"from": "H{}", "to": "H{}", "distance_mm": {:.1f}}})",
        k == 0 ? "" : ", ",
        a,
        b,
        std::hypot(places[a].first - places[b].first, places[a].second - places[b].second));
  }
  return text + "]}";
}

TEST_F(Limits, FiveThousandDistancesAreFittedAndChecked) {
  ASSERT_EQ(run("fit " + fixture("grids/seven_by_four.json") + " -o m.json").code, 0);
  write("holes.json", holes(20, 5000));
  EXPECT_LE(timed("check m.json holes.json", kSeconds).code, 1);
  EXPECT_EQ(timed("fit holes.json -o h.json", kSeconds).code, 0);
}

TEST_F(Limits, TooManyHolesAndDistancesAreRefusedAtOnce) {
  write("distances.json", holes(20, 5001));
  write("holes.json", holes(151, 400));
  const Outcome distances = timed("fit distances.json -o h.json", kBeforeWork);
  EXPECT_EQ(distances.code, 3);
  EXPECT_THAT(distances.err, HasSubstr("5001 distances are more than a fit takes (5000)"));
  const Outcome many = timed("fit holes.json -o h.json", kBeforeWork);
  EXPECT_EQ(many.code, 3);
  EXPECT_THAT(many.err, HasSubstr("151 holes are more than a fit takes (150)"));
}

}  // namespace
}  // namespace chaintrue
