// SPDX-License-Identifier: GPL-3.0-or-later
// A log out of the messages of a websocket: nothing is lost, and no notice stands within a line.
#include "tools/live/frames.hpp"

#include <gtest/gtest.h>

#include <string>

namespace chaintrue::live {
namespace frames_test {

using Kind = FrameJoiner::Kind;

TEST(Frames, ANoticeStandsBehindTheLineThatItInterrupts) {
  const std::string log = "CLBM:[{bl:2960.58}]\n[MSG:INFO: Measured waypoint 7]\n";
  for (std::size_t cut = 1; cut < log.size(); ++cut) {
    FrameJoiner joiner;
    std::string text = joiner.take(Kind::text, "CURRENT_ID:0");
    text += joiner.take(Kind::binary, log.substr(0, cut));
    text += joiner.take(Kind::text, "PING:1");
    text += joiner.take(Kind::binary, log.substr(cut));
    text += joiner.rest();
    const std::size_t first_end = log.find('\n') + 1;
    const std::string expected = cut <= first_end
                                     ? log.substr(0, first_end) + "PING:1\n" + log.substr(first_end)
                                     : log + "PING:1\n";
    EXPECT_EQ(text, "CURRENT_ID:0\n" + expected) << cut;
  }
}

TEST(Frames, OtherTextIsOfTheLog) {
  FrameJoiner joiner;
  EXPECT_EQ(joiner.take(Kind::text, "[MSG:INFO: Meas"), "[MSG:INFO: Meas");
  EXPECT_EQ(joiner.take(Kind::text, "ured waypoint 7]\n"), "ured waypoint 7]\n");
  EXPECT_EQ(joiner.take(Kind::text, "PING:1\nPING:2\n"), "PING:1\nPING:2\n");
  EXPECT_EQ(joiner.take(Kind::binary, "PING:1"), "PING:1");
}

TEST(Frames, NoticesWithinALineThatNeverEndsAreBounded) {
  FrameJoiner joiner;
  (void)joiner.take(Kind::binary, "CLBM:[{bl:29");
  std::string text;
  std::size_t sent = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::string own = joiner.take(Kind::text, "PING:1");
    sent += 7;
    text += own;
    ASSERT_LE(sent - std::min(sent, text.size()), std::size_t{66} << 10U);
  }
  text += joiner.rest();
  EXPECT_EQ(text.size(), sent + 1);  // the end of the line that they broke
}

TEST(Frames, AtTheEndNoticesAreLinesOfTheirOwn) {
  FrameJoiner joiner;
  (void)joiner.take(Kind::binary, "CLBM:[{bl:29");
  EXPECT_EQ(joiner.take(Kind::text, "PING:1"), "");
  EXPECT_EQ(joiner.rest(), "\nPING:1\n");
  EXPECT_EQ(joiner.rest(), "");
}

}  // namespace frames_test
}  // namespace chaintrue::live
