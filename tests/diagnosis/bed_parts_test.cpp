// SPDX-License-Identifier: GPL-3.0-or-later
// Probabilities averaged over quarters of the bed: which quarters there are, what the average keeps, and
// each quarter's probabilities compared with a comparison made anew.
#include "grid/diagnosis/bed_parts.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/downdating.hpp"
#include "grid/diagnosis/findings.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing_support::session_of;
using testing_support::verdict_alone;

const model::AppliedEffect kLongLeftOfParts{"chain_pitch_error", "left", {{"elongation", 0.0015}}};

/// A ridge that moves both chains, oblique to the bed, of a shape that no kernel has.
MeasuredGrid with_ridge(MeasuredGrid grid, double height_mm, double place_mm) {
  for (MeasuredPoint& point : grid.points) {
    const double along = 0.8 * point.mark.x_mm + 0.6 * point.mark.y_mm - place_mm;
    const double mm = height_mm * std::max(0.0, 1.0 - std::abs(along) / 400.0);
    point.lengths->left_mm += mm;
    point.lengths->right_mm -= 0.5 * mm;
  }
  return grid;
}

Analysis analysed(const MeasuredGrid& grid, bool averaged = true) {
  DiagnosisOptions options = verdict_alone();
  options.average_parts = averaged;
  return testing_support::analysis_of(grid, options);
}

std::vector<BedPart> parts_of_all(const Analysis& a) {
  return bed_parts(a.system, a.session.fewest_units);
}

double share_of_patterns(const ModelComparison& comparison) {
  double sum = 0.0;
  for (const CandidateModel& model : comparison.models) {
    if (model.discrepancy >= 0) sum += comparison.probability(model);
  }
  return sum;
}

TEST(BedParts, EachHasAQuarterOfTheReadingsOnOneSide) {
  const Analysis a = analysed(session_of({}, 1));
  const auto parts = parts_of_all(a);
  ASSERT_EQ(parts.size(), 16U);
  std::vector<int> times(a.system.units.size(), 0);
  for (const BedPart& part : parts) {
    for (const std::size_t u : part.units) ++times[u];
    // For 34 readings eight; the six repeats go with the marks that they repeat.
    EXPECT_GE(part.units.size(), a.system.units.size() / 4);
    EXPECT_LE(part.units.size(), a.system.units.size() / 4 + 2);
    // All on one side of a line: the left-out part reaches farther towards it than the rest.
    const auto reach = [&](std::size_t u) {
      const model::MarkPoint& mark = a.system.places[a.system.units[u].places.front().place].mark;
      return mark.x_mm * std::cos(part.towards_rad) + mark.y_mm * std::sin(part.towards_rad);
    };
    double least_out = 1e9;
    double most_left = -1e9;
    for (std::size_t u = 0; u < a.system.units.size(); ++u) {
      const bool out = std::find(part.units.begin(), part.units.end(), u) != part.units.end();
      (out ? least_out : most_left) =
          out ? std::min(least_out, reach(u)) : std::max(most_left, reach(u));
    }
    EXPECT_GT(least_out, most_left);
  }
  EXPECT_LT(*std::max_element(times.begin(), times.end()), 16);  // none is left out of all
}

TEST(BedParts, NeedEnoughReadings) {
  const Analysis a = analysed(session_of({}, 1));
  EXPECT_TRUE(bed_parts(a.system, a.system.units.size()).empty());
}

// For marks on two columns, what is left without one side is on one line for most of the directions.
TEST(BedParts, NeverLeaveALine) {
  const Analysis a = analysed(session_of({}, 1, 2, 7));
  for (const BedPart& part : parts_of_all(a)) {
    std::vector<double> x;
    for (std::size_t u = 0; u < a.system.units.size(); ++u) {
      if (std::find(part.units.begin(), part.units.end(), u) == part.units.end())
        x.push_back(a.system.places[a.system.units[u].places.front().place].mark.x_mm);
    }
    EXPECT_GT(*std::max_element(x.begin(), x.end()) - *std::min_element(x.begin(), x.end()), 1.0);
  }
}

