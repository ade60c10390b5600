// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The chains of links compared with the 40-digit tables of fixtures/reference, and the toothed
/// wheel with the drum.
#include "generator/hidden/rest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

namespace chaintrue::generator {
namespace {

double number(const nlohmann::json& text) { return std::stod(text.get<std::string>()); }

nlohmann::json load(const std::string& file) {
  std::ifstream in(CHAINTRUE_FIXTURES "/reference/" + file);
  return nlohmann::json::parse(in);
}

TrueMachine machine_of(const nlohmann::json& p) {
  TrueMachine m;
  const double half = 0.5 * number(p.at("D"));
  const double up = 0.5 * number(p.at("bedH")) + number(p.at("motorOffsetY"));
  m.axis = {{{-half, up}, {half, up}}};
  m.teeth = std::stoi(p.at("teeth").get<std::string>());
  m.pitch_mm = number(p.at("pitch"));
  m.over_top = p.at("sg").get<int>() > 0;
  m.ring_radius_mm = number(p.at("rho"));
  m.chain_mass_kg_per_m = 1e6 * number(p.at("lam")) * 1e-3;
  m.compliance_per_n = number(p.at("compliance"));
  m.sled_mass_kg = number(p.at("mass"));
  m.tilt_from_vertical_deg = number(p.at("tilt_deg"));
  m.wheel = WheelShape::round;
  return m;
}

struct Worst {
  double length_mm = 0.0;
  double angle_rad = 0.0;
  double tension_n = 0.0;
};

Worst worst_of(TrueMachine m, const nlohmann::json& bed, const char* key) {
  Worst worst;
  for (const auto& record : bed) {
    const auto rest = come_to_rest(m, {number(record.at("x")), number(record.at("y"))});
    if (!rest) {
      ADD_FAILURE() << "no rest at " << record.at("x") << ", " << record.at("y");
      continue;
    }
    for (std::size_t c = 0; c < 2; ++c) {
      const auto& chain = rest->chain[c];
      const char* side = c == 0 ? "L" : "R";
      worst.length_mm =
          std::max(worst.length_mm, std::abs(chain.length_mm - number(record.at(key)[c])));
      if (std::string(key) != "d_elastic") continue;
      const auto& state = record.at("d_state");
      worst.angle_rad = std::max(
          worst.angle_rad, std::abs(chain.angle_rad - number(state.at(std::string("phi") + side))));
      worst.tension_n = std::max(
          worst.tension_n, std::abs(chain.tension_n - number(state.at(std::string("Tb") + side))));
    }
  }
  return worst;
}

class Tables : public testing::TestWithParam<const char*> {};

TEST_P(Tables, WholeLinksAgreeToTheirDiscreteness) {
  const auto json = load(GetParam());
  TrueMachine m = machine_of(json.at("params"));
  const Worst elastic = worst_of(m, json.at("bed"), "d_elastic");
  // Half a link's weight on either pin: at most w p^2 / (24 T) of slope over 3 m of chain.
  EXPECT_LT(elastic.length_mm, 1e-4);
  EXPECT_LT(elastic.angle_rad, 1e-6);
  EXPECT_LT(elastic.tension_n, 1e-4);
  m.compliance_per_n = 0.0;
  EXPECT_LT(worst_of(m, json.at("bed"), "c_inextensible").length_mm, 1e-4);
}

TEST_P(Tables, TheErrorFallsWithTheSquareOfThePieces) {
  const auto json = load(GetParam());
  TrueMachine m = machine_of(json.at("params"));
  const double whole = worst_of(m, json.at("bed"), "d_elastic").length_mm;
  m.pieces_per_link = 4;
  const double parted = worst_of(m, json.at("bed"), "d_elastic").length_mm;
  EXPECT_NEAR(whole / parted, 16.0, 0.5);  // the next order is 1e-4 of it; rounding 1e-9 of 1e-6
}

INSTANTIATE_TEST_SUITE_P(Reference, Tables,
                         testing::Values("table_over_top.json", "table_off_bottom.json",
                                         "table_over_top_rho0.json"));

// Averaged over all directions a polygon is as wide as the circle of its circumference (Cauchy), so
// that links on teeth ripple about the drum without an offset.
TEST(Teeth, RippleAboutTheDrum) {
  TrueMachine toothed;
  TrueMachine drum;
  drum.wheel = WheelShape::round;
  // A tooth at the angle b ahead of the tangent point holds the chain r b - R sin b further out
  // than the drum would; that is largest at cos b = r / R.
  const double r = toothed.pitch_mm * toothed.teeth / (2.0 * std::numbers::pi);
  const double corner = toothed.pitch_mm / (2.0 * std::sin(std::numbers::pi / toothed.teeth));
  const double ahead = std::acos(r / corner);
  const double amplitude = corner * std::sin(ahead) - r * ahead;
  for (const bool over_top : {true, false}) {
    toothed.over_top = drum.over_top = over_top;
    double sum = 0.0, largest = 0.0;
    constexpr int kPlaces = 400;
    for (int i = 0; i < kPlaces; ++i) {
      const Vec2 bit{-1100.0 + 5.5 * i, 500.0 * std::sin(0.37 * i)};
      const auto a = come_to_rest(toothed, bit);
      const auto b = come_to_rest(drum, bit);
      ASSERT_TRUE(a && b) << bit.x << ", " << bit.y;
      for (std::size_t c = 0; c < 2; ++c) {
        const double ripple = a->chain[c].length_mm - b->chain[c].length_mm;
        sum += ripple;
        largest = std::max(largest, std::abs(ripple));
        EXPECT_NEAR(std::remainder(a->chain[c].free_mm, toothed.pitch_mm), 0.0, 1e-9);
      }
    }
    EXPECT_GT(largest, 0.95 * amplitude);
    EXPECT_LT(largest, 1.3 * amplitude);  // one chain's ripple moves the other chain too
    EXPECT_LT(std::abs(sum / (2 * kPlaces)), 0.1 * amplitude);
  }
}

}  // namespace
}  // namespace chaintrue::generator
