// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One list of colours: all colours of charts, the page's style and Python's plots are on it, so
/// that vermilion and blue mean the same everywhere.
#include <gmock/gmock.h>

#include <regex>
#include <set>
#include <string>

#include "tests/support/files.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/embedded.hpp"

namespace chaintrue::report::testing {
namespace {

const std::set<std::string> kMeanings = {kBeforeColor, kAfterColor, kThirdColor, kFourthColor,
                                         kNeutralColor};
/// Ink, soft ink and the wood of a sheet.
const std::set<std::string> kGround = {"#1b2330", "#5b6675", "#a98a5b", "#8a6d3f",
                                       "#d8b98a", "#ffffff", "#f4f6f8"};
/// Scales of a quantity from little to much, and the lines of a sweep.
const std::set<std::string> kScales = {"#fdfdf5", "#d6e8d0", "#8fc6c4", "#4a94b8", "#2f5d9b",
                                       "#253471",  // expected error
                                       "#9bbdd6",  // the stem of a point
                                       "#440154", "#3b528b", "#1f8a86", "#c07a00",
                                       "#c0281c",                         // error along a program
                                       "#56b4e9", "#999933", "#e69f00"};  // lines of a sweep

std::set<std::string> colours_in(const std::string& text) {
  static const std::regex kColour("#[0-9a-fA-F]{6}\\b");
  std::set<std::string> found;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), kColour);
       at != std::sregex_iterator(); ++at)
    found.insert(at->str());
  return found;
}

TEST(Colours, ChartsUseListedColours) {
  std::set<std::string> used;
  for (const EmbeddedFile& chart : embedded_files("chart")) {
    for (const std::string& colour : colours_in(std::string(chart.text))) {
      used.insert(colour);
      EXPECT_TRUE(kMeanings.contains(colour) || kGround.contains(colour) ||
                  kScales.contains(colour))
          << colour << " of " << chart.name << " is on no list of tools/report/bed_chart.hpp";
    }
  }
  // An unused scale must be removed from the list.
  for (const std::string& colour : kScales) EXPECT_TRUE(used.contains(colour)) << colour;
}

TEST(Colours, ThePageMatchesTheCharts) {
  const std::string style(embedded_text("asset", "page.css"));
  EXPECT_THAT(style, ::testing::HasSubstr(std::string("--blue: ") + kAfterColor));
}

TEST(Colours, PythonPlotsMatchTheCharts) {
  const std::string text =
      testing_support::read_text(CHAINTRUE_FIXTURES "/../tools/python/chaintrue/_plots.py");
  ASSERT_FALSE(text.empty());
  for (const auto& [name, colour] :
       {std::pair("BEFORE", kBeforeColor), std::pair("AFTER", kAfterColor),
        std::pair("NEUTRAL", kNeutralColor)}) {
    EXPECT_THAT(text, ::testing::HasSubstr(std::string(name) + " = \"" + colour + "\""));
  }
  // No colour of matplotlib's own cycle.
  EXPECT_FALSE(std::regex_search(text, std::regex("\"C[0-9]\"")));
}

}  // namespace
}  // namespace chaintrue::report::testing
