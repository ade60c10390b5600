// SPDX-License-Identifier: GPL-3.0-or-later
// The scale by a taped distance next to belts that stretch when they are pulled.
#include <gmock/gmock.h>

#include <cmath>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/anchors_file.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid {
namespace {

using model::Belt;
using testing::HasSubstr;
using testing::Not;

/// Belts that stretch by 0.4 %, and the diagonal of the true frame.
MeasuredBelts stretched_and_taped() {
  MeasuredBelts belts =
      testing_support::belts_session({.width_share = 0.7,
                                      .height_share = 0.6,
                                      .noise_mm = 0.3,
                                      .hidden = {{"belt_stretch", "", {{"elongation", 0.004}}}},
                                      .seed = 7});
  const auto anchors = testing_support::truth().anchors;
  const model::Anchor& from = anchors.tl;
  const model::Anchor& to = anchors.br;
  belts.distances = {
      {.from = Belt::tl,
       .to = Belt::br,
       .distance_mm = std::hypot(from.x_mm - to.x_mm, from.y_mm - to.y_mm, from.z_mm - to.z_mm),
       .sigma_mm = 1.0}};
  return belts;
}

TEST(BeltsDiagnosis, CountsAStretchInTheScaleOnce) {
  const MeasuredBelts belts = stretched_and_taped();
  const auto found = diagnosis::diagnose(belts);
  ASSERT_TRUE(found);
  ASSERT_TRUE(found->belts && found->belts->scale);
  const BeltScale& scale = *found->belts->scale;
  // The tape measures the true frame, so the scale is 1; three sigmas.
  EXPECT_NEAR(scale.factor, 1.0, 3.0 * scale.sigma);
  // A stretch of 0.4 % counted a second time is far outside.
  EXPECT_LT(scale.sigma, 0.001);
  EXPECT_THAT(files::write_maslow4_settings(*found).text, Not(HasSubstr("Maslow_Scale")));
}

}  // namespace
}  // namespace chaintrue::grid
