// SPDX-License-Identifier: GPL-3.0-or-later
// What is kept of a machine's output: the same wherever packets end, and bounded whatever comes.
#include "tools/live/received_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "grid/files/belts_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::live {
namespace received_text_test {

using testing::ElementsAre;

std::string the_log() {
  return grid::files::read_whole_file(CHAINTRUE_FIXTURES "/good/maslow4_log.txt");
}

/// As a machine prints it that reports its status in between, with the line ends of telnet.
std::string with_reports() {
  std::string text;
  const std::string log = the_log();
  for (std::size_t begin = 0; begin < log.size();) {
    const std::size_t end = log.find('\n', begin);
    text += log.substr(begin, end - begin) + "\r\n<Home|MPos:0.000,0.000|FS:0,0>\r\n";
    begin = end == std::string::npos ? log.size() : end + 1;
  }
  return text;
}

ReceivedText received(const std::string& text) {
  ReceivedText result;
  result.take(text);
  return result;
}

TEST(ReceivedText, IsTheSameWhereverAPacketEnds) {
  const std::string text = with_reports() + "[MSG:INFO: Measured way";
  const ReceivedText whole = received(text);
  ASSERT_GT(text.size(), 5000U);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    ReceivedText parts;
    parts.take(std::string_view(text).substr(0, cut));
    parts.take(std::string_view(text).substr(cut));
    ASSERT_EQ(parts.lines(), whole.lines()) << cut;
    ASSERT_EQ(parts.open_line(), "[MSG:INFO: Measured way") << cut;
    ASSERT_EQ(parts.count(), whole.count()) << cut;
    ASSERT_EQ(parts.status().state, "Home") << cut;
    ASSERT_EQ(parts.status().busy, whole.status().busy) << cut;
    ASSERT_EQ(parts.take_messages(), received(text).take_messages()) << cut;
  }
}

TEST(ReceivedText, ReadsAsTheFileDoes) {
  const std::string text = with_reports();
  const auto from_file = grid::files::parse_maslow4(text, "log.txt");
  const auto from_memory = grid::files::parse_maslow4(received(text).lines(), "log.txt");
  EXPECT_EQ(grid::files::write_belts(from_memory.belts), grid::files::write_belts(from_file.belts));
  ASSERT_EQ(from_memory.runs.size(), from_file.runs.size());
  EXPECT_EQ(from_memory.runs.front().line, from_file.runs.front().line);
}

TEST(ReceivedText, TellsWhatAPersonWaitsFor) {
  ReceivedText text;
  text.take("[MSG:INFO: Measured waypoint 7]\n[MSG:INFO: Waypoint 7 coordinates: X=1 Y=2]\nok\n");
  text.take("[MSG:ERR: Find Anchors fit failed: rms]\r\nerror:8\n\n<Alarm>\n");
  EXPECT_THAT(text.take_messages(),
              ElementsAre("Measured waypoint 7", "Find Anchors fit failed: rms", "error:8"));
  EXPECT_TRUE(text.take_messages().empty());
  EXPECT_EQ(text.status().state, "Alarm");
  EXPECT_EQ(text.status().busy, 1U);
  EXPECT_EQ(text.count(), 7U);
  EXPECT_EQ(text.telling(), 5U);
}

TEST(ReceivedText, AFloodIsHeldInBoundedMemory) {
  constexpr std::size_t kFlood = std::size_t{10} << 20U;
  const std::string status = "<Idle|MPos:0.000,0.000,0.000|FS:0,0|Ov:100,100,100>\n";
  const std::string error = "[MSG:ERR: Bad connection on Top Left encoder, failed to read]\n";
  const std::string endless = std::string(1000, 'x');
  for (const std::string& line : {status, error, endless}) {
    ReceivedText text;
    for (std::size_t size = 0; size < kFlood; size += line.size()) {
      text.take(line);
      ASSERT_LE(text.lines().size(), kMostKept);
      ASSERT_LE(text.open_line().size(), kLongestLine);
    }
    EXPECT_LE(text.take_messages().size(), 100U);
    // Status reports are kept as ends of lines.
    EXPECT_EQ(text.is_whole(), line != error);
    // What comes after it is read as ever.
    text.take("\n" + the_log());
    EXPECT_EQ(grid::files::parse_maslow4(text.lines(), "log.txt").belts.points.size(), 31U);
  }
}

}  // namespace received_text_test
}  // namespace chaintrue::live
