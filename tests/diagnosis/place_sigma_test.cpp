// SPDX-License-Identifier: GPL-3.0-or-later
// The sigma of where a cause acts, against the profile likelihood.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include <limits>

#include "grid/diagnosis/analysis.hpp"
#include "grid/synthetic/generator.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing_support::verdict_alone;

struct PlacedCause {
  const char* effect;
  const char* place;
  model::AppliedEffect hidden;
};

MeasuredGrid session_with(const PlacedCause& own, std::uint64_t seed) {
  synthetic::SyntheticSpec spec = testing_support::usual_session(seed, {own.hidden});
  spec.design.columns = 9;
  spec.design.rows = 5;
  spec.draw_settings = true;
  return synthetic::generate(model::Machine{}, spec).value().grid;
}

/// min over size and settings of |e - A s - b g(p)|^2 + |(s - s_0) / sigma_s|^2 at a place p of the cause, where g
/// moves with the settings: d(b g)/ds by differences, the size as found.
class Profile {
 public:
  Profile(const Analysis& a, CauseId cause, double size) : a_(a), cause_(cause), size_(size) {
    constexpr double kStep = 0.1;  // of a setting's sigma: a column changes by a thousandth
    for (Eigen::Index j = 0; j < a.system.setting.size(); ++j) {
      Eigen::VectorXd values = a.system.setting;
      steps_.push_back(kStep * a.system.sigma[j]);
      values[j] += steps_.back();
      moved_.push_back(moved_to(a.session, a.state, values).value());
      systems_.push_back(linearise(a.session, moved_.back()).value());
    }
  }
  double square_at(double place) const {
    const std::vector<double> values = {size_, place};
    const Eigen::VectorXd g = signature(a_.session, a_.state, a_.system, {cause_, values}).value();
    const Eigen::Index n = g.size();
    const Eigen::Index q = a_.system.setting.size();
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n + q, q + 1);
    Eigen::VectorXd right(n + q);
    for (Eigen::Index j = 0; j < q; ++j) {
      const auto k = static_cast<std::size_t>(j);
      const Eigen::VectorXd there =
          signature(a_.session, moved_[k], systems_[k], {cause_, values}).value();
      rows.col(j).head(n) = a_.system.by_setting.col(j) + (there - g) / steps_[k];
      rows(n + j, j) = 1.0 / a_.system.sigma[j];
      right[n + j] = a_.system.expected_change[j] / a_.system.sigma[j];
    }
    rows.col(q).head(n) = g;
    right.head(n) = a_.system.e;
    const Eigen::VectorXd solution = rows.householderQr().solve(right);
    return (right - rows * solution).squaredNorm();
  }

 private:
  const Analysis& a_;
  CauseId cause_;
  double size_;
  std::vector<double> steps_;
  std::vector<State> moved_;
  std::vector<RegressorSystem> systems_;
};

/// How far to either side the square grows by `rise`, in mean.
double half_width(const Profile& profile, double place, double sigma, double rise) {
  constexpr double kReach = 4.0;
  constexpr int kSteps = 81;
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> at, square;
  for (int k = 0; k < kSteps; ++k) {
    at.push_back(place + sigma * kReach * (2.0 * k / (kSteps - 1) - 1.0));
    square.push_back(profile.square_at(at.back()));
    least = std::min(least, square.back());
  }
  double inside = 0.0;
  for (const double own : square) inside += own < least + rise ? 1.0 : 0.0;
  return 0.5 * inside * (at[1] - at[0]);
}

void expect_width_of_profile(const PlacedCause& own) {
  DiagnosisOptions options = verdict_alone();
  options.stability = false;
  constexpr std::uint64_t kSeed = 3;
  SCOPED_TRACE(testing::Message() << own.effect << ", seed " << kSeed);
  const MeasuredGrid grid = session_with(own, kSeed);
  const auto found = diagnose(grid, options);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->causes.size(), 1U) << found->sentence;
  const Cause& cause = found->causes.front();
  ASSERT_EQ(cause.cause.effect->id, own.effect) << found->sentence;
  const Analysis analysed = testing_support::analysis_of(grid, options);
  const ParameterEstimate& size = cause.parameters.front();
  const ParameterEstimate& place = cause.parameters.back();
  ASSERT_EQ(place.parameter, own.place);
  const Profile profile(analysed, cause.cause, size.value);
  const double width =
      half_width(profile, place.value, place.sigma, analysed.estimate.noise_square);
  // The sigma is that of the curvature at the best place: a wave's cosine and a knee's next readings bend it.
  EXPECT_NEAR(width / place.sigma, 1.0, 0.2);
}

TEST(PlaceSigma, EqualsTheWidthOfTheProfileLikelihood) {
  expect_width_of_profile(
      {"sprocket_eccentricity",
       "phase_rad",
       {"sprocket_eccentricity", "left", {{"amplitude_mm", 2.0}, {"phase_rad", 1.3}}}});
  expect_width_of_profile(
      {"angular_kink",
       "knee_rad",
       {"angular_kink", "right", {{"slope_mm_per_rad", 12.0}, {"knee_rad", 0.7}}}});
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
