// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the table of planted causes counts, on outcomes written by hand; and a few draws of the real scans,
/// which stay in ../shared/data.
#include "planted/judge/planted_rates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace chaintrue::planted {
namespace {

TEST(Claim, HasAName) {
  const Claim claim{{"chain_pitch_error:both", "tape_scale:both"}, 0.125};
  EXPECT_EQ(word_of(claim), "chain_pitch_error:both~tape_scale:both=0.1250");
  EXPECT_EQ(sealed::parse_claim(word_of(claim)), claim);
  EXPECT_THROW((void)sealed::parse_claim("drift:left"), std::invalid_argument);
  EXPECT_THROW((void)sealed::parse_claim("drift:left=0.5x"), std::invalid_argument);
}

TEST(Claim, IsScoredAgainstTheClassThatSharesAMember) {
  const std::vector<Claim> whole = {{{"a:-", "b:-"}, 0.7}, {{"c:-"}, 0.2}};
  EXPECT_EQ(probability_in(whole, {{"c:-", "a:-"}, 1.0}), 0.7);
  EXPECT_EQ(probability_in(whole, {{"d:-"}, 1.0}), 0.0);
}

TEST(Reference, IsReadAsWritten) {
  const std::string path = testing::TempDir() + "references.txt";
  const std::vector<Reference> references = {
      {"C", 465, {400.0, 0.5, 0.25, -0.5, 1.5}, {{{"a:x"}, 0.75}, {{"b:-", "c:-"}, 0.25}}},
      {"D", 247, {150.0, 1.0, 2.0, 0.0, 1.0}, {}}};
  std::ofstream(path) << text_of(references);
  EXPECT_EQ(text_of(read_references(path)), text_of(references));
  EXPECT_THROW((void)reference_of(references, "E"), std::invalid_argument);
  std::ofstream(path) << "C 465 400\n";
  EXPECT_THROW((void)read_references(path), std::invalid_argument);
}

TEST(Facts, FollowFromTheClaims) {
  const std::vector<Reference> references = {
      {"C", 465, {}, {{{"true:-"}, 0.99}, {{"open:-"}, 0.6}, {{"false:-"}, 0.1}}}};
  std::vector<Outcome> outcomes = sealed::parse_outcomes(
      "C:plain 1 60 0.00 - named true:-=0.9500,open:-=0.9500,gone:-=0.8500 -\n"
      "C:planted 1 60 8.00 kink:left several_causes kink:left=0.9200,false:-=0.9300 named\n"
      "C:plain 2 60 0.00 - named false:-=0.9500 -\n"
      "C:planted 2 60 5.00 kink:left named false:-=0.9500,true:-=0.1900 -\n"
      "C:plain 3 60 0.00 - named false:-=0.6500 -\n"
      "C:planted 3 60 3.00 kink:left named kink:left=0.6500 named\n");
  set_facts(outcomes, references);
  using testing::ElementsAre;
  // A class between denied and borne out is neither.
  EXPECT_THAT(outcomes[0].facts, ElementsAre("none_denied_90"));
  EXPECT_EQ(outcomes[0].numbers["borne_out_90"], 1.0);
  EXPECT_EQ(outcomes[0].numbers["denied_60"], 1.0);
  EXPECT_THAT(outcomes[1].facts, ElementsAre("named"));
  EXPECT_THAT(outcomes[2].facts, ElementsAre());
  EXPECT_THAT(outcomes[3].facts, ElementsAre("others_stay"));
  EXPECT_THAT(outcomes[4].facts, ElementsAre("none_denied_90"));
  EXPECT_THAT(outcomes[5].facts,
              ElementsAre("none_denied_90", "none_denied_60", "named", "others_stay"));
  const std::string table = sealed::rates_table(outcomes, sealed::rows_of("planted"));
  EXPECT_THAT(table,
              testing::HasSubstr("| planted, strength 7 and more | named | 100.0 | 1 of 1 |"));
  EXPECT_THAT(
      table,
      testing::HasSubstr(
          "| nothing planted | no claim at 90 % that the whole scan denies | 66.7 | 2 of 3 |"));
  // By bins of a tenth: 4.70 claimed and 2 right, 0.85 and 0, 0.19 and 1, 1.30 and 1; "open" is neither.
  const sealed::Calibration calibration = claims_held_against(outcomes, references);
  EXPECT_EQ(calibration.claims(), 9);
  EXPECT_NEAR(calibration.error(), 0.518, 5e-4);
  outcomes.erase(outcomes.begin());
  EXPECT_THROW(set_facts(outcomes, references), std::invalid_argument);
}

class RealScan : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path data = CHAINTRUE_SHARED_DATA;
    const auto file = data / "optical_grid" / "D_2018-10-01_upper_half.csv";
    if (!std::filesystem::exists(file))
      GTEST_SKIP() << "../shared/data is not part of a checkout and is not here";
    scan_ = read_scan(file, data / "holey" / "groundcontrol_2018-09-01b.ini");
    references_ = read_references(std::string(CHAINTRUE_FIXTURES) + "/planted/references.txt");
  }
  Scan scan_;
  std::vector<Reference> references_;
};

// Each of the seven causes: only its own readings change, and an order is stated where it acts by the visit.
TEST_F(RealScan, ACauseChangesItsOwnReadings) {
  for (std::uint64_t seed = 0; seed < 7; ++seed) {
    const Draw draw = draw_planted(scan_, references_, seed);
    SCOPED_TRACE(generator::card(draw.hidden.cause).id);
    EXPECT_EQ(draw.with_order, draw.plain.points.front().order.has_value());
    const bool left = draw.hidden.where == generator::Where::left;
    if (!left && draw.hidden.where != generator::Where::right) continue;
    for (std::size_t i = 0; i < draw.plain.points.size(); ++i) {
      const auto& before = *draw.plain.points[i].lengths;
      const auto& after = *draw.planted.points[i].lengths;
      // Each equilibrium is found to 1e-10 mm.
      EXPECT_NEAR(left ? before.right_mm : before.left_mm, left ? after.right_mm : after.left_mm,
                  1e-8);
    }
  }
}

}  // namespace
}  // namespace chaintrue::planted
