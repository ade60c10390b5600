// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation: theta, deviations of the settings from what was stated; b, all unknowns (theta first);
/// d, distance of a point's left-out residual in sigmas.
#include "grid/map/joint_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/map/fit_unknowns.hpp"
#include "grid/map/measured_area.hpp"
#include "grid/map/seen_splines.hpp"
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
/// Passes with soft weights only, so that several bad points cannot hide each other.
constexpr int kSoftPasses = 4;

/// One point, linearised and whitened: rows of the design and the response, and the way back to
/// millimetres.
struct WhitePoint {
  Eigen::MatrixXd design;                                   // 2 x SeenColumns::total()
  Eigen::Vector2d response;                                 // whitened, for all unknowns
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();  // W with W C W' = I
};

/// A reading of the machine itself, whitened.
struct WhiteReading {
  Eigen::RowVectorXd row;  // by the settings
  double response = 0.0;
};

JointFitFailure unreachable(const LengthPoint& point, model::PoseFailure failure) {
  return {JointFitFailure::Reason::point_unreachable,
          fmt::format("point {} at ({:.1f}, {:.1f}): {}",
                      point.index + 1,
                      point.mark.x_mm,
                      point.mark.y_mm,
                      model::explain(failure))};
}

/// Intervals a little wider than the square that each point has to itself: three more coefficients
/// than intervals on each axis still let noise-free points be met; the penalty makes what is too
/// many of them harmless, and beyond some 200 a surface more would only cost time. The smoother
/// surface is for points that are met closely, and closer ones show.
interp::BsplineBasis basis_for(const interp::Rectangle& domain,
                               const std::vector<model::BedPoint>& marks,
                               int bending_order) {
  const double widening = bending_order == 2 ? 1.2 : 0.8;
  const double spacing_mm = widening * 2.0 * MeasuredArea(marks, domain).edge_mm();
  const auto intervals = [spacing_mm](double length_mm, int most) {
    return std::clamp(static_cast<int>(std::ceil(length_mm / spacing_mm)), 3, most);
  };
  return {domain, intervals(domain.width(), 12), intervals(domain.height(), 8)};
}

std::vector<model::BedPoint> marks_of(const std::vector<LengthPoint>& points) {
  std::vector<model::BedPoint> marks;
  for (const LengthPoint& point : points) marks.push_back(point.mark);
  return marks;
}

/// The unknowns while fitting, in this order: settings, both chains' scales, polynomials, and bends
/// as the points see them (seen_splines.hpp).
struct SeenColumns {
  Eigen::Index settings = 0;
  Eigen::Index polynomials = 0;  ///< of one surface
  Eigen::Index bends = 0;        ///< of one surface
  [[nodiscard]] Eigen::Index scale(model::Side side) const { return settings + second(side); }
  [[nodiscard]] Eigen::Index polynomial(model::Side side) const {
    return settings + 2 + second(side) * polynomials;
  }
  [[nodiscard]] Eigen::Index bend(model::Side side) const {
    return settings + 2 + 2 * polynomials + second(side) * bends;
  }
  [[nodiscard]] Eigen::Index total() const { return settings + 2 + 2 * (polynomials + bends); }

 private:
  static Eigen::Index second(model::Side side) { return side == model::Side::left ? 0 : 1; }
};

