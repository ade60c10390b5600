// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Each step of the procedure is necessary: without it right names are lost or wrong ones given.
/// The results with and without the step are frozen as lists of the seeds that are not right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "sealed/posed.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Mix;
using testing::ElementsAre;
using testing::IsEmpty;

TrialOptions ablation_options(Mix mix) {
  TrialOptions o;
  o.recipe.kind = mix;
  o.recipe.points = 28;
  return o;
}

// Signatures that are not projected have most of their norm in common with the settings'.
TEST(Ablation, WithoutProjectionCausesAreMistaken) {
  TrialOptions o = ablation_options(Mix::single);
  EXPECT_THAT(seeds_without(trials(o, 9103, 11), leads_right), ElementsAre(9108, 9113));
  o.steps.project_settings = false;
  EXPECT_THAT(seeds_without(trials(o, 9103, 11), leads_right), ElementsAre(9103, 9108, 9109, 9113));
}

// A beam 150 mm above the bed: at its top centre the chains are horizontal. An error of the mark
// upwards changes neither chain; an error sideways changes both, with opposite signs. The two
// lengths there are one error observed twice, and one number that is nearly exact.
TEST(Ablation, WithoutWhiteningLessIsFound) {
  TrialOptions o = ablation_options(Mix::single);
  o.recipe.machine.emplace();
  for (auto& axis : o.recipe.machine->axis) axis.y = 760.0;
  o.recipe.noise = {0.05, 1.0};
  o.recipe.delta = 6.0;
  const auto names_it_alone = [](const Trial& t) {
    return t.verdict == grid::diagnosis::Verdict::named && leads_right(t);
  };
  EXPECT_THAT(seeds_without(trials(o, 9601, 8), names_it_alone), ElementsAre(9602, 9605, 9608));
  o.steps.whiten = false;
  EXPECT_THAT(seeds_without(trials(o, 9601, 8), names_it_alone),
              ElementsAre(9601, 9602, 9603, 9605, 9606, 9608));
}

// The noise is three times the stated one. An estimate from the fit alone does not detect it.
TEST(Ablation, WithoutTheNoisesAnchorWrongNoiseIsNotSeen) {
  const auto said = [](const Trial& t) {
    return t.verdict == grid::diagnosis::Verdict::noise_larger_than_stated;
  };
  TrialOptions o = ablation_options(Mix::nothing);
  o.recipe.noise_ratio = 1.0 / 3.0;
  EXPECT_THAT(seeds_without(trials(o, 9700, 8), said), IsEmpty());
  o.steps.anchor_noise = false;
  EXPECT_EQ(seeds_without(trials(o, 9700, 8), said).size(), 8u);
}

// A gross error outweighs any cause if no point may be rejected.
TEST(Ablation, WithoutARobustStartSlipsMakeCauses) {
  const auto silent = [](const Trial& t) { return !names_something(t); };
  TrialOptions o = ablation_options(Mix::bad_points);
  EXPECT_THAT(seeds_without(trials(o, 9400, 6), silent), IsEmpty());
  o.steps.robust = false;
  EXPECT_EQ(seeds_without(trials(o, 9400, 6), silent).size(), 6u);
}

// Freely chosen places fit noise better than they should: the best of many is penalised only if the
// places are averaged.
TEST(Ablation, WithoutAveragingPlacesAreTooSure) {
  TrialOptions o = ablation_options(Mix::nothing);
  const auto placed = [](const std::vector<Trial>& all) {
    double sum = 0.0;
    for (const Trial& t : all) {
      for (const auto& h : t.hypotheses) {
        const bool has_place = h.effect == "angular_kink" || h.effect == "tooth_skip" ||
                               h.effect == "link_miscount" || h.effect == "sprocket_eccentricity";
        if (has_place) sum += h.probability;
      }
    }
    return sum / static_cast<double>(all.size());
  };
  const double with = placed(trials(o, 9000, 10));
  o.steps.average_location = false;
  const double without = placed(trials(o, 9000, 10));
  std::printf("probability of causes with a place: %.4f, without averaging %.4f\n", with, without);
  EXPECT_GT(without, 3.0 * with);
}

}  // namespace
}  // namespace chaintrue::sealed
