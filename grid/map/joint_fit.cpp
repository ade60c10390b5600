// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation: theta, deviations of the settings from what was stated; b, all unknowns (theta first);
/// d, distance of a point's left-out residual in sigmas.
#include "grid/map/joint_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/map/joint_problem.hpp"
#include "grid/map/spatial_blocks.hpp"

namespace chaintrue::grid {
namespace {

constexpr int kMaximumPasses = 25;
/// A step of this many stated sigmas changes no length by more than some 1e-3 mm.
constexpr double kSettledSigmas = 3e-3;
/// A weight that changes by this much moves nothing by more than a few hundredths of its sigma.
constexpr double kSettledWeight = 1e-2;
/// 95 % of good points are nearer (chi with two degrees of freedom): those keep their full weight.
constexpr double kHuberDistance = 2.4477;
/// Passes with soft weights only, so that several outliers cannot mask each other.
constexpr int kSoftPasses = 4;

class JointFitter {
 public:
  explicit JointFitter(const JointFitInput& input)
      : input_(input),
        problem_(input),
        theta_(Eigen::VectorXd::Zero(problem_.unknowns().size())),
        weights_(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(input.points.size()))),
        distances_(Eigen::VectorXd::Zero(weights_.size())) {}

  tl::expected<JointFit, JointFitFailure> run();

 private:
  /// Choosing the smoothing costs some twenty times a solution.
  enum class Smoothing { choose, keep };
  tl::expected<void, JointFitFailure> solve(Smoothing smoothing, bool correct_covariance);
  void measure_distances();
  [[nodiscard]] bool update_weights(int pass);
  [[nodiscard]] tl::expected<JointFit, JointFitFailure> result(bool settled) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> left_out(const std::vector<std::size_t>& group) const;