class JointFitter {
 public:
  explicit JointFitter(const JointFitInput& input)
      : input_(input),
        unknowns_(input.machine, input.sheet),
        basis_(basis_for(input.domain, marks_of(input.points), input.bending_order)),
        seen_(basis_, input.bending_order, marks_of(input.points)),
        columns_{unknowns_.size(), seen_.polynomials(), seen_.bends()},
        theta_(Eigen::VectorXd::Zero(unknowns_.size())),
        weights_(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(input.points.size()))),
        distances_(Eigen::VectorXd::Zero(weights_.size())) {}

  tl::expected<JointFit, JointFitFailure> run();

 private:
  tl::expected<void, JointFitFailure> linearise();
  /// Choosing the smoothing costs some twenty times a solution.
  enum class Smoothing { choose, keep };
  tl::expected<void, JointFitFailure> solve(Smoothing smoothing, bool correct_covariance);
  void measure_distances();
  [[nodiscard]] bool update_weights(int pass);
  [[nodiscard]] interp::PenalisedProblem problem() const;
  [[nodiscard]] Eigen::MatrixXd design_of(Eigen::Index point,
                                          model::ChainLengths lengths,
                                          const Eigen::MatrixXd& settings_jacobian) const;
  void add_points(interp::PenalisedProblem& problem) const;
  void add_settings_prior(interp::PenalisedProblem& problem) const;
  void add_surface_prior(interp::PenalisedProblem& problem) const;
  [[nodiscard]] tl::expected<JointFit, JointFitFailure> result(bool settled) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> left_out(const std::vector<std::size_t>& group) const;
  [[nodiscard]] Eigen::VectorXd spline_coefficients(model::Side side) const;
  [[nodiscard]] Eigen::MatrixXd covariance_of(const FitColumns& columns) const;

  const JointFitInput& input_;
  FitUnknowns unknowns_;
  interp::BsplineBasis basis_;
  SeenSplines seen_;
  SeenColumns columns_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd distances_;
  std::vector<WhitePoint> white_;
  std::vector<WhiteReading> extra_;
  interp::PenalisedFit fit_;
};

/// The two rows of the design at a point: d(corrected lengths)/d(unknowns).
Eigen::MatrixXd JointFitter::design_of(Eigen::Index point,
                                       model::ChainLengths lengths,
                                       const Eigen::MatrixXd& settings_jacobian) const {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, columns_.total());
  rows.leftCols(columns_.settings) = settings_jacobian;
  for (const model::Side side : model::kSides) {
    const Eigen::Index row = side == model::Side::left ? 0 : 1;
    rows(row, columns_.scale(side)) =
        side == model::Side::left ? lengths.left_mm : lengths.right_mm;
    rows.row(row).segment(columns_.polynomial(side), columns_.polynomials) =
        seen_.polynomial_rows().row(point);
    rows.row(row).segment(columns_.bend(side), columns_.bends) = seen_.bend_rows().row(point);
  }
  return rows;
}

tl::expected<void, JointFitFailure> JointFitter::linearise() {
  const model::ReadingModel model(unknowns_.machine_at(theta_));
  const model::SheetPlacement sheet = unknowns_.sheet_at(theta_);
  white_.clear();
  for (const LengthPoint& point : input_.points) {
    const model::ChainReading reading(point.mark, point.lengths, input_.noise);
    const auto line = reading.linearise(model, sheet, unknowns_.settings());
    if (!line) return tl::unexpected(unreachable(point, line.error()));
    WhitePoint white;
    const Eigen::Matrix2d lower = Eigen::Matrix2d(line->covariance).llt().matrixL();
    white.whitening = lower.inverse();
    const model::ChainLengths predicted{point.lengths.left_mm - line->residual[0],
                                        point.lengths.right_mm - line->residual[1]};
    white.design =
        white.whitening *
        design_of(static_cast<Eigen::Index>(white_.size()), predicted, line->setting_jacobian);
    white.response = white.whitening * (line->residual + line->setting_jacobian * theta_);
    white_.push_back(std::move(white));
  }
  extra_.clear();
  for (const auto& observation : input_.extra) {
    const auto line = observation->linearise(model, sheet, unknowns_.settings());
    if (!line) continue;  // readings of the machine itself have no pose that could fail
    const double scale = 1.0 / std::sqrt(line->covariance(0, 0));
    extra_.push_back({scale * line->setting_jacobian.row(0),
                      scale * (line->residual + line->setting_jacobian * theta_)[0]});
  }
  return {};
}

void JointFitter::add_points(interp::PenalisedProblem& problem) const {
  const auto points = static_cast<Eigen::Index>(white_.size());
  Eigen::MatrixXd design(2 * points, columns_.total());
  Eigen::VectorXd response(2 * points);
  Eigen::Index rows = 0;
  for (Eigen::Index i = 0; i < points; ++i) {
    if (weights_[i] == 0.0) continue;
    const double root = std::sqrt(weights_[i]);
    const WhitePoint& white = white_[static_cast<std::size_t>(i)];
    design.middleRows(rows, 2) = root * white.design;
    response.segment(rows, 2) = root * white.response;
    rows += 2;
  }
  problem.add_rows(design.topRows(rows), response.head(rows));
}

