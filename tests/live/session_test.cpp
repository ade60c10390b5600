// SPDX-License-Identifier: GPL-3.0-or-later
// What is shown as places come in: the same wherever packets end, and what the file's diagnosis says.
#include "tools/live/session.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::live {
namespace session_test {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::string kFixtures = CHAINTRUE_FIXTURES;

std::string the_log() { return grid::files::read_whole_file(kFixtures + "/good/maslow4_log.txt"); }

grid::files::Maslow4Options with_settings() {
  grid::files::Maslow4Options options;
  options.settings = grid::files::read_whole_file(kFixtures + "/machines/maslow.yaml");
  return options;
}

/// Up to the end of the first list of readings, of six places.
std::string first_list() {
  const std::string log = the_log();
  return log.substr(0, log.find('\n', log.find("CLBM:")) + 1);
}

TEST(Session, ShowsAnchorsAndWhatWouldTellMoreAsPlacesComeIn) {
  Session session("log.txt", with_settings());
  EXPECT_THAT(session.news(), IsEmpty());
  session.take(first_list());
  std::vector<std::string> news = session.news();
  EXPECT_THAT(news, Contains("The machine: Measured waypoint 5"));
  EXPECT_THAT(news, Contains(StartsWith("6 places. Anchors: tl x ")));
  EXPECT_EQ(session.places(), 6U);
  EXPECT_THAT(session.news(), IsEmpty());  // nothing is new
  session.take(the_log().substr(first_list().size()));
  news = session.news();
  EXPECT_THAT(news,
              Contains(testing::AllOf(StartsWith("31 places. Anchors: tl x -31.8 +- 0.4, "),
                                      HasSubstr(" mm at worst ("))));
  EXPECT_THAT(news, Contains("No further place is expected to tell more."));
  EXPECT_THAT(news, Contains(StartsWith("A tape would tell: The distance from ")));
  EXPECT_FALSE(session.tells_most());
  EXPECT_THAT(session.last_words(), IsEmpty());
}

TEST(Session, SaysWhatTheDiagnosisOfTheFileSays) {
  Session session("log.txt", with_settings());
  session.take(the_log());
  const std::vector<std::string> news = session.news();
  const auto read = grid::files::parse_maslow4(the_log(), "log.txt", with_settings());
  const auto found = grid::diagnosis::diagnose(read.belts);
  ASSERT_TRUE(found);
  EXPECT_THAT(news, Contains(found->sentence));
  for (const auto& c : found->belts->coordinates)
    EXPECT_THAT(news,
                Contains(HasSubstr(fmt::format(" {:.1f} +- {:.1f}", c.fitted_mm, c.sigma_mm))));
}

TEST(Session, TwoPacketsGiveTheSameAnswerAsOne) {
  // That the text is the same at every cut is shown of ReceivedText; the answer is taken of some.
  const std::string log = the_log();
  Session whole("log.txt", with_settings());
  whole.take(log);
  const std::vector<std::string> expected = whole.news();
  constexpr std::size_t kStep = 1409;  // a prime: cuts at all kinds of places
  for (std::size_t cut = 1; cut < log.size(); cut += kStep) {
    Session parts("log.txt", with_settings());
    parts.take(log.substr(0, cut));
    parts.take(log.substr(cut));
    EXPECT_EQ(parts.news(), expected) << cut;
  }
}

TEST(Session, ADamagedReadingIsSaidOnceWithItsLine) {
  std::string log = the_log();
  const std::size_t at = log.find("bl:", log.rfind("CLBM:") + 40);
  log.replace(at, 3, "b;:");
  log.replace(log.find("bl:", log.find("CLBM:") + 40), 3, "b;:");
  Session session("log.txt", with_settings());
  session.take(log);
  const auto is_of_line = [](const std::string& line) {
    return line.starts_with("log.txt: line ");
  };
  std::vector<std::string> news = session.news();
  EXPECT_EQ(std::count_if(news.begin(), news.end(), is_of_line), 1) << testing::PrintToString(news);
  session.take("[MSG:INFO: Fan on]\n");
  news = session.news();
  EXPECT_EQ(std::count_if(news.begin(), news.end(), is_of_line), 0);
}

TEST(Session, AtTheEndSaysWhatIsMissing) {
  Session nothing("log.txt", {});
  nothing.take("Grbl 3.0 [FluidNC (wifi) '$' for help]\n<Idle|MPos:0,0>\n");
  EXPECT_THAT(nothing.news(), IsEmpty());
  EXPECT_THAT(nothing.last_words(), ElementsAre(StartsWith("No place was read: ")));

  // A last line without an end is read as the file's reader does.
  const std::string log = the_log();
  Session cut("log.txt", with_settings());
  cut.take(log.substr(0, log.rfind("}]") + 1));
  EXPECT_THAT(cut.news(), Not(Contains(StartsWith("31 places. "))));
  EXPECT_THAT(cut.last_words(), Contains(StartsWith("31 places. ")));

  Session few("log.txt", {});
  few.take("{bl:1788.94, br:1811.62, tr:1787.50, tl:1808.61}\n");
  EXPECT_THAT(few.news(), ElementsAre("1 place: anchors take 5 of them."));
}

TEST(Session, ReadingsThatContradictEachOtherAreSaidAtOnceAndAtTheEnd) {
  Session session("log.txt", {});
  session.take(grid::files::read_whole_file(kFixtures + "/bad/maslow4_readings.txt"));
  EXPECT_THAT(session.news(), ElementsAre(StartsWith("log.txt: ")));
  session.take("[MSG:INFO: Fan on]\n");
  EXPECT_THAT(session.news(), IsEmpty());  // said once
  EXPECT_EQ(session.places(), 0U);
  EXPECT_THAT(session.last_words(), ElementsAre(StartsWith("log.txt: ")));
}

TEST(Session, AFloodDoesNotHideWhatCameBefore) {
  Session session("log.txt", with_settings());
  session.take(the_log());
  for (int i = 0; i < 20000; ++i) session.take("<Idle|MPos:0.000,0.000,0.000|FS:0,0>\nok\n");
  EXPECT_THAT(session.news(), Contains(StartsWith("31 places. ")));
}

}  // namespace session_test
}  // namespace chaintrue::live