// With only noise and a cause the likelihood is right: nothing is averaged.
TEST(Averaging, ChangesNothingWithoutAPattern) {
  const MeasuredGrid grid = session_of({kLongLeftOfParts}, 5);
  const Analysis whole = analysed(grid, false);
  const Analysis averaged = analysed(grid);
  EXPECT_TRUE(averaged.parts.empty());
  ASSERT_EQ(averaged.comparison.models.size(), whole.comparison.models.size());
  for (std::size_t k = 0; k < whole.comparison.models.size(); ++k) {
    EXPECT_EQ(averaged.comparison.models[k].regressors, whole.comparison.models[k].regressors);
    EXPECT_EQ(averaged.comparison.models[k].log_weight, whole.comparison.models[k].log_weight);
  }
}

// Given a pattern, each model without one keeps its probability, and so do all patterns together.
TEST(Averaging, KeepsTheModelsWithoutAPatternAndTheSumOfPatterns) {
  const MeasuredGrid grid = with_ridge(session_of({kLongLeftOfParts}, 7, 10, 6), 1.0, 200.0);
  const Analysis whole = analysed(grid, false);
  const Analysis averaged = analysed(grid);
  ASSERT_EQ(averaged.parts.size(), 16U);
  std::map<std::pair<std::vector<int>, std::size_t>, double> before;
  for (const CandidateModel& model : whole.comparison.models) {
    if (model.discrepancy < 0)
      before[{model.regressors, model.marginalised}] = whole.comparison.probability(model);
  }
  double sum = 0.0;
  for (const CandidateModel& model : averaged.comparison.models) {
    sum += averaged.comparison.probability(model);
    if (model.discrepancy >= 0) continue;
    // Logarithm and exponential of each model once more, and a sum over all.
    EXPECT_NEAR(averaged.comparison.probability(model),
                (before.at({model.regressors, model.marginalised})), 1e-9);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);  // rounding of a thousand addends
  EXPECT_NEAR(share_of_patterns(averaged.comparison), share_of_patterns(whole.comparison), 1e-9);
}

std::string name_of(const CauseId& cause) {
  return std::string(cause.effect->id) + std::string(model::effects::name(cause.side));
}

// A part by the whole comparison's models, and by a separate comparison: averaged over the parts,
// each cause's probability is the same within 0.03.
TEST(Averaging, EqualsComparisonsOfEachPart) {
  constexpr int kSeed = 1;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  const MeasuredGrid grid = with_ridge(session_of({kLongLeftOfParts}, kSeed, 10, 6), 1.02, -480.0);
  const Analysis a = analysed(grid);
  const Analysis whole = analysed(grid, false);
  ASSERT_EQ(a.parts.size(), 16U);
  std::map<std::string, std::pair<double, double>>
      by_cause;  // by the shortcut, by its own comparison
  for (const PartPosterior& part : a.parts) {
    std::vector<bool> excluded = nothing_rejected(a.system);
    for (const std::size_t u : part.left_out.units) excluded[u] = true;
    const ModelComparison own = compare_models(a.system, excluded, {});
    // As if the rest of the bed were a session.
    RegressorSystem split = a.system;
    for (const std::size_t u : part.left_out.units) split.units[u].observation = 1;
    const PartPosterior shortcut = session_posteriors(split, 1, whole.comparison).front();
    for (const auto& [cause, p] : shortcut.causes) by_cause[name_of(cause)].first += p / 16.0;
    for (const CandidateModel& model : own.models) {
      for (const int k : model.regressors) {
        by_cause[name_of(a.system.regressors[static_cast<std::size_t>(k)].cause)].second +=
            own.probability(model) / 16.0;
      }
    }
  }
  for (const auto& [cause, p] : by_cause) EXPECT_NEAR(p.first, p.second, 0.03) << cause;
}

TEST(Averaging, NamesTheQuarterThatDisagrees) {
  Diagnosis d;
  d.verdict = Verdict::named;
  const Hypothesis named{"chain_sag", "", 0.7};
  const double upper_left = 2.3;
  d.bed_parts = {{0.2, "", 15, named, {named}},
                 {upper_left, "", 15, {"tape_scale", "x", 0.72}, {{"chain_sag", "", 0.2}}}};
  EXPECT_THAT(parts_in_words(d),
              Contains("Without the upper left quarter of the bed it is tape_scale (72 %)."));
  d.bed_parts.pop_back();
  EXPECT_TRUE(parts_in_words(d).empty());
}

