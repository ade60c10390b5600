// SPDX-License-Identifier: GPL-3.0-or-later
// The analysis of causes on a mechanism that no product code knows: its own effect is named from a
// drawing that it made, with its size, and nothing is named where nothing is wrong.
#include <gmock/gmock.h>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/observation/drawn_measures.hpp"
#include "grid/random.hpp"
#include "tests/contracts/toy_mechanism.hpp"

namespace chaintrue::grid::diagnosis::toy_tests {
namespace {

using observation::DrawnMeasure;
using observation::DrawnPoint;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kRulerMm = 0.3;
constexpr std::uint64_t kSeed = 11;

/// Nine crosses of a rectangle, each length between two of them, the bows of its rows and columns: as
/// `actual` draws them for the lengths of `set`.
std::shared_ptr<const observation::DrawnMeasures> drawn(const model::Mechanism& set,
                                                        const model::Mechanism& actual) {
  std::vector<DrawnPoint> points;
  std::vector<Eigen::Vector2d> pens;
  for (const double y : {-1300.0, -950.0, -600.0}) {
    for (const double x : {-400.0, 0.0, 400.0}) {
      const model::ChainLengths paid_out = set.first_lengths({x, y}).value();
      points.push_back({std::string(1, static_cast<char>('A' + points.size())), {x, y}, paid_out});
      const auto pen = actual.locate_by_first(paid_out).value();
      pens.emplace_back(pen.x_mm, pen.y_mm);
    }
  }
  Random random(kSeed, 1);
  std::vector<DrawnMeasure> measures;
  const auto add = [&](DrawnMeasure m) {
    m.value_mm =
        observation::measure_row(m.kind, pens[m.from], pens[m.to], pens[m.middle]).value_mm +
        kRulerMm * random.normal();
    m.sigma_mm = kRulerMm;
    measures.push_back(m);
  };
  for (std::size_t from = 0; from < points.size(); ++from) {
    for (std::size_t to = from + 1; to < points.size(); ++to)
      add({DrawnMeasure::Kind::length, from, to, 0});
  }
  for (std::size_t k = 0; k < 3; ++k) {
    add({DrawnMeasure::Kind::bow, 3 * k, 3 * k + 2, 3 * k + 1});
    add({DrawnMeasure::Kind::bow, k, k + 6, k + 3});
  }
  return std::make_shared<const observation::DrawnMeasures>(points, measures, 15.0);
}

Analysis analysed(double knot_mm) {
  const auto toy = std::make_shared<const model::ToyMechanism>(-700.0, 700.0);
  const auto actual =
      knot_mm > 0.0 ? toy->with_effects({{"toy_knot", "", {{"knot_mm", knot_mm}}}}) : toy;
  auto analysis =
      analyse(estimation::observation_set({}, {drawn(*toy, *actual)}, toy), DiagnosisOptions{});
  if (!analysis) throw std::runtime_error(analysis.error().sentence());
  return *std::move(analysis);
}

/// A knot acts like a zero error of ten sigmas of 2 mm.
TEST(MechanismDiagnosis, NamesTheEffectOfAToyWithItsSize) {
  const Analysis a = analysed(20.0);
  EXPECT_EQ(a.decision.verdict, Verdict::named) << "seed " << kSeed;
  const std::vector<Cause> causes = causes_found(a);
  ASSERT_THAT(causes, SizeIs(1));
  EXPECT_EQ(causes.front().cause.effect->id, "toy_knot");
  // The zero, which does the same, is known to 2 mm: four sigmas.
  EXPECT_NEAR(causes.front().parameters.front().value, 20.0, 8.0) << "seed " << kSeed;
}

TEST(MechanismDiagnosis, NamesNothingOnASoundToy) {
  const Analysis a = analysed(0.0);
  EXPECT_EQ(a.decision.verdict, Verdict::nothing_found) << "seed " << kSeed;
  EXPECT_THAT(causes_found(a), IsEmpty());
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis::toy_tests
