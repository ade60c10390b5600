// SPDX-License-Identifier: GPL-3.0-or-later
// Anchors fitted to simulated lengths, for every kind of printed length; bad readings found; the scale
// determined by a tape only.
#include "grid/belts/belts_fit.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grid/belts/scale_by_tape.hpp"
#include "grid/statistics.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tests/belts/simulated_belts.hpp"

namespace chaintrue::grid {
namespace {

using belts::anchors_of;
using belts::AnchorVector;
using model::Belt;
using model::BeltLengths;
using testing::ElementsAre;
using testing::HasSubstr;

AnchorVector off(const BeltsFit& fit, const SimulatedBelts& set) {
  return anchors_of(fit.machine) - anchors_of(set.truth);
}

class BeltsFitOfLengths : public testing::TestWithParam<BeltLengths> {};

INSTANTIATE_TEST_SUITE_P(Every, BeltsFitOfLengths,
                         testing::Values(BeltLengths::belt, BeltLengths::belt_and_arm,
                                         BeltLengths::span),
                         [](const auto& tested) { return std::string(name(tested.param)); });

TEST_P(BeltsFitOfLengths, RecoversTheAnchorsWithoutNoise) {
  for (const std::uint64_t seed : {1, 2}) {
    for (const bool known : {true, false}) {
      const SimulatedBelts set = simulate({.seed = seed,
                                           .columns = 5,
                                           .rows = 5,
                                           .noise_mm = 0.0,
                                           .anchors_known = known,
                                           .lengths = GetParam()});
      const auto fit = fit_belts(set.belts);
      ASSERT_TRUE(fit) << "seed " << seed << ": " << fit.error().sentence();
      // A cost converged to 1e-12 leaves 1e-6 of a millimetre for each reading, and some thirty
      // times more for the anchors.
      EXPECT_LT(off(*fit, set).cwiseAbs().maxCoeff(), 1e-4) << "seed " << seed;
      EXPECT_TRUE(fit->bad.empty()) << "seed " << seed;
    }
  }
}

TEST(BeltsFit, TheSpreadDividesByTheChecksAndTheRmsByTheReadings) {
  const SimulatedBelts set = simulate({.seed = 4});
  const auto fit = fit_belts(set.belts);
  ASSERT_TRUE(fit);
  ASSERT_TRUE(fit->bad.empty());
  EXPECT_EQ(fit->checks, 2 * 81 - 5);
  // One sum of squares with two denominators, to rounding.
  EXPECT_NEAR(fit->rms_mm * std::sqrt(4.0 * 81), fit->residual_sigma_mm * std::sqrt(2.0 * 81 - 5),
              1e-9);
}

TEST(BeltsFit, InfluencesOnACoordinateAreCompleteAndMirrored) {
  const SimulatedBelts set = simulate({.seed = 5});
  const auto fit = fit_belts(set.belts);
  ASSERT_TRUE(fit);
  for (const AnchorCoordinate& c : fit->coordinates) {
    const auto& share = c.variance_share;
    EXPECT_NEAR(share.tl + share.tr + share.bl + share.br, 1.0, 1e-12) << c.name;  // rounding
    for (const Belt belt : model::kBelts) EXPECT_GE(share[belt], 0.0) << c.name;
  }
  // An anchor's own belt has the largest share.
  EXPECT_GT(fit->coordinates[0].variance_share.tl, fit->coordinates[0].variance_share.tr);
  EXPECT_GT(fit->coordinates[2].variance_share.tr, fit->coordinates[2].variance_share.tl);
}

TEST(BeltsFit, FindsSeveralBadReadings) {
  const auto fit = fit_belts(with_four_bad_readings(11).belts);
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->bad.size(), 4U);
  EXPECT_EQ(fit->bad[0].point, 60U);
  EXPECT_EQ(fit->bad[0].belt, Belt::tr);
  // The prediction by all other readings has a sigma of some noise, 1.5 mm where two belts are
  // parallel.
  EXPECT_NEAR(fit->bad[0].residual_mm, 150.0, 8.0);
  EXPECT_EQ(fit->bad[3].point, 31U);
  EXPECT_EQ(fit->bad[3].belt, Belt::br);
  // 157 checks less four, at 0.5 mm: within four sigmas.
  EXPECT_NEAR(fit->residual_sigma_mm, 0.5, 4.0 * 0.5 / std::sqrt(2.0 * 153.0));
}

TEST(BeltsFit, NamesAPlaceWithFewConsistentReadings) {
  SimulatedBelts set = simulate({.seed = 12});
  set.belts.points[40].lengths_mm.tl += 60.0;
  set.belts.points[40].lengths_mm.bl += 35.0;
  const auto fit = fit_belts(set.belts);
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->bad_points, ElementsAre(40U));
}