/// What was stated, and readings of the machine itself: data of known sigma, which the points'
/// noise factor does not scale.
void JointFitter::add_settings_prior(interp::PenalisedProblem& problem) const {
  const Eigen::Index settings = columns_.settings;
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(settings, settings);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(settings);
  for (Eigen::Index i = 0; i < settings; ++i) {
    precision(i, i) = 1.0 / (unknowns_.sigma(i) * unknowns_.sigma(i));
  }
  for (const WhiteReading& reading : extra_) {
    precision += reading.row.transpose() * reading.row;
    pull += reading.row.transpose() * reading.response;
  }
  problem.prior_precision.topLeftCorner(settings, settings) = precision;
  problem.prior_mean.head(settings) = precision.ldlt().solve(pull);
}

void JointFitter::add_surface_prior(interp::PenalisedProblem& problem) const {
  problem.prior_precision.diagonal()
      .segment(columns_.settings, 2)
      .setConstant(1.0 / (kScaleSigma * kScaleSigma));
  problem.prior_precision.diagonal()
      .segment(columns_.polynomial(model::Side::left), 2 * columns_.polynomials)
      .setConstant(1.0 / (kFreePartSigmaMm * kFreePartSigmaMm));
  // One smoothness for both chains: what bends one surface bends the other.
  interp::Penalty penalty;
  penalty.first_column = columns_.bend(model::Side::left);
  penalty.matrix = Eigen::MatrixXd::Identity(2 * columns_.bends, 2 * columns_.bends);
  penalty.rank = 2 * columns_.bends;
  // Where the splines' own penalty would weigh as much as the data.
  for (std::size_t i = 0; i < white_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    penalty.balance += weights_[at] * seen_.squares()[at] * white_[i].whitening.squaredNorm() /
                       (2.0 * seen_.penalty_trace());
  }
  problem.penalties = {std::move(penalty)};
}

interp::PenalisedProblem JointFitter::problem() const {
  interp::PenalisedProblem problem(columns_.total());
  problem.keeps_rows = true;
  problem.prior_precision = Eigen::MatrixXd::Zero(columns_.total(), columns_.total());
  problem.prior_mean = Eigen::VectorXd::Zero(columns_.total());
  problem.noise = input_.noise_scale;
  add_points(problem);
  add_settings_prior(problem);
  add_surface_prior(problem);
  return problem;
}

tl::expected<void, JointFitFailure> JointFitter::solve(Smoothing smoothing,
                                                       bool correct_covariance) {
  interp::FitOptions options;
  options.correct_covariance = correct_covariance;
  auto fit = smoothing == Smoothing::choose
                 ? interp::fit_penalised(problem(), options)
                 : interp::fit_with_smoothing(problem(), fit_.lambda, fit_.sigma2);
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
  Eigen::MatrixXd design(2 * static_cast<Eigen::Index>(used.size()), columns_.total());
  Eigen::VectorXd response(design.rows());
  for (std::size_t k = 0; k < used.size(); ++k) {
    const double root = std::sqrt(weights_[static_cast<Eigen::Index>(used[k])]);
    design.middleRows(2 * static_cast<Eigen::Index>(k), 2) = root * white_[used[k]].design;
    response.segment(2 * static_cast<Eigen::Index>(k), 2) = root * white_[used[k]].response;
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
      residuals.emplace_back(white_[i].response - white_[i].design * fit_.coefficients);
    }
  }
  return residuals;
}