  const JointFitInput& input_;
  JointProblem problem_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd distances_;
  interp::PenalisedFit fit_;
};

tl::expected<void, JointFitFailure> JointFitter::solve(Smoothing smoothing,
                                                       bool correct_covariance) {
  interp::FitOptions options;
  options.correct_covariance = correct_covariance;
  auto fit =
      smoothing == Smoothing::choose
          ? interp::fit_penalised(problem_.weighted(weights_), options)
          : interp::fit_with_smoothing(problem_.weighted(weights_), fit_.lambda, fit_.sigma2);
  if (!fit) {
    const bool rank = fit.error().reason == interp::FitFailure::kRankDeficient;
    return tl::unexpected(JointFitFailure{
        rank ? JointFitFailure::Reason::rank_deficient : JointFitFailure::Reason::not_converged,
        fit.error().sentence});
  }
  fit_ = std::move(*fit);
  return {};
}

/// Whitened residuals of a group of points, seen from a fit without them. Points set aside are not
/// in the fit.
std::vector<Eigen::Vector2d> JointFitter::left_out(const std::vector<std::size_t>& group) const {
  std::vector<std::size_t> used;
  for (std::size_t i : group) {
    if (weights_[static_cast<Eigen::Index>(i)] > 0.0) used.push_back(i);
  }
  Eigen::MatrixXd design(2 * static_cast<Eigen::Index>(used.size()), problem_.columns().total());
  Eigen::VectorXd response(design.rows());
  for (std::size_t k = 0; k < used.size(); ++k) {
    const double root = std::sqrt(weights_[static_cast<Eigen::Index>(used[k])]);
    design.middleRows(2 * static_cast<Eigen::Index>(k), 2) =
        root * problem_.white()[used[k]].design;
    response.segment(2 * static_cast<Eigen::Index>(k), 2) =
        root * problem_.white()[used[k]].response;
  }
  const auto held = used.empty()
                        ? tl::expected<interp::HeldOut, interp::FitRefusal>(interp::HeldOut{})
                        : fit_.held_out(design, response);
  std::vector<Eigen::Vector2d> residuals;
  std::size_t k = 0;
  for (std::size_t i : group) {
    if (held && k < used.size() && used[k] == i) {
      const double root = std::sqrt(weights_[static_cast<Eigen::Index>(i)]);
      residuals.emplace_back(held->residual.segment(2 * static_cast<Eigen::Index>(k), 2) / root);
      ++k;
    } else {
      residuals.emplace_back(problem_.white()[i].response -
                             problem_.white()[i].design * fit_.coefficients);
    }
  }
  return residuals;
}

void JointFitter::measure_distances() {
  for (Eigen::Index i = 0; i < distances_.size(); ++i) {
    const WhitePoint& white = problem_.white()[static_cast<std::size_t>(i)];
    const Eigen::Vector2d residual = left_out({static_cast<std::size_t>(i)}).front();
    // Variance of a left-out residual: the noise plus what the fit without the point does not know.
    Eigen::Matrix2d spread = white.design * fit_.covariance * white.design.transpose();
    const Eigen::Matrix2d noise = fit_.sigma2 * Eigen::Matrix2d::Identity();
    if (weights_[i] > 0.0) {
      const Eigen::Matrix2d kept = noise - weights_[i] * spread;
      const Eigen::LLT<Eigen::Matrix2d> factor(kept);
      spread =
          factor.info() == Eigen::Success ? Eigen::Matrix2d(noise * factor.solve(spread)) : spread;
    }
    distances_[i] = std::sqrt(residual.dot((noise + spread).ldlt().solve(residual)));
  }
}

/// True where the weights changed enough to fit again.
bool JointFitter::update_weights(int pass) {
  measure_distances();
  double change = 0.0;
  for (Eigen::Index i = 0; i < weights_.size(); ++i) {
    const bool bad = pass >= kSoftPasses && distances_[i] > kOutlierDistance;
    const double weight =
        bad ? 0.0 : std::min(1.0, kHuberDistance / std::max(distances_[i], 1e-12));
    change = std::max(change, std::abs(weight - weights_[i]));
    weights_[i] = weight;
  }
  return change > kSettledWeight;
}

tl::expected<JointFit, JointFitFailure> JointFitter::run() {
  bool settled = false;
  Smoothing smoothing = Smoothing::choose;
  for (int pass = 0; pass < kMaximumPasses; ++pass) {
    // Once all but the smoothing has settled, the pass that chooses it may be the last.
    const bool perhaps_last = settled || pass + 1 == kMaximumPasses;
    if (perhaps_last) smoothing = Smoothing::choose;
    if (auto done = problem_.linearise(theta_); !done) return tl::unexpected(done.error());
    if (auto done = solve(smoothing, perhaps_last); !done) return tl::unexpected(done.error());
    const Eigen::VectorXd next = fit_.coefficients.head(problem_.columns().settings);
    double step = 0.0;
    for (Eigen::Index i = 0; i < next.size(); ++i) {
      if (problem_.unknowns().sigma(i) <= kKnownSigma) continue;
      step = std::max(step, std::abs(next[i] - theta_[i]) / problem_.unknowns().sigma(i));
    }
    theta_ = next;
    const Eigen::VectorXd solved_with = weights_;
    settled = !update_weights(pass) && step < kSettledSigmas && pass > kSoftPasses;
    if (perhaps_last && (settled || pass + 1 == kMaximumPasses)) {
      // What is told of the points belongs to the weights that the fit was solved with.
      weights_ = solved_with;
      break;
    }
    // Otherwise chosen anew only when the outliers are first set aside.
    smoothing = pass == kSoftPasses ? Smoothing::choose : Smoothing::keep;
  }
  return result(settled);
}

tl::expected<JointFit, JointFitFailure> JointFitter::result(bool settled) const {
  const model::ReadingModel model(problem_.unknowns().machine_at(theta_));
  const model::SheetPlacement sheet = problem_.unknowns().sheet_at(theta_);
  std::vector<model::PointReading> readings;
  for (const LengthPoint& point : input_.points) {
    const auto reading = model.at(sheet.to_bed(point.mark));
    if (!reading) return tl::unexpected(unreachable(point, reading.error()));
    readings.push_back(*reading);
  }
  const ResidualSurface surface{problem_.basis(),
                                {fit_.coefficients[problem_.columns().scale(model::Side::left)],
                                 fit_.coefficients[problem_.columns().scale(model::Side::right)]},
                                {problem_.spline_coefficients(fit_, model::Side::left),
                                 problem_.spline_coefficients(fit_, model::Side::right)}};
  const FitColumns columns{problem_.unknowns().size(), problem_.basis().size()};
  JointFit fit{problem_.unknowns().machine_at(theta_),
               sheet,
               problem_.unknowns().settings(),
               columns,
               surface,
               problem_.covariance(fit_, columns),
               std::sqrt(fit_.sigma2),
               fit_.edf,
               {},
               {},
               settled};
  for (std::size_t i = 0; i < problem_.white().size(); ++i) {
    const WhitePoint& white = problem_.white()[i];
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::Matrix2d back = white.whitening.inverse();
    FittedPoint point;
    point.point = input_.points[i];
    point.bad = weights_[at] == 0.0;
    point.distance = distances_[at];
    point.residual_mm = back * (white.response - white.design * fit_.coefficients);
    point.left_out_residual_mm = back * left_out({i}).front();
    const model::PointReading& reading = readings[i];
    point.mark_jacobian =
        fit.surface
            .apply(
                point.point.mark, reading.lengths, reading.position_jacobian * fit.sheet.rotation())
            .mark_jacobian;
    fit.points.push_back(point);
  }
  fit.blocked_residual_mm.resize(problem_.white().size());
  for (const auto& block : spatial_blocks(input_.points)) {
    const auto residuals = left_out(block);
    for (std::size_t k = 0; k < block.size(); ++k) {
      fit.blocked_residual_mm[block[k]] =
          problem_.white()[block[k]].whitening.inverse() * residuals[k];
    }
  }
  return fit;
}

}  // namespace

tl::expected<JointFit, JointFitFailure> fit_jointly(const JointFitInput& input) {
  return JointFitter(input).run();
}

}  // namespace chaintrue::grid
