// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a map after a change of the machine, with five points and 0.3 mm of noise, and points
// planned for it.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "grid/files/check_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/map_check.hpp"
#include "grid/planning/check_plan.hpp"
#include "grid/random.hpp"
#include "model/chains/chain_changes.hpp"
#include "tests/holes/checked_map.hpp"

namespace chaintrue::grid {
namespace {

using model::MarkPoint;
using testing::HasSubstr;
using testing_support::classic;
using testing_support::grow;
using testing_support::kFive;
using testing_support::kNoiseMm;
using testing_support::measured_machine;
using testing_support::MeasuredMachine;
using testing_support::read_at;

const MeasuredMachine& mapped() {
  static const MeasuredMachine one = measured_machine(1);
  return one;
}

MeasuredGrid five_points(const model::Machine& truth, std::uint64_t seed) {
  Random random(seed);
  return read_at(kFive, truth, random);
}

TEST(MapCheck, FindsChangesFromThePlannedPoints) {
  for (const testing_support::MachineChange& change : testing_support::machine_changes()) {
    SCOPED_TRACE(testing::Message() << change.name << ", seeds 1 and 40");
    Random random(1, 40);
    model::Machine changed = mapped().truth;
    change.happens(changed, random);
    const auto check = check_map(mapped().map, read_at(mapped().planned, changed, random));
    ASSERT_TRUE(check) << check.error().sentence();
    EXPECT_EQ(check->verdict, change.verdict);
    EXPECT_EQ(check->hypotheses.front().what, change.what);
    if (check->verdict != CheckVerdict::valid_after_rezeroing) continue;
    // Five readings of 0.3 mm and the map's own error: 0.4 mm; three of these.
    EXPECT_NEAR(check->new_zero_mm[0] - mapped().map.machine()->chain_zero.left_mm,
                changed.chain_zero.left_mm - mapped().truth.chain_zero.left_mm, 1.2);
  }
}

/// The significance of both chains' growth, combined: the plan's criterion.
double together(const model::PerSide<double>& sigmas) {
  return 2.0 / (1.0 / std::pow(sigmas.left, 2) + 1.0 / std::pow(sigmas.right, 2));
}

TEST(CheckPlan, IsLocallyOptimal) {
  const MeasuredMachine& one = mapped();
  const CheckPlanRequest request;
  const auto plan = plan_check(one.map, request);
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->marks.size(), 5u);
  const double best = together(plan->expected_sigmas);
  EXPECT_GT(best, together(*expected_sigmas(one.map, kFive, request)));
  Random random(11);
  constexpr int kTries = 200;
  for (int k = 0; k < kTries; ++k) {
    std::vector<MarkPoint> moved = plan->marks;
    moved[static_cast<std::size_t>(k) % moved.size()] = {random.uniform(-1200.0, 1200.0),
                                                         random.uniform(-590.0, 590.0)};
    // Positions off the lattice may be slightly better: moved by a third of its spacing.
    EXPECT_LT(together(*expected_sigmas(one.map, moved, request)), 1.02 * best) << "try " << k;
  }
}

TEST(CheckPlan, WithPoorReadingsGrowthIsAllOfTheLengthsOverTheNoise) {
  // If readings are far less accurate than the map and than any shift of a zero, nothing else has
  // this signature: it is known by e |l| / sigma, l the lengths at the points.
  const MeasuredMachine& one = mapped();
  constexpr double kPoorMm = 200.0;
  const auto reply = expected_sigmas(one.map, kFive, {.length_mm = kPoorMm});
  ASSERT_TRUE(reply);
  const model::ReadingModel model(one.truth);
  model::PerSide<double> squares;
  for (const MarkPoint& mark : kFive) {
    const model::ChainLengths lengths = model.at(model::identity_placement(mark))->lengths;
    squares.left += lengths.left_mm * lengths.left_mm;
    squares.right += lengths.right_mm * lengths.right_mm;
  }
  for (const model::Side side : model::kSides) {
    // Zeros of 2 mm take 5 * 2^2 / 200^2 of it at most.
    EXPECT_NEAR(
        reply->operator[](side) / (model::kPitchGrowthSigma * std::sqrt(squares[side]) / kPoorMm),
        1.0, 1e-3);
  }
}

TEST(CheckPlan, MorePointsAndFinerReadingsDetectSmallerChanges) {
  const CompensationMap& map = mapped().map;
  const double five = together(plan_check(map, {})->expected_sigmas);
  EXPECT_GT(together(plan_check(map, {.points = 7})->expected_sigmas), five);
  EXPECT_GT(together(plan_check(map, {.length_mm = 0.1})->expected_sigmas), five);
}

TEST(CheckPlan, NumbersOutOfRangeThrow) {
  EXPECT_THROW((void)plan_check(mapped().map, {.points = 2}), std::invalid_argument);
  EXPECT_THROW((void)plan_check(mapped().map, {.margin_mm = 700.0}), std::invalid_argument);
}

TEST(MapCheck, ProbabilitiesSumToOneAndFollowTheVerdicts) {
  const auto check = check_map(mapped().map, five_points(mapped().truth, 3));
  double sum = 0.0;
  std::array<double, 3> by_verdict{};
  for (const CheckHypothesis& hypothesis : check->hypotheses) {
    sum += hypothesis.probability;
    by_verdict[static_cast<std::size_t>(hypothesis.verdict)] += hypothesis.probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12) << "rounding";
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(by_verdict[i], check->probability[i], 1e-12);
  EXPECT_TRUE(check->is_valid_as_it_is());
}

TEST(MapCheck, ReportsWhatOnePointCannotDetermine) {
  // One point, 1 mm too long on one chain: a zero, a pitch, or the point itself.
  model::Machine machine = mapped().truth;
  machine.chain_zero.left_mm += 1.5;
  MeasuredGrid grid = five_points(machine, 9);
  grid.points.resize(1);
  const auto check = check_map(mapped().map, grid);
  ASSERT_TRUE(check);
  EXPECT_THAT(check->not_separable, HasSubstr("These points do not distinguish"));
  EXPECT_FALSE(check->is_valid_as_it_is());
}

TEST(MapCheck, NamesASingleBadPoint) {
  MeasuredGrid grid = five_points(mapped().truth, 5);
  grid.points[3].lengths->left_mm += 14.0;
  const auto check = check_map(mapped().map, grid);
  EXPECT_EQ(check->hypotheses.front().what, model::Change::bad_point);
  EXPECT_THAT(check->sentence, HasSubstr("Measure point 4 again"));
  EXPECT_THAT(files::write_map_check(*check), HasSubstr("\"point\": 3"));
}

TEST(MapCheck, HolesFindASkippedToothAndAGrownPitch) {
  const auto made = testing_support::cut_holes(4);
  const CompensationMap map = joint_fit(made.set)->map;
  const auto verdict = [&map](const model::Machine& truth) {
    const auto again = synthetic::simulate_holes(testing_support::nine_holes(),
                                                 testing_support::usual_holes(5), truth);
    return check_map(map, again->set)->verdict;
  };
  EXPECT_EQ(verdict(made.truth), CheckVerdict::valid);
  model::Machine skipped = made.truth;
  skipped.chain_zero.left_mm += 6.35;
  EXPECT_NE(verdict(skipped), CheckVerdict::valid);
  model::Machine worn = made.truth;
  grow(worn, "both");
  grow(worn, "both");
  EXPECT_EQ(verdict(worn), CheckVerdict::measure_again);
}

/// Probabilities of the machine's possible changes, among these alone.
std::vector<double> of_the_machine(const CompensationMap& map, const MeasuredFile& file) {
  const auto check = check_map(map, {file});
  EXPECT_TRUE(check) << check.error().sentence();
  std::vector<std::pair<std::string, double>> reply;
  double sum = 0.0;
  for (const CheckHypothesis& h : check->hypotheses) {
    if (h.what == model::Change::bad_point) continue;
    reply.emplace_back(fmt::format("{} {} {}", name(h.what), h.side, h.count), h.probability);
    sum += h.probability;
  }
  std::sort(reply.begin(), reply.end());
  std::vector<double> result;
  for (const auto& [what, probability] : reply) result.push_back(probability / sum);
  return result;
}

void expect_equal(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(MapCheck, RepeatsOfAMarkEqualSingleReadings) {
  constexpr std::uint64_t kSeed = 19;
  SCOPED_TRACE(kSeed);
  const MeasuredMachine& one = mapped();
  model::Machine machine = one.truth;
  machine.chain_zero.left_mm += 0.3;  // several hypotheses are left
  MeasuredGrid together;
  for (std::uint64_t k = 0; k < 4; ++k) {
    const MeasuredGrid again = five_points(machine, kSeed + k);
    together.noise = again.noise;
    together.points.insert(together.points.end(), again.points.begin(), again.points.end());
  }
  MeasuredGrid apart = together;
  // Marks so near each other that their readings do not differ count as separate marks.
  for (std::size_t i = 0; i < apart.points.size(); ++i)
    apart.points[i].mark.x_mm += 1e-8 * static_cast<double>(i);
  ASSERT_EQ(check_map(one.map, together)->residuals.size(), 10u);
  ASSERT_EQ(check_map(one.map, apart)->residuals.size(), 40u);
  // The marks' own 1e-7 mm over 0.3 mm of noise, and rounding.
  expect_equal(of_the_machine(one.map, {"together", together}),
               of_the_machine(one.map, {"apart", apart}), 1e-6);
}

TEST(MapCheck, RepeatsOfADistanceEqualSingleReadings) {
  const auto made = testing_support::cut_holes(4);
  const CompensationMap map = joint_fit(made.set)->map;
  MeasuredHoles together = made.set;
  MeasuredHoles mean = made.set;
  Random random(23);
  for (std::size_t k = 0; k < made.set.distances.size(); ++k) {
    HoleDistance again = made.set.distances[k];
    std::swap(again.from, again.to);
    again.distance_mm += 0.5 * random.normal();
    again.sigma_mm = 0.7;
    together.distances.push_back(again);
    const double first = 1.0 / std::pow(sigma_of(made.set, made.set.distances[k]), 2);
    const double second = 1.0 / std::pow(0.7, 2);
    HoleDistance& one = mean.distances[k];
    one.distance_mm = (first * one.distance_mm + second * again.distance_mm) / (first + second);
    one.sigma_mm = 1.0 / std::sqrt(first + second);
  }
  ASSERT_EQ(check_map(map, together)->residuals.size(), made.set.distances.size());
  expect_equal(of_the_machine(map, {"together", together}), of_the_machine(map, {"mean", mean}),
               1e-9);  // rounding
}

/// Readings at marks of a displaced sheet.
MeasuredGrid on_a_sheet(const model::SheetPlacement& sheet, const model::Machine& machine,
                        std::uint64_t seed) {
  Random random(seed);
  std::vector<MarkPoint> places;
  for (const MarkPoint& mark : kFive) {
    const model::BedPoint place = sheet.to_bed(mark);
    places.push_back({place.x_mm, place.y_mm});
  }
  MeasuredGrid grid = read_at(places, machine, random);
  for (std::size_t i = 0; i < kFive.size(); ++i) grid.points[i].mark = kFive[i];
  grid.sheet = SheetUncertainty{20.0, 10.0};
  return grid;
}

TEST(MapCheck, ASheetLaidAsideIsNoChangeOfTheMachine) {
  SCOPED_TRACE("seed 31");
  MeasuredGrid grid = on_a_sheet({10.0, 0.0, 0.005}, mapped().truth, 31);
  EXPECT_EQ(check_map(mapped().map, grid)->verdict, CheckVerdict::valid);
  // A sheet stated to lie exactly is assumed to do so.
  grid.sheet.reset();
  EXPECT_EQ(check_map(mapped().map, grid)->verdict, CheckVerdict::measure_again);
}

TEST(MapCheck, AChainThatSkippedAToothIsFoundOnASheetLaidAside) {
  model::Machine skipped = mapped().truth;
  skipped.chain_zero.left_mm += 6.35;
  const auto check = check_map(mapped().map, on_a_sheet({10.0, 0.0, 0.005}, skipped, 32));
  EXPECT_EQ(check->verdict, CheckVerdict::valid_after_rezeroing) << "seed 32";
}

TEST(MapCheck, AHandLaidSheetWithZeroSigmasIsExact) {
  MeasuredGrid exact = five_points(mapped().truth, 33);
  MeasuredGrid laid = exact;
  laid.sheet = SheetUncertainty{0.0, 0.0};
  // A sheet held to 1e-6 mm and 1e-9 rad against noise of 0.3 mm.
  expect_equal(of_the_machine(mapped().map, {"exact", exact}),
               of_the_machine(mapped().map, {"laid", laid}), 1e-6);
}

TEST(MapCheck, RemovesEffectsOfPaperAndVisit) {
  const auto verdict = [](const model::AppliedEffect& effect, bool known) {
    Random random(34);
    model::Machine disturbed = mapped().truth;
    disturbed.effects.push_back(effect);
    const model::MarkFrame marks(disturbed);
    std::vector<model::Visit> visits;
    for (std::size_t i = 0; i < kFive.size(); ++i)
      visits.push_back({model::identity_placement(marks.place(kFive[i])), static_cast<int>(i)});
    const auto read = model::readings(model::ReadingModel(disturbed), visits).value();
    MeasuredGrid grid;
    grid.machine = classic();
    if (known) grid.machine->effects.push_back(effect);
    grid.noise = StatedNoise{kNoiseMm, 0.0, 15.0};
    for (std::size_t i = 0; i < kFive.size(); ++i) {
      const model::ChainLengths lengths{read[i].left_mm + kNoiseMm * random.normal(),
                                        read[i].right_mm + kNoiseMm * random.normal()};
      grid.points.push_back({kFive[i], lengths, {}, static_cast<int>(i)});
    }
    return check_map(mapped().map, grid)->verdict;
  };
  const model::AppliedEffect effects[] = {{"tape_scale", "both", {{"scale", 0.003}}},
                                          {"drift", "left", {{"rate_mm_per_visit", 1.0}}}};
  for (const model::AppliedEffect& effect : effects) {
    EXPECT_EQ(verdict(effect, true), CheckVerdict::valid) << effect.effect << ", seed 34";
    EXPECT_NE(verdict(effect, false), CheckVerdict::valid) << effect.effect << ", seed 34";
  }
}

TEST(MapCheck, ReportsAPointOffTheMap) {
  MeasuredGrid grid = five_points(mapped().truth, 2);
  grid.points[0].mark = {5000.0, 0.0};
  const auto check = check_map(mapped().map, grid);
  ASSERT_FALSE(check);
  EXPECT_EQ(check.error().reason, CheckFailure::Reason::unreachable);
  EXPECT_THAT(check.error().sentence(), HasSubstr("(5000.0, 0.0)"));
}

}  // namespace
}  // namespace chaintrue::grid
