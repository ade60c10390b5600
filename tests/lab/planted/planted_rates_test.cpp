// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the table of planted causes counts, on outcomes written by hand; and a few draws of the real scans,
/// which stay in ../shared/data.
#include "planted/judge/planted_rates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/refusal.hpp"

namespace chaintrue::planted {
namespace {

using testing_support::refusal_of;

TEST(Claim, HasAName) {
  const Claim claim{{"chain_pitch_error:both", "tape_scale:both"}, 0.125};
  EXPECT_EQ(word_of(claim), "chain_pitch_error:both~tape_scale:both=0.1250");
  EXPECT_EQ(parse_claim(word_of(claim)), claim);
  EXPECT_EQ(refusal_of([] { (void)parse_claim("drift:left"); }),
            "\"drift:left\": expected effect:side=probability");
  EXPECT_EQ(refusal_of([] { (void)parse_claim("drift:left=0.5x"); }), "\"0.5x\" is not a number");
}

TEST(Claim, IsScoredAgainstTheClassThatSharesAMember) {
  const std::vector<Claim> whole = {{{"a:-", "b:-"}, 0.7}, {{"c:-"}, 0.2}};
  EXPECT_EQ(probability_in(whole, {{"b:-"}, 1.0}), 0.7);
  EXPECT_EQ(probability_in(whole, {{"c:-", "a:-"}, 1.0}), 0.7);
  EXPECT_EQ(probability_in(whole, {{"d:-"}, 1.0}), 0.0);
}

TEST(Reference, IsReadAsWritten) {
  const std::string path = testing::TempDir() + "references.txt";
  std::vector<Reference> references = {
      {"C", 465, {400.0, 0.5, 0.25, -0.5, 1.5}, {{{"a:x"}, 0.75}, {{"b:-", "c:-"}, 0.25}}},
      {"D", 247, {150.0, 1.0, 2.0, 0.0, 1.0}, {}}};
  std::ofstream(path) << text_of(references);
  const std::vector<Reference> read = read_references(path);
  EXPECT_EQ(text_of(read), text_of(references));
  EXPECT_EQ(reference_of(read, "C").claims, references.front().claims);
  EXPECT_EQ(refusal_of([&] { (void)reference_of(read, "E"); }),
            "no reference of the scan E; --reference makes it");
  std::ofstream(path) << "C 465 400\n";
  EXPECT_EQ(refusal_of([&] { (void)read_references(path); }),
            "a reference has 8 words, this line has 3: \"C 465 400\"");
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
  EXPECT_THAT(outcomes[0].facts, ElementsAre("none_denied_90", "borne_out_90", "borne_out_60"));
  EXPECT_THAT(outcomes[1].facts, ElementsAre("named", "claimed_90", "claimed_60"));
  EXPECT_THAT(outcomes[2].facts, ElementsAre());
  EXPECT_THAT(outcomes[3].facts, ElementsAre("others_stay"));
  EXPECT_THAT(outcomes[4].facts, ElementsAre("none_denied_90"));
  EXPECT_THAT(outcomes[5].facts,
              ElementsAre("none_denied_90", "named", "claimed_60", "others_stay"));
  const std::string table = planted_table(outcomes, references);
  EXPECT_THAT(table,
              testing::HasSubstr("| planted, strength 7 and more: named | 1 of 1 | 1 of 1 |"));
  EXPECT_THAT(table, testing::HasSubstr("| planted, 4 to 7: named | 0 of 1 | 0 of 1 |"));
  EXPECT_THAT(
      table,
      testing::HasSubstr(
          "| nothing planted: a claim at 90 % that the whole scan denies | 1 of 3 | 1 of 3 |"));
  // By bins of a tenth: 4.70 claimed and 2 right, 0.85 and 0, 0.19 and 1, 1.30 and 1; "open" is neither.
  EXPECT_THAT(table, testing::HasSubstr("9 claims whose truth is known: calibration error 0.518"));
  outcomes.erase(outcomes.begin());
  EXPECT_THAT(refusal_of([&] { set_facts(outcomes, references); }),
              testing::StartsWith("no outcome of the plain readings of \"C:planted 1 60"));
}

TEST(ClusteredBounds, EqualThoseOfTheRatioEstimate) {
  // By hand: rate 1/2; squares 4, 0, 4 about it; sigma sqrt(3/2 8) / 60 = 0.05774; t of 2 is 4.303.
  const sealed::RateBounds three = clustered_bounds({{12, 20}, {10, 20}, {8, 20}});
  EXPECT_NEAR(three.lower, 0.5 - 4.303 * 0.057735, 1e-6);
  EXPECT_NEAR(three.upper, 0.5 + 4.303 * 0.057735, 1e-6);
  // Scans that agree by chance are no better than as many independent draws.
  const sealed::RateBounds equal = clustered_bounds({{10, 20}, {10, 20}, {10, 20}});
  EXPECT_EQ(equal.lower, sealed::rate_bounds_95(30, 60).lower);
  const sealed::RateBounds one = clustered_bounds({{10, 20}});
  EXPECT_EQ(one.lower, 0.0);
  EXPECT_EQ(one.upper, 1.0);
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

TEST_F(RealScan, TheSameSeedDrawsTheSame) {
  const Draw first = draw_planted(scan_, references_, 7),
             again = draw_planted(scan_, references_, 7);
  ASSERT_EQ(first.planted.points.size(), 60u);
  for (std::size_t i = 0; i < first.planted.points.size(); ++i) {
    EXPECT_EQ(first.planted.points[i].mark.x_mm, again.planted.points[i].mark.x_mm);
    EXPECT_EQ(first.planted.points[i].lengths->left_mm, again.planted.points[i].lengths->left_mm);
  }
  EXPECT_EQ(first.strength, again.strength);
}

// Each of the seven causes: only its own readings change, the pattern adds nothing to its strength, and an
// order is stated where it acts by the visit.
TEST_F(RealScan, ACauseIsAddedAtTheStrengthAsked) {
  for (std::uint64_t seed = 0; seed < 7; ++seed) {
    const Draw draw = draw_planted(scan_, references_, seed);
    SCOPED_TRACE(generator::card(draw.hidden.cause).id);
    const double noise_factor = reference_of(references_, scan_.name).field.noise_factor;
    EXPECT_LE(draw.strength, draw.white / noise_factor);
    // The sheet, which the requested strength ignores, absorbs a part.
    EXPECT_LE(draw.white, 20.1);
    EXPECT_GT(draw.white, 1.0);
    EXPECT_EQ(draw.with_order, draw.plain.points.front().order.has_value());
    const bool left = draw.hidden.where == generator::Where::left;
    if (!left && draw.hidden.where != generator::Where::right) continue;
    for (std::size_t i = 0; i < draw.plain.points.size(); ++i) {
      const auto& before = *draw.plain.points[i].lengths;
      const auto& after = *draw.planted.points[i].lengths;
      // Each equilibrium is found to 1e-10 mm.
      EXPECT_NEAR(
          left ? before.right_mm : before.left_mm, left ? after.right_mm : after.left_mm, 1e-8);
    }
  }
}

}  // namespace
}  // namespace chaintrue::planted
