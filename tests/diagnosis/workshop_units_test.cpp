// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes as text: of every effect of both machines, at a positive and at a negative size.
#include "grid/diagnosis/workshop_units.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "model/belts/belt_effects.hpp"
#include "model/effects/catalogue.hpp"
#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<const model::effects::Effect*> all_effects() {
  std::vector<const model::effects::Effect*> all(model::effects::catalogue().begin(),
                                                 model::effects::catalogue().end());
  for (const auto table : {model::belts::belt_effects(), model::plotter::plotter_effects()})
    all.insert(all.end(), table.begin(), table.end());
  return all;
}

TEST(WorkshopUnits, UseDirectionsInsteadOfSigns) {
  constexpr std::array kDirected = {"longer", "shorter", "larger", "smaller", "higher",  "lower",
                                    "more",   "less",    "much",   "little",  "heavier", "lighter",
                                    "below",  "above",   "left",   "right"};
  for (const model::effects::Effect* effect : all_effects()) {
    for (const model::effects::EffectParameter& parameter : effect->parameters) {
      // A tenth of the upper bound: a number with visible digits.
      const double size = parameter.integer ? 2.0 : 0.1 * parameter.upper;
      const auto words = [&](double value) {
        return in_workshop_units({effect, effect->sides.front()},
                                 {std::string(parameter.name), value, 0.02 * size});
      };
      const std::string positive = words(size);
      const std::string negative = words(-size);
      EXPECT_NE(positive, negative) << effect->id << " " << parameter.name;
      EXPECT_THAT(positive, Not(HasSubstr("-0"))) << effect->id;
      for (const char* const word : kDirected) {
        const bool directed =
            negative.find(word) != std::string::npos || positive.find(word) != std::string::npos;
        // The only minus sign left is that of "+-".
        if (directed) {
          std::string bare = negative;
          if (const auto sign = bare.find("+-"); sign != std::string::npos) bare.erase(sign, 2);
          EXPECT_THAT(bare, Not(HasSubstr("-"))) << effect->id << " " << parameter.name;
        }
      }
    }
  }
}

std::string worded(std::string_view effect, const char* parameter, double value, double sigma) {
  for (const model::effects::Effect* own : all_effects()) {
    const bool has = std::any_of(own->parameters.begin(), own->parameters.end(),
                                 [&](const auto& one) { return one.name == parameter; });
    if (own->id == effect && has)
      return in_workshop_units({own, own->sides.front()}, {parameter, value, sigma});
  }
  return "";
}

// A bug of words: "1 links".
TEST(WorkshopUnits, UseSingularForOne) {
  EXPECT_EQ(worded("tooth_skip", "links", 1.0, 0.0), "1 link");
  EXPECT_EQ(worded("tooth_skip", "links", -1.0, 0.0), "-1 link");
  EXPECT_EQ(worded("tooth_skip", "links", 2.0, 0.0), "2 links");
  EXPECT_EQ(worded("tooth_skip", "teeth", 1.0, 0.0), "1 tooth");
}

TEST(WorkshopUnits, TheSignChoosesTheWord) {
  EXPECT_EQ(worded("chain_pitch_error", "elongation", 0.00122, 0.00012),
            "links 0.122 +- 0.012 % longer");
  EXPECT_EQ(worded("chain_pitch_error", "elongation", -0.00122, 0.00012),
            "links 0.122 +- 0.012 % shorter");
  EXPECT_EQ(worded("sprocket_radius", "offset_mm", -0.4, 0.0), "radius 0.4 mm smaller");
  EXPECT_EQ(worded("side_pull", "force_n", -1.5, 0.0), "1.5 N to the left");
  EXPECT_EQ(worded("belt_scale", "scale", -0.004, 0.0), "0.4 % less belt per turn");
  EXPECT_EQ(worded("belt_zero", "offset_mm", -3.0, 0.0), "3 mm too little read");
  EXPECT_EQ(worded("anchor_height", "offset_mm", -12.0, 0.0), "12 mm lower");
}

TEST(Remedies, CausesWithTheSameRemedyShareALine) {
  using model::effects::EffectSide;
  const auto cause_of = [](const model::effects::Effect& effect, EffectSide side) {
    Cause cause;
    cause.cause = {&effect, side};
    return cause;
  };
  const Cause right = cause_of(model::belts::belt_scale, EffectSide::br);
  const Cause left = cause_of(model::belts::belt_scale, EffectSide::bl);
  const Cause moved = cause_of(model::belts::anchor_moved, EffectSide::tl);
  const std::string scale(right.cause.effect->remedy);
  const std::string anchor(moved.cause.effect->remedy);
  EXPECT_THAT(remedies({right, moved, left}),
              testing::ElementsAre(scale + ": at the bottom right and at the bottom left", anchor));
  EXPECT_THAT(remedies({left}), testing::ElementsAre(scale));
  EXPECT_THAT(remedies({}), testing::IsEmpty());
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