TEST(BeltsFit, PredictsTheLowerBeltsToTheNoise) {
  const SimulatedBelts set = simulate({.seed = 21});
  const auto fit = fit_belts(set.belts);
  ASSERT_TRUE(fit && fit->half_left_out);
  EXPECT_EQ(fit->one_left_out.readings, 162U);
  EXPECT_EQ(fit->half_left_out->readings, 162U);
  // A lower belt has its own 0.5 mm and the propagated noise of the upper two: between sqrt 2 and
  // 2.5 times one belt's noise over the middle of a frame.
  EXPECT_GT(fit->one_left_out.rms_mm, 0.6);
  EXPECT_LT(fit->one_left_out.rms_mm, 1.25);
  // Anchors fitted to half of the positions are less accurate, by a tenth or so.
  EXPECT_GT(fit->half_left_out->rms_mm, 0.9 * fit->one_left_out.rms_mm);
  EXPECT_LT(fit->half_left_out->rms_mm, 1.3 * fit->one_left_out.rms_mm);
}

TEST(BeltsFit, LeftOutPlaceEqualsAFitWithoutIt) {
  SimulatedBelts set = simulate({.seed = 22, .columns = 4, .rows = 4});
  const auto fit = fit_belts(set.belts);
  ASSERT_TRUE(fit && fit->bad.empty());
  std::vector<double> residual_mm;
  for (std::size_t k = 0; k < set.belts.points.size(); ++k) {
    MeasuredBelts others = set.belts;
    others.points.erase(others.points.begin() + static_cast<std::ptrdiff_t>(k));
    const auto without = fit_belts(others);
    ASSERT_TRUE(without && without->bad.empty());
    const auto& lengths = set.belts.points[k].lengths_mm;
    const auto place = model::place_of_upper(without->machine, lengths.tl, lengths.tr);
    const auto prediction = model::lengths_at(without->machine, place.value());
    residual_mm.push_back(lengths.bl - prediction->bl);
    residual_mm.push_back(lengths.br - prediction->br);
  }
  // Anchors move by 3 mm at most when one position is left out: second order of that over 1 m, 0.01
  // mm.
  EXPECT_NEAR(fit->one_left_out.rms_mm, rms(residual_mm), 0.01);
}

TEST(BeltsFit, NeedsATapeForTheScale) {
  SimulatedBelts set = simulate({.seed = 31});
  EXPECT_FALSE(fit_belts(set.belts)->scale);
  // All readings 1.005 times as long: the frame, and the spread, 1.005 times as large.
  MeasuredBelts longer = set.belts;
  for (BeltPoint& point : longer.points) {
    for (const Belt belt : model::kBelts) point.lengths_mm[belt] *= 1.005;
  }
  const auto fit = fit_belts(set.belts);
  const auto scaled = fit_belts(longer);
  ASSERT_TRUE(fit && scaled);
  // The two costs converge with the same tolerance as above.
  EXPECT_LT((anchors_of(scaled->machine) - 1.005 * anchors_of(fit->machine)).cwiseAbs().maxCoeff(),
            1e-4);
  EXPECT_NEAR(scaled->residual_sigma_mm, 1.005 * fit->residual_sigma_mm, 1e-6);
  EXPECT_FALSE(scaled->scale);
  // A tape between the lower anchors of that frame.
  longer.distances.push_back({Belt::bl, Belt::br, set.truth.anchors.br.x_mm, 1.0});
  const auto taped = fit_belts(longer);
  ASSERT_TRUE(taped && taped->scale);
  EXPECT_NEAR(taped->scale->factor, 1.0 / 1.005, 4.0 * taped->scale->sigma);
  // 1 mm of tape and 0.5 mm of br_x over 3 m.
  EXPECT_LT(taped->scale->sigma, 1e-3);
  EXPECT_GT(taped->scale->sigma, 2e-4);
}

TEST(BeltsFit, ProposesTheBestDistanceForTheScale) {
  for (const bool known : {true, false}) {
    for (const int columns : {3, 9}) {
      SCOPED_TRACE(testing::Message() << "anchors known " << known << ", columns " << columns);
      const SimulatedBelts set = simulate(
          {.seed = 33, .columns = columns, .rows = columns == 3 ? 2 : 9, .anchors_known = known});
      const auto fit = fit_belts(set.belts);
      ASSERT_TRUE(fit);
      const auto best = distance_for_scale(set.belts, *fit);
      ASSERT_TRUE(best);
      const auto sigma_of = [&](BeltDistance distance) {
        const auto& a = fit->machine.anchors;
        const auto* from = std::get_if<Belt>(&distance.from);
        const auto* to = std::get_if<Belt>(&distance.to);
        if (from != nullptr && to != nullptr)
          distance.distance_mm =
              std::hypot(a[*from].x_mm - a[*to].x_mm, a[*from].y_mm - a[*to].y_mm);
        MeasuredBelts taped = set.belts;
        taped.distances.push_back(distance);
        return fit_belts(taped)->scale->sigma;
      };
      // As predicted by the fit, so that neither scale nor sigma changes: rounding of one solver.
      EXPECT_NEAR(sigma_of(best->distance), best->sigma, 0.01 * best->sigma);
      for (const Belt from : model::kBelts) {
        for (const Belt to : model::kBelts) {
          // A hundredth worse counts as equal.
          if (from < to) {
            EXPECT_GT(sigma_of({from, to, 0.0, 1.0}), 0.98 * best->sigma);
          }
        }
      }
    }
  }
}