TEST(Sessions, SeparateCommonAndSingleCauses) {
  Diagnosis d;
  d.verdict = Verdict::several_causes;
  const auto of = [](const char* session, double skew, double friction) {
    PartFinding one;
    one.session = session;
    one.named = {{"axes_skew", "", skew}, {"direction_hysteresis", "left", friction}};
    return one;
  };
  d.sessions = {of("C.json", 0.99, 0.97), of("D.json", 0.95, 0.02)};
  const auto words = parts_in_words(d);
  EXPECT_THAT(words, Contains(HasSubstr("Each session alone shows axes_skew.")));
  EXPECT_THAT(words,
              Contains(HasSubstr("contradict each other: direction_hysteresis is in C.json (97 %), "
                                 "not in D.json (2 %)")));
}

TEST(Sessions, RefuseACopy) {
  Measured both;
  both.add({"one.json", session_of({}, 11)});
  both.add({"two.json", session_of({}, 11)});
  const auto d = diagnose(both, verdict_alone());
  ASSERT_FALSE(d);
  EXPECT_EQ(d.error().sentence(),
            "two.json has the same readings as one.json, to the last digit, and a copy adds "
            "nothing. Leave it out");
}

// For two files without numbers of visits, the first driven there and back in columns by a machine with friction.
TEST(Sessions, TheOrderOfTheFirstIsFoundInItsReadings) {
  synthetic::SyntheticSpec spec;
  spec.design.columns = 9;
  spec.design.rows = 6;
  spec.order = synthetic::VisitingOrder::serpentine_columns;
  spec.noise = {.length_mm = 0.1, .position_mm = 0.2};
  spec.stated = StatedNoise{0.1, 0.2, 12.0};
  spec.hidden = {{"direction_hysteresis", "left", {{"half_width_mm", 0.4}}}};
  Measured both;
  for (const char* name : {"one.json", "two.json"}) {
    MeasuredGrid grid = synthetic::generate(model::Machine{}, spec).value().grid;
    for (MeasuredPoint& point : grid.points) point.order.reset();
    both.add({name, std::move(grid)});
    spec.order = synthetic::VisitingOrder::random;
    ++spec.seed;
  }
  const auto d = diagnose(both, verdict_alone());
  ASSERT_TRUE(d) << d.error().sentence();
  ASSERT_TRUE(d->visiting_order) << d->sentence;
  EXPECT_FALSE(d->visiting_order->order.rows);
  EXPECT_TRUE(d->visiting_order->order.serpentine);
  EXPECT_THAT(d->notes.front(), HasSubstr("order in which the marks of one.json were visited"));
  ASSERT_FALSE(d->causes.empty()) << d->sentence;
  EXPECT_EQ(d->causes.front().cause.effect->id, "direction_hysteresis");
  const Measured first{{"one.json", *both.grids().front()}};
  const auto alone = diagnose(first, verdict_alone());
  ASSERT_TRUE(alone && alone->visiting_order);
  EXPECT_EQ(alone->visiting_order->probability, d->visiting_order->probability);
}

// If probabilities are averaged over parts of the bed, each session's are still those of its
// readings.
TEST(Sessions, AreWeighedSeparatelyWithAPattern) {
  const auto session = [](const std::vector<model::AppliedEffect>& hidden, std::uint64_t seed) {
    return with_ridge(session_of(hidden, seed, 8, 5), 1.5, 100.0);
  };
  Measured both;
  both.add({"one.json", session({kLongLeftOfParts}, 11)});
  both.add({"two.json", session({kLongLeftOfParts}, 12)});
  const auto d = diagnose(both, verdict_alone());
  ASSERT_TRUE(d) << d.error().sentence();
  ASSERT_FALSE(d->bed_parts.empty()) << "nothing was averaged: " << d->sentence;
  ASSERT_EQ(d->sessions.size(), 2U) << d->sentence;
  for (const PartFinding& own : d->sessions) {
    ASSERT_EQ(own.named.size(), 1U);
    EXPECT_EQ(own.units, 46U);  // 40 marks, six of them twice
    EXPECT_GT(own.named.front().probability, 0.9)
        << own.session << ": " << own.named.front().effect;
    EXPECT_EQ(own.likeliest.effect, own.named.front().effect);
  }
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
