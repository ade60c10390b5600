// SPDX-License-Identifier: GPL-3.0-or-later
// What may be sent: two queries, and moves that somebody confirmed.
#include "tools/live/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <type_traits>

namespace chaintrue::live {
namespace commands_test {

using testing::HasSubstr;
using Kind = Move::Kind;

const Move kThere{Kind::go_to, {300.0, -200.04}};

std::optional<ConfirmedMove> asked(const Move& move, const std::optional<std::string>& typed) {
  return ConfirmedMove::ask(move, [&](const std::string& question) {
    EXPECT_THAT(question, HasSubstr(move.line()));
    return typed;
  });
}

TEST(Commands, QueriesMoveNothing) {
  EXPECT_EQ(text_of(Query::status), "?");
  EXPECT_EQ(text_of(Query::calibration_state), "$GSTATE\n");
}

TEST(Commands, OnlyYConfirms) {
  for (const char* typed : {"", "n", "yes", " y", "y ", "j", "Yy", "$CAL"})
    EXPECT_FALSE(asked(kThere, typed)) << typed;
  EXPECT_FALSE(asked(kThere, std::nullopt));
  for (const char* typed : {"y", "Y"}) {
    const auto move = asked(kThere, typed);
    ASSERT_TRUE(move);
    EXPECT_EQ(move->text(), "$J=G21G90G53X300.0Y-200.0F800\n");
  }
  const auto anchors = asked({Kind::find_anchors, {}}, "y");
  ASSERT_TRUE(anchors);
  EXPECT_EQ(anchors->text(), "$CAL\n");
  static_assert(!std::is_constructible_v<ConfirmedMove, std::string>, "made by ask() alone");
}

TEST(Commands, NothingIsDueWhileTheMachineWorks) {
  Driver driver;
  EXPECT_FALSE(driver.due({"", 0}, 0, std::nullopt));
  EXPECT_FALSE(driver.due({"Home", 1}, 0, std::nullopt));
  EXPECT_FALSE(driver.due({"Alarm", 2}, 7, model::BedPoint{1.0, 2.0}));
  const auto first = driver.due({"Idle", 2}, 0, std::nullopt);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, Kind::find_anchors);
  EXPECT_TRUE(driver.due({"Idle", 2}, 0, std::nullopt));  // nothing was sent yet
  driver.sent(*first, {"Idle", 2});
  // The last report is older than the move.
  EXPECT_FALSE(driver.due({"Idle", 2}, 0, std::nullopt));
  EXPECT_FALSE(driver.due({"Home", 3}, 6, model::BedPoint{1.0, 2.0}));
  EXPECT_FALSE(driver.is_done());
}

TEST(Commands, DrivesToThePlaceAndMeasuresFromThere) {
  const model::BedPoint there{300.0, -200.0};
  Driver driver;
  const auto go = driver.due({"Idle", 4}, 9, there);
  ASSERT_TRUE(go);
  EXPECT_EQ(go->kind, Kind::go_to);
  EXPECT_EQ(go->to.x_mm, 300.0);
  driver.sent(*go, {"Idle", 4});
  EXPECT_FALSE(driver.due({"Jog", 5}, 9, there));
  const auto measure = driver.due({"Idle", 5}, 9, there);
  ASSERT_TRUE(measure);
  EXPECT_EQ(measure->kind, Kind::find_anchors);
  driver.sent(*measure, {"Idle", 5});
  EXPECT_FALSE(driver.due({"Idle", 5}, 9, there));
  // Busy and idle again between two looks.
  EXPECT_FALSE(driver.due({"Idle", 70}, 31, std::nullopt));
  EXPECT_TRUE(driver.is_done());
  EXPECT_FALSE(driver.due({"Idle", 70}, 31, there));
}

}  // namespace commands_test
}  // namespace chaintrue::live