TEST(BeltsFit, FindsTheScaleFromTapesBetweenAnchorsPointsAndHoles) {
  constexpr double kTrueScale = 0.996;
  const SimulatedBelts exact = simulate({.seed = 1, .noise_mm = 0.0});
  const auto& a = exact.truth.anchors;
  // A hole is at the position where the upper belts put the tool when commanded with the stated
  // anchors.
  const auto hole = [&](model::BedPoint command) {
    const model::FramePoint meant = model::to_frame(exact.belts.machine, command);
    const auto lengths = model::lengths_at(exact.belts.machine, meant).value();
    return model::place_of_upper(exact.truth, lengths.tl, lengths.tr).value();
  };
  const model::BedPoint left{-600.0, 200.0};
  const model::BedPoint right{600.0, -200.0};
  const auto scale_of = [&](BeltEnd from, BeltEnd to, model::FramePoint p, model::FramePoint q) {
    MeasuredBelts taped = exact.belts;
    taped.distances.push_back(
        {from, to, kTrueScale * std::hypot(p.x_mm - q.x_mm, p.y_mm - q.y_mm), 1.0});
    return fit_belts(taped)->scale->factor;
  };
  // Anchors are found to 1e-4 mm, as without a tape, of a distance of 600 mm at least.
  constexpr double kTolerance = 1e-6;
  EXPECT_NEAR(scale_of(Belt::tl, Belt::tr, {a.tl.x_mm, a.tl.y_mm}, {a.tr.x_mm, a.tr.y_mm}),
              kTrueScale, kTolerance);
  EXPECT_NEAR(scale_of(std::size_t{0}, std::size_t{80}, exact.places[0], exact.places[80]),
              kTrueScale, kTolerance);
  EXPECT_NEAR(scale_of(CutHole{left}, CutHole{right}, hole(left), hole(right)), kTrueScale,
              kTolerance);
}

TEST(BeltsFit, AContradictoryTapeDoesNotWidenTheBeltsSigmas) {
  SimulatedBelts set = simulate({.seed = 32});
  const auto alone = fit_belts(set.belts);
  const auto& a = set.truth.anchors;
  set.belts.distances.push_back({Belt::bl, Belt::br, a.br.x_mm, 1.0});
  set.belts.distances.push_back({Belt::tl, Belt::tr, 1.01 * (a.tr.x_mm - a.tl.x_mm), 1.0});
  const auto fit = fit_belts(set.belts);
  ASSERT_TRUE(alone && fit && fit->scale);
  // One sum of squares from two starts.
  EXPECT_NEAR(fit->residual_sigma_mm, alone->residual_sigma_mm, 1e-6);
  EXPECT_TRUE(fit->bad.empty() && fit->bad_points.empty());
  // 15 mm apart for the two spans, and both are reported.
  EXPECT_GT(fit->scale->residuals_mm[1] - fit->scale->residuals_mm[0], 10.0);
}

TEST(BeltsFit, RejectsTheReadingNotThePlaceIfPlacesAreFew) {
  SimulatedBelts set = simulate({.seed = 33, .columns = 3, .rows = 3, .noise_mm = 0.2});
  set.belts.points[4].lengths_mm.tl += 80.0;
  const auto fit = fit_belts(set.belts);
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->bad.size(), 1U);
  EXPECT_EQ(fit->bad[0].point, 4U);
  EXPECT_EQ(fit->bad[0].belt, Belt::tl);
  EXPECT_TRUE(fit->bad_points.empty());
}

TEST(BeltsFit, RefusesUnfittableDataWithAReason) {
  using Reason = BeltsFitFailure::Reason;
  SimulatedBelts set = simulate({.seed = 41, .columns = 4, .rows = 4});
  MeasuredBelts few = set.belts;
  few.points.resize(4);
  EXPECT_EQ(fit_belts(few).error().reason, Reason::too_few_points);
  MeasuredBelts line = set.belts;
  line.points.clear();
  for (int i = 0; i < 12; ++i) {
    line.points.push_back({model::lengths_at(set.truth, {1200.0, 700.0 + 4.0 * i}).value()});
    line.points.back().lengths_mm.bl += i % 2 == 0 ? 0.3 : -0.3;
  }
  EXPECT_EQ(fit_belts(line).error().reason, Reason::not_determined);
  MeasuredBelts swapped = set.belts;
  for (BeltPoint& point : swapped.points) std::swap(point.lengths_mm.tl, point.lengths_mm.tr);
  EXPECT_EQ(fit_belts(swapped).error().reason, Reason::no_frame);
  EXPECT_THAT(fit_belts(swapped).error().sentence(), HasSubstr("under its own belt"));
  MeasuredBelts hole = set.belts;
  hole.machine.anchors_known = false;
  hole.distances.push_back({CutHole{{0.0, 0.0}}, Belt::bl, 1800.0, 1.0});
  EXPECT_EQ(fit_belts(hole).error().reason, Reason::hole_without_anchors);
}

}  // namespace
}  // namespace chaintrue::grid
