// SPDX-License-Identifier: GPL-3.0-or-later
// "Before" is one number: how far the machine misses as it is used today, over the measured part, as fit,
// diagnose, export and the pages of both say it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

/// rms_mm and maximum_mm of "tool_today", as they are written.
std::string tool_today(const std::string& json) {
  static const std::regex kKey(
      "\"tool_today\":\\s*\\{\\s*\"rms_mm\":\\s*([-+.e0-9]+),\\s*\"maximum_mm\":\\s*([-+.e0-9]+)");
  std::smatch found;
  return std::regex_search(json, found, kKey) ? found.str(1) + " " + found.str(2) : "no number";
}

std::string figure(const std::string& page) {
  static const std::regex kFigure("<b>([0-9.]+ mm)</b><span>error of the tool today");
  std::smatch found;
  return std::regex_search(page, found, kFigure) ? found.str(1) : "no figure";
}

class OneNumber : public testing_support::CommandFixture,
                  public testing::WithParamInterface<const char*> {};

TEST_P(OneNumber, OfAnEveningInEveryVerbAndPage) {
  const std::string readings = fmt::format("{}/start/{}.csv", CHAINTRUE_FIXTURES, GetParam());
  const std::string ini = std::string(CHAINTRUE_FIXTURES) + "/good/groundcontrol_ring.ini";
  ASSERT_EQ(run("start " + ini + " shop").code, 0);
  const Outcome fitted = run("fit " + readings + " --machine shop/machine.json -o map.json --json");
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  const Outcome diagnosed =
      run("diagnose " + readings +
          " --machine shop/machine.json -o diagnosis.json --report diagnosis.html");
  ASSERT_EQ(diagnosed.code, 0) << diagnosed.err;
  const Outcome exported = run("export groundcontrol map.json -o new.ini");
  ASSERT_EQ(exported.code, 0) << exported.err;
  ASSERT_EQ(run("report map.json -o map.html").code, 0);
  ASSERT_EQ(run("report diagnosis.json -o again.html").code, 0);

  const std::string number = tool_today(fitted.out);
  ASSERT_NE(number, "no number");
  EXPECT_EQ(tool_today(content_of(folder_ / "diagnosis.json")), number);
  const double rms_mm = std::stod(number);
  const double maximum_mm = std::stod(number.substr(number.find(' ')));
  EXPECT_THAT(exported.err,
              HasSubstr(fmt::format("today's settings the tool is {:.2f} mm rms off over the "
                                    "measured part, {:.2f} mm at worst",
                                    rms_mm,
                                    maximum_mm)));
  const std::string shown = figure(content_of(folder_ / "map.html"));
  ASSERT_NE(shown, "no figure");
  EXPECT_NEAR(std::stod(shown), rms_mm, 0.05) << "a figure has a tenth of a millimetre";
  EXPECT_EQ(figure(content_of(folder_ / "diagnosis.html")), shown);
  EXPECT_EQ(figure(content_of(folder_ / "again.html")), shown);
  EXPECT_THAT(diagnosed.out, HasSubstr("Your machine misses by about " + shown));
}

INSTANTIATE_TEST_SUITE_P(Evenings,
                         OneNumber,
                         testing::Values("marks",
                                         "worn_chain",
                                         "bent_beam",
                                         "long_tape",
                                         "slipped_tooth",
                                         "nothing_wrong"),
                         [](const auto& evening) { return std::string(evening.param); });

}  // namespace
}  // namespace chaintrue
