// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/interp/oracle/scattered_fit.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/interp/truths.hpp"

namespace chaintrue::interp {
namespace {

using truths::even;
using truths::kBed;

constexpr std::uint64_t kScatteredSeed = 5;

// Smooth terms of 0.8 mm that are in no machine model.
double unmodelled_left(double x, double y) {
  return 0.8 * std::sin(x / 500 + 0.3) * std::cos(y / 400);
}
double unmodelled_right(double x, double y) {
  return 0.8 * std::cos(x / 450) * std::sin(y / 420 + 0.5);
}

template <class Truth>
std::vector<ScatteredPoint> measured(
    truths::Random& random, int rows, int columns, double noise, Truth truth) {
  std::vector<ScatteredPoint> points;
  for (const double y : even(kBed.y_min, kBed.y_max, rows)) {
    for (const double x : even(kBed.x_min, kBed.x_max, columns)) {
      const double px = std::clamp(x + random.uniform(-20, 20), kBed.x_min, kBed.x_max);
      const double py = std::clamp(y + random.uniform(-20, 20), kBed.y_min, kBed.y_max);
      points.push_back({px, py, truth(px, py) + noise * random.normal(), 1.0});
    }
  }
  return points;
}

ScatteredOptions over_the_bed() {
  ScatteredOptions options;
  options.rectangle = kBed;
  return options;
}

template <class Truth>
double root_mean_square_error(const Surface& surface, Truth truth) {
  double square = 0.0;
  int count = 0;
  for (const double x : even(kBed.x_min, kBed.x_max, 41)) {
    for (const double y : even(kBed.y_min, kBed.y_max, 21)) {
      const double off = surface.at(x, y).value - truth(x, y);
      square += off * off;
      ++count;
    }
  }
  return std::sqrt(square / count);
}

struct NoisyCase {
  int rows, columns;
  NoiseScale noise;
  double rms_at_most, coverage_at_least;
};

class NoisyPoints : public testing::TestWithParam<NoisyCase> {};

// The coverage of pointwise intervals is a mean over the bed and over many machines' draws: over
// one bed they are strongly correlated. 92 to 98 % over 40 draws and both terms is required.
TEST_P(NoisyPoints, AreSmoothedWellAndTheirIntervalsCoverTheTruth) {
  SCOPED_TRACE(kScatteredSeed);
  const NoisyCase& c = GetParam();
  truths::Random random(kScatteredSeed);
  double rms = 0.0;
  double covered = 0.0;
  double asked = 0.0;
  constexpr int kDraws = 40;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (const auto& truth : {unmodelled_left, unmodelled_right}) {
      auto points = measured(random, c.rows, c.columns, 0.3, truth);
      ScatteredOptions options = over_the_bed();
      for (ScatteredPoint& p : points) p.sigma = 0.3;
      options.noise = c.noise;
      const auto surface = fit_scattered(points, options);
      ASSERT_TRUE(surface) << surface.error().sentence;
      const double off = root_mean_square_error(*surface, truth);
      rms += off / (2 * kDraws);
      for (const double x : even(kBed.x_min, kBed.x_max, 21)) {
        for (const double y : even(kBed.y_min, kBed.y_max, 11)) {
          const bool inside =
              std::abs(surface->at(x, y).value - truth(x, y)) <= 1.96 * surface->sigma(x, y);
          covered += inside ? 1.0 : 0.0;
          asked += 1.0;
        }
      }
    }
  }
  const double coverage = 100.0 * covered / asked;
  fmt::print(
      "{}x{}: rms {:.4f} mm, 95 % intervals cover {:.1f} %\n", c.rows, c.columns, rms, coverage);
  EXPECT_LE(rms, c.rms_at_most);
  EXPECT_GE(coverage, c.coverage_at_least);
  EXPECT_LE(coverage, 98.0);
}

constexpr NoiseScale kStated = {NoiseKnowledge::exact, 0.0};
constexpr NoiseScale kFromTwelve = {NoiseKnowledge::from_repeats, 12.0};
constexpr NoiseScale kUnknown = {NoiseKnowledge::unknown, 0.0};

INSTANTIATE_TEST_SUITE_P(Grids,
                         NoisyPoints,
                         testing::Values(NoisyCase{4, 7, kStated, 0.19, 92.0},
                                         NoisyCase{5, 9, kStated, 0.15, 92.0},
                                         NoisyCase{7, 13, kStated, 0.117, 92.0},
                                         NoisyCase{4, 7, kFromTwelve, 0.19, 92.0},
                                         NoisyCase{5, 9, kFromTwelve, 0.15, 92.0},
                                         NoisyCase{7, 13, kFromTwelve, 0.117, 92.0},
                                         NoisyCase{4, 7, kUnknown, 0.20, 92.0},
                                         NoisyCase{5, 9, kUnknown, 0.155, 92.0},
                                         NoisyCase{7, 13, kUnknown, 0.117, 92.0}),
                         [](const testing::TestParamInfo<NoisyCase>& grid) {
                           return fmt::format("{}x{}_noise_{}",
                                              grid.param.rows,
                                              grid.param.columns,
                                              static_cast<int>(grid.param.noise.knowledge));
                         });

TEST(ScatteredFit, DoesNotSwingWhereBisplrepDoes) {
  // SciPy 1.10: bisplrep(x, y, z, s=0) then bisplev(100, 200) gives 2173.24 on this grid, 492 off,
  // with every residual below 0.3 and no error.
  std::vector<ScatteredPoint> points;
  for (const double x : even(0, 2400, 7)) {
    for (const double y : even(0, 1200, 5)) {
      points.push_back({x, y, truths::proposal(x, y)});
    }
  }
  const auto surface = fit_scattered(points);
  ASSERT_TRUE(surface) << surface.error().sentence;
  double worst = 0.0;
  double square = 0.0;
  int count = 0;
  for (const double x : even(0, 2400, 49)) {
    for (const double y : even(0, 1200, 25)) {
      const double off = surface->at(x, y).value - truths::proposal(x, y);
      worst = std::max(worst, std::abs(off));
      square += off * off;
      ++count;
    }
  }
  // A thin plate through these points (SciPy RBFInterpolator) is 10.69 off at (100, 200).
  EXPECT_NEAR(surface->at(100, 200).value, truths::proposal(100, 200), 10.69);
  // The fit's own error estimate is no smaller than the true error.
  EXPECT_GE(surface->left_out().rms, std::sqrt(square / count));
  EXPECT_GE(surface->left_out().largest, worst);
  EXPECT_TRUE(surface->flags().empty());
}

TEST(ScatteredFit, OnePointOffIsFoundAndHardlyCounts) {
  SCOPED_TRACE(kScatteredSeed);
  truths::Random random(kScatteredSeed + 1);
  auto points = measured(random, 5, 9, 0.3, unmodelled_left);
  const auto clean = fit_scattered(points, over_the_bed());
  points[17].z += 6.35;  // a chain link miscounted
  const auto surface = fit_scattered(points, over_the_bed());
  ASSERT_TRUE(surface) << surface.error().sentence;
  ASSERT_EQ(surface->flags().size(), 1U);
  EXPECT_EQ(surface->flags()[0].index, 17U);
  EXPECT_EQ(surface->flags()[0].doubt, PointDoubt::contradicted);
  EXPECT_LT(surface->flags()[0].weight, 0.2);
  EXPECT_NEAR(surface->left_out().error(17), 6.35, 1.5);
  EXPECT_LE(root_mean_square_error(*surface, unmodelled_left),
            1.5 * root_mean_square_error(*clean, unmodelled_left));
}

TEST(ScatteredFit, RepeatsThatDisagreeAreNamed) {
  truths::Random random(kScatteredSeed + 2);
  auto points = measured(random, 5, 9, 0.3, unmodelled_left);
  for (ScatteredPoint& p : points) p.sigma = 0.3;
  ScatteredPoint again = points[3];
  again.z += 3.0;
  points.push_back(again);
  ScatteredOptions options = over_the_bed();
  options.noise.knowledge = NoiseKnowledge::exact;
  const auto surface = fit_scattered(points, options);
  ASSERT_TRUE(surface) << surface.error().sentence;
  std::vector<std::size_t> named;
  for (const PointFlag& flag : surface->flags()) {
    if (flag.doubt == PointDoubt::repeats_disagree) named.push_back(flag.index);
  }
  EXPECT_EQ(named, (std::vector<std::size_t>{3, 45}));
}

TEST(ScatteredFit, LeftOutErrorsAreThoseOfARefit) {
  SCOPED_TRACE(kScatteredSeed);
  truths::Random random(kScatteredSeed + 3);
  const auto points = measured(random, 4, 7, 0.3, unmodelled_left);
  ScatteredOptions options = over_the_bed();
  options.robust = false;
  const auto surface = fit_scattered(points, options);
  ASSERT_TRUE(surface);
  const BsplineBasis& basis = surface->basis();
  for (const std::size_t out : {0U, 12U, 27U}) {
    PenalisedProblem rest(basis.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == out) continue;
      rest.add_rows(basis.row(points[i].x, points[i].y).transpose(),
                    Eigen::VectorXd::Constant(1, points[i].z));
    }
    rest.penalties.push_back({0, basis.thin_plate_penalty(), basis.thin_plate_rank()});
    const auto refit =
        fit_with_smoothing(rest, surface->fit().lambda, surface->fit().sigma2).value();
    const double direct =
        points[out].z - basis.evaluate(refit.coefficients, points[out].x, points[out].y).value;
    EXPECT_NEAR(
        surface->left_out().error(static_cast<Eigen::Index>(out)), direct, 1e-8);  // rounding
  }
}

