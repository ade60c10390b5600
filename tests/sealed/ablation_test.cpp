// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Each step of the procedure earns its place: left out, it costs right names or makes wrong ones.
#include <gtest/gtest.h>

#include <algorithm>

#include "sealed/posed.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Mix;

TrialOptions options(Mix mix) {
  TrialOptions o;
  o.recipe.kind = mix;
  o.recipe.points = 28;
  return o;
}

// Signatures that are not projected share most of their length with the settings' own.
TEST(Ablation, WithoutProjectionCausesAreMistaken) {
  TrialOptions o = options(Mix::single);
  o.steps.project_settings = false;
  const auto all = trials(o, 9100, 40);
  EXPECT_LT(std::count_if(all.begin(), all.end(), leads_right), 32);
}

}  // namespace
}  // namespace chaintrue::sealed