void JointFitter::measure_distances() {
  for (Eigen::Index i = 0; i < distances_.size(); ++i) {
    const WhitePoint& white = white_[static_cast<std::size_t>(i)];
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
    const bool bad = pass >= kSoftPasses && distances_[i] > kBadPointDistance;
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
    if (auto done = linearise(); !done) return tl::unexpected(done.error());
    if (auto done = solve(smoothing, perhaps_last); !done) return tl::unexpected(done.error());
    const Eigen::VectorXd next = fit_.coefficients.head(columns_.settings);
    double step = 0.0;
    for (Eigen::Index i = 0; i < next.size(); ++i) {
      if (unknowns_.sigma(i) <= kKnownSigma) continue;
      step = std::max(step, std::abs(next[i] - theta_[i]) / unknowns_.sigma(i));
    }
    theta_ = next;
    const Eigen::VectorXd solved_with = weights_;
    settled = !update_weights(pass) && step < kSettledSigmas && pass > kSoftPasses;
    if (perhaps_last && (settled || pass + 1 == kMaximumPasses)) {
      // What is told of the points belongs to the weights that the fit was solved with.
      weights_ = solved_with;
      break;
    }
    // Otherwise chosen anew only when the bad points are first set aside.
    smoothing = pass == kSoftPasses ? Smoothing::choose : Smoothing::keep;
  }
  return result(settled);
}

Eigen::VectorXd JointFitter::spline_coefficients(model::Side side) const {
  return seen_.polynomial_coefficients() *
             fit_.coefficients.segment(columns_.polynomial(side), columns_.polynomials) +
         seen_.bend_coefficients() * fit_.coefficients.segment(columns_.bend(side), columns_.bends);
}

/// Of the splines' own coefficients: what the points see, and what keeps its prior.
Eigen::MatrixXd JointFitter::covariance_of(const FitColumns& columns) const {
  Eigen::MatrixXd to_splines = Eigen::MatrixXd::Zero(columns.total(), columns_.total());
  const Eigen::Index plain = columns_.settings + 2;
  to_splines.topLeftCorner(plain, plain).setIdentity();
  for (const model::Side side : model::kSides) {
    to_splines.block(
        columns.spline(side), columns_.polynomial(side), columns.basis, columns_.polynomials) =
        seen_.polynomial_coefficients();
    to_splines.block(columns.spline(side), columns_.bend(side), columns.basis, columns_.bends) =
        seen_.bend_coefficients();
  }
  Eigen::MatrixXd covariance = to_splines * fit_.corrected_covariance * to_splines.transpose();
  const Eigen::MatrixXd unseen = fit_.inverse_lambda[0] * seen_.unseen_coefficients() *
                                 seen_.unseen_coefficients().transpose();
  for (const model::Side side : model::kSides) {
    covariance.block(columns.spline(side), columns.spline(side), columns.basis, columns.basis) +=
        unseen;
  }
  return covariance;
}

tl::expected<JointFit, JointFitFailure> JointFitter::result(bool settled) const {
  const model::ReadingModel model(unknowns_.machine_at(theta_));
  const model::SheetPlacement sheet = unknowns_.sheet_at(theta_);
  std::vector<model::PointReading> readings;
  for (const LengthPoint& point : input_.points) {
    const auto reading = model.at(sheet.to_bed(point.mark));
    if (!reading) return tl::unexpected(unreachable(point, reading.error()));
    readings.push_back(*reading);
  }
  const ResidualSurface surface{
      basis_,
      {fit_.coefficients[columns_.scale(model::Side::left)],
       fit_.coefficients[columns_.scale(model::Side::right)]},
      {spline_coefficients(model::Side::left), spline_coefficients(model::Side::right)}};
  const FitColumns columns{unknowns_.size(), basis_.size()};
  JointFit fit{unknowns_.machine_at(theta_),
               sheet,
               unknowns_.settings(),
               columns,
               surface,
               covariance_of(columns),
               std::sqrt(fit_.sigma2),
               fit_.edf,
               {},
               {},
               settled};
  for (std::size_t i = 0; i < white_.size(); ++i) {
    const WhitePoint& white = white_[i];
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
  fit.blocked_residual_mm.resize(white_.size());
  for (const auto& block : spatial_blocks(input_.points)) {
    const auto residuals = left_out(block);
    for (std::size_t k = 0; k < block.size(); ++k) {
      fit.blocked_residual_mm[block[k]] = white_[block[k]].whitening.inverse() * residuals[k];
    }
  }
  return fit;
}

}  // namespace

tl::expected<JointFit, JointFitFailure> fit_jointly(const JointFitInput& input) {
  return JointFitter(input).run();
}

}  // namespace chaintrue::grid