TEST(ScatteredFit, RefusesGarbageByName) {
  const auto refusal = [](const std::vector<ScatteredPoint>& points,
                          ScatteredOptions options = {}) {
    const auto surface = fit_scattered(points, options);
    return surface ? std::pair{ScatteredFailure::Reason::not_converged, std::string("a surface")}
                   : std::pair{surface.error().reason, surface.error().sentence};
  };
  std::vector<ScatteredPoint> few = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 2}, {2, 3, 4}};
  EXPECT_EQ(refusal(few).first, ScatteredFailure::Reason::too_few_points);
  EXPECT_EQ(refusal(few).second, "5 points are too few for a surface: 6 are the least");

  std::vector<ScatteredPoint> line;
  for (int i = 0; i < 20; ++i) line.push_back({i * 50.0, i * 20.0, 0.1 * i * i});
  EXPECT_EQ(refusal(line).first, ScatteredFailure::Reason::on_a_line);
  EXPECT_EQ(refusal(line).second,
            "all points lie on one line: they say nothing about the surface beside it");

  // Noise of 1 stated as 1e-6: the surface must oscillate through every point.
  SCOPED_TRACE(kScatteredSeed);
  truths::Random random(kScatteredSeed + 4);
  std::vector<ScatteredPoint> wild;
  for (int i = 0; i < 40; ++i) {
    wild.push_back({random.uniform(0, 1), random.uniform(0, 1), random.normal(), 1e-6});
  }
  ScatteredOptions exact;
  exact.noise.knowledge = NoiseKnowledge::exact;
  exact.robust = false;
  const auto [reason, sentence] = refusal(wild, exact);
  EXPECT_EQ(reason, ScatteredFailure::Reason::untrustworthy) << sentence;
  EXPECT_NE(sentence.find("it swings between the points"), std::string::npos) << sentence;
}

