// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/machine_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chaintrue::grid::files {
namespace {

using ::testing::HasSubstr;

std::string message_of(const std::string& text) {
  try {
    (void)parse_machine(text, "machine.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MachineFile, WritesWhatItReads) {
  model::Machine machine;
  machine.name = "a name with \"quotes\" and \xC3\xA4";
  machine.motors.left.x_mm = -1489.2000000000003;
  machine.sprocket.radius_mm = 10.19;
  machine.attachment = model::Brackets{311.5, 138.25, 80.125};
  machine.feed = model::Feed::off_bottom;
  machine.chain_zero = {1.25, -0.1};
  machine.controller.kind = model::ControllerKind::maslow_classic;
  machine.controller.settings.chain_over_sprocket_top = false;
  machine.controller.settings.left_chain_tolerance_percent = 0.1237252;
  machine.effects.push_back({"chain_pitch_error", "left", {{"elongation", 0.0012}}});
  machine.effects.push_back({"side_pull", "", {{"force_n", -2.0}}});
  const std::string written = write_machine(machine);
  const model::Machine read = parse_machine(written, "machine.json");
  EXPECT_EQ(write_machine(read), written);
  EXPECT_EQ(read.name, machine.name);
  EXPECT_EQ(read.motors.left.x_mm, machine.motors.left.x_mm);
  EXPECT_EQ(std::get<model::Brackets>(read.attachment).height_mm, 138.25);
  EXPECT_EQ(read.effects[0].parameters.at("elongation"), 0.0012);
  EXPECT_EQ(read.effects[1].side, "");
  EXPECT_EQ(read.controller.settings.chain_over_sprocket_top, false);
}

TEST(MachineFile, ReportsEveryProblemAtOnce) {
  std::string text = write_machine(model::Machine{});
  const auto replace = [&text](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("\"mass_kg\": 11.6", "\"mas_kg\": 11.6");
  replace("\"teeth\": 10", "\"teeth\": \"ten\"");
  replace("\"over_top\"", "\"overtop\"");
  replace("\"height_mm\": 1219.2", "\"height_mm\": NaN");
  const std::string message = message_of(text);
  EXPECT_THAT(message, HasSubstr("machine.json: /sled/mas_kg: found 11.6, expected \"mass_kg\"?"));
  EXPECT_THAT(message,
              HasSubstr("machine.json: /sprocket/teeth: found \"ten\", expected a whole number"));
  EXPECT_THAT(
      message,
      HasSubstr(
          "machine.json: /feed: found \"overtop\", expected one of \"over_top\", \"off_bottom\""));
  EXPECT_THAT(message,
              HasSubstr("machine.json: /bed/height_mm: found NaN, expected a number in mm"));
}

}  // namespace
}  // namespace chaintrue::grid::files