TEST(ScatteredFit, BrokenPreconditionsThrowWithTheirValues) {
  std::vector<ScatteredPoint> points(8, ScatteredPoint{0, 0, 0});
  points[3].z = NAN;
  try {
    (void)fit_scattered(points);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "point 3 is (0, 0, nan) with sigma 1");
  }
  points[3].z = 0;
  points[5].x = 1e4;
  try {
    (void)fit_scattered(points, over_the_bed());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "point 5 at (10000, 0) lies outside the rectangle");
  }
}

TEST(ScatteredFit, TheSameInputGivesTheSameBytes) {
  truths::Random random(kScatteredSeed + 5);
  const auto points = measured(random, 5, 9, 0.3, unmodelled_left);
  const auto a = fit_scattered(points);
  const auto b = fit_scattered(points);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->fit().coefficients, b->fit().coefficients);
  EXPECT_EQ(a->fit().corrected_covariance, b->fit().corrected_covariance);
}

TEST(ScatteredFit, AnIntervalCountGivenAloneIsKept) {
  SCOPED_TRACE(kScatteredSeed);
  truths::Random random(kScatteredSeed);
  const auto points = measured(random, 5, 8, 0.1, unmodelled_left);
  ScatteredOptions both = over_the_bed();
  both.intervals_x = 11;
  both.intervals_y = 5;
  ScatteredOptions x_alone = over_the_bed();
  x_alone.intervals_x = 11;
  ScatteredOptions y_alone = over_the_bed();
  y_alone.intervals_y = 5;
  // Three more coefficients than intervals on each axis.
  EXPECT_EQ(fit_scattered(points, both)->basis().size(), 14 * 8);
  EXPECT_EQ(fit_scattered(points, x_alone)->basis().size() % 14, 0);
  EXPECT_EQ(fit_scattered(points, y_alone)->basis().size() % 8, 0);
  EXPECT_NE(fit_scattered(points, over_the_bed())->basis().size() % 14, 0)
      << "eight intervals where nothing is given";
}

}  // namespace
}  // namespace chaintrue::interp
