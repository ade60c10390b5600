// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/anchors_check.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "grid/belts/frame_solver.hpp"
#include "grid/map/check_decision.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {

using model::Belt;
using model::kBelts;

namespace {

/// The new places' checks.
struct Checks {
  Eigen::VectorXd residual_mm;  ///< 2 a place
  Eigen::MatrixXd by_anchor;    ///< times 5
  Eigen::MatrixXd by_belt;      ///< times 4: of what is added to each belt
};

/// Each place where its four readings fit the anchors best; empty where one has none.
std::optional<std::vector<model::FramePoint>> placed(const MeasuredBelts& belts,
                                                     const belts::AnchorAdjustment& solver,
                                                     belts::FrameState state) {
  // From a crossing of two belts; a place settles in three, or nowhere.
  constexpr int kRounds = 8;
  constexpr model::PerBelt<bool> kAll{true, true, true, true};
  const model::BeltMachine machine = belts::with_anchors(belts.machine, state.anchors);
  for (const BeltPoint& point : belts.points)
    state.places.push_back(belts::nearest_place(machine, point, kAll));
  for (int round = 0; round < kRounds; ++round) {
    const belts::FrameEquations at = solver.equations(state);
    if (!std::isfinite(at.cost)) return std::nullopt;
    for (std::size_t k = 0; k < belts.points.size(); ++k) {
      const auto own = solver.eliminated(at, k, 0.0);
      const Eigen::Vector2d move = own.inverse * own.gradient;
      state.places[k].x_mm += move.x();
      state.places[k].y_mm += move.y();
    }
  }
  return state.places;
}

Checks checks_at(const MeasuredBelts& belts,
                 const belts::AnchorAdjustment& solver,
                 const belts::FrameState& state) {
  const belts::FrameEquations at = solver.equations(state);
  const auto count = static_cast<Eigen::Index>(belts.points.size());
  Checks checks{Eigen::VectorXd(2 * count),
                Eigen::MatrixXd(2 * count, belts::kAnchorUnknowns),
                Eigen::MatrixXd(2 * count, 4)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(at.by_place.middleRows<4>(4 * k));
    const Eigen::MatrixXd whole = qr.householderQ() * Eigen::MatrixXd::Identity(4, 4);
    const Eigen::Matrix<double, 2, 4> q = whole.rightCols<2>().transpose();
    Eigen::Matrix<double, 4, belts::kAnchorUnknowns> by_anchor;
    for (const Belt belt : kBelts) {
      by_anchor.row(static_cast<Eigen::Index>(belt)) =
          solver.frame_row(at, static_cast<std::size_t>(k), belt).head<belts::kAnchorUnknowns>();
    }
    checks.residual_mm.segment<2>(2 * k) = q * at.residual.segment<4>(4 * k);
    checks.by_anchor.middleRows<2>(2 * k) = q * by_anchor;
    checks.by_belt.middleRows<2>(2 * k) = q;
  }
  return checks;
}

/// What may have been added to the checks: columns over some rows, each times a normal number of
/// sigma_mm; or, without columns, such a number on every check.
struct Addition {
  double sigma_mm = 0.0;
  Eigen::Index first_row = 0;
  Eigen::MatrixXd columns = {};
  bool on_each = false;
};

/// (1) in units of s. V = d I + Z Z' with the few columns Z of D C D' and B, so that
///
///   |V| = d^(n - k) |G|,   V^-1 r = (r - Z G^-1 Z' r) / d,   G = d I + Z' Z  (k x k)            (2)
///
/// (Woodbury; G. Golub and C. Van Loan, Matrix Computations (2013), 2.1.4): linear in the places.
class Weighing {
 public:
  Weighing(const BeltsFit& fit, const Checks& checks)
      : spread_(fit.spread_mm), dof_(fit.checks), residual_(checks.residual_mm / spread_) {
    // Positive but for rounding.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(fit.covariance_mm2);
    by_anchor_ = checks.by_anchor * parts.eigenvectors() *
                 (parts.eigenvalues().cwiseMax(0.0).cwiseSqrt() / spread_).asDiagonal();
    gram_ = by_anchor_.transpose() * by_anchor_;
    by_residual_ = by_anchor_.transpose() * residual_;
  }

  /// s^2 I + D C D'.
  [[nodiscard]] double variance(Eigen::Index row) const {
    return spread_ * spread_ * (1.0 + by_anchor_.row(row).squaredNorm());
  }

  /// (1), and the most probable size of what was added.
  double log_density(const Addition& added, double* size_mm) const {
    const double scale = added.sigma_mm / spread_;
    const double d = 1.0 + (added.on_each ? scale * scale : 0.0);
    const Eigen::Index anchors = gram_.rows();
    const Eigen::Index own = added.columns.cols();
    const Eigen::Index k = anchors + own;
    Eigen::MatrixXd gram(k, k);
    Eigen::VectorXd by_residual(k);
    gram.topLeftCorner(anchors, anchors) = gram_;
    by_residual.head(anchors) = by_residual_;
    if (own > 0) {
      const Eigen::Index rows = added.columns.rows();
      const Eigen::MatrixXd z = scale * added.columns;
      gram.bottomRightCorner(own, own) = z.transpose() * z;
      gram.bottomLeftCorner(own, anchors) =
          z.transpose() * by_anchor_.middleRows(added.first_row, rows);
      gram.topRightCorner(anchors, own) = gram.bottomLeftCorner(own, anchors).transpose();
      by_residual.tail(own) = z.transpose() * residual_.segment(added.first_row, rows);
    }
    const Eigen::LLT<Eigen::MatrixXd> g(gram + d * Eigen::MatrixXd::Identity(k, k));
    const Eigen::VectorXd solved = g.solve(by_residual);
    const double square = residual_.squaredNorm();
    if (size_mm != nullptr && added.on_each) {
      const double left = square - 2.0 * solved.dot(by_residual) + solved.dot(gram * solved);
      *size_mm = added.sigma_mm * scale * std::sqrt(std::max(left, 0.0)) / d;
    } else if (size_mm != nullptr) {
      const Eigen::VectorXd size = added.sigma_mm / d * (by_residual - gram * solved).tail(own);
      *size_mm = own == 1 ? size(0) : size.norm();
    }
    const auto n = static_cast<double>(residual_.size());
    const double log_det = (n - static_cast<double>(k)) * std::log(d) +
                           2.0 * g.matrixLLT().diagonal().array().log().sum();
    return -0.5 * log_det -
           0.5 * (n + dof_) * std::log1p((square - by_residual.dot(solved)) / d / dof_);
  }

 private:
  double spread_;
  double dof_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd by_anchor_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd by_residual_;
};

std::vector<AnchorsHypothesis> weighed(const Weighing& weighing, const Checks& checks) {
  std::vector<AnchorsHypothesis> all;
  std::vector<double> logs;
  const auto weigh = [&](AnchorsHypothesis h, double prior, const Addition& added) {
    logs.push_back(std::log(prior) + weighing.log_density(added, &h.size_mm));
    all.push_back(std::move(h));
  };
  const auto places = static_cast<std::size_t>(checks.residual_mm.size()) / 2;
  const CheckPriors& prior = kCheckPriors;
  weigh({.what = "nothing"}, prior.nothing, {});
  const auto rezero = CheckVerdict::valid_after_rezeroing;
  const auto again = CheckVerdict::measure_again;
  for (const Belt belt : kBelts) {
    weigh({.what = "zero", .belt = belt, .verdict = rezero},
          (prior.one_zero + prior.tooth) / kBelts.size(),
          {kBeltZeroShiftMm, 0, checks.by_belt.col(static_cast<Eigen::Index>(belt))});
  }
  weigh({.what = "zero", .verdict = rezero},
        prior.both_zeros,
        {kBeltZeroShiftMm, 0, checks.by_belt.rowwise().sum()});
  // What the frame fixes of an anchor cannot move: it shows as the others moving.
  const auto moved = [&](Belt belt, std::vector<Eigen::Index> columns) {
    weigh({.what = "anchor", .belt = belt, .verdict = again},
          (prior.motors + prior.pitch) / 3.0,
          {kAnchorShiftMm, 0, checks.by_anchor(Eigen::all, columns)});
  };
  moved(Belt::tl, {0, 1});
  moved(Belt::tr, {2, 3});
  moved(Belt::br, {4});
  for (std::size_t k = 0; k < places; ++k) {
    weigh({.what = "bad_point", .point = k, .verdict = again},
          prior.bad_point / static_cast<double>(places),
          {kOutlierSigmaMm, 2 * static_cast<Eigen::Index>(k), Eigen::Matrix2d::Identity()});
  }
  weigh({.what = "unknown", .verdict = again},
        prior.unknown,
        {.sigma_mm = kUnknownSigmaMm, .on_each = true});
  const double total = log_sum(logs);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].probability = std::exp(logs[i] - total);
  return all;
}

std::string in_words(const AnchorsHypothesis& h) {
  if (h.what == "nothing") return "nothing has changed";
  if (h.what == "zero" && !h.belt)
    return fmt::format("all four belts count {:+.1f} mm from where they did", h.size_mm);
  if (h.what == "zero") {
    return fmt::format(
        "the {} belt counts {:+.1f} mm from where it did", model::words(*h.belt), h.size_mm);
  }
  if (h.what == "anchor") {
    return fmt::format("the {} anchor has moved by some {:.1f} mm against the others",
                       model::words(*h.belt),
                       h.size_mm);
  }
  if (h.what == "bad_point") return fmt::format("point {} is wrong by itself", h.point + 1);
  return "something has changed that follows no known pattern";
}

void tell(AnchorsCheck& check) {
  const AnchorsHypothesis& first = check.hypotheses.front();
  const double percent = 100.0 * check.probability[static_cast<std::size_t>(check.verdict)];
  const std::string why = in_words(first);
  if (check.verdict == CheckVerdict::valid) {
    check.sentence = fmt::format("The anchors still hold ({:.0f} %): {}.", percent, why);
  } else if (check.verdict == CheckVerdict::valid_after_rezeroing) {
    check.sentence =
        fmt::format("The anchors hold once the belts are drawn in and let out anew ({:.0f} %): {}.",
                    percent,
                    why);
  } else if (first.what == "bad_point") {
    check.sentence = fmt::format(
        "Measure point {} again ({:.0f} %): it is wrong by itself, and says nothing of the "
        "anchors.",
        first.point + 1,
        percent);
  } else {
    check.sentence = fmt::format("Find the anchors again ({:.0f} %): {}.", percent, why);
  }
  decide_not_told_apart(check, in_words, "places");
}

}  // namespace

tl::expected<AnchorsCheck, AnchorsCheckFailure> check_anchors(const BeltsFit& fit,
                                                              const MeasuredBelts& belts) {
  using Reason = AnchorsCheckFailure::Reason;
  if (fit.checks < 1 || !(fit.spread_mm > 0.0)) {
    return tl::unexpected(AnchorsCheckFailure{
        Reason::no_noise,
        "these anchors were not fitted to belts, so that nothing says how well new readings should "
        "agree: fit belts, and check against those anchors"});
  }
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  const belts::Counting all(belts.points.size(), model::PerBelt<bool>{true, true, true, true});
  const belts::AnchorAdjustment solver(untaped, all, fit.spread_mm);
  belts::FrameState state{belts::anchors_of(fit.machine), 0.0, {}};
  const auto places = placed(untaped, solver, state);
  const auto nowhere = [] {
    return tl::unexpected(AnchorsCheckFailure{
        Reason::nowhere,
        "the new lengths end nowhere together about these anchors: are they of this frame, and do "
        "their \"lengths\" count what the file says?"});
  };
  if (!places) return nowhere();
  state.places = *places;
  const Checks checks = checks_at(untaped, solver, state);
  // More than a belt jumps in three turns of its encoder: no change of a frame, but another one.
  constexpr double kAnotherFrameMm = 130.0;
  const auto readings = static_cast<double>(checks.residual_mm.size());
  if (!(checks.residual_mm.norm() < kAnotherFrameMm * std::sqrt(readings))) return nowhere();
  AnchorsCheck check;
  const Weighing weighing(fit, checks);
  check.hypotheses = weighed(weighing, checks);
  decide_verdict(check);
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    const auto row = 2 * static_cast<Eigen::Index>(k);
    check.places.push_back(
        {std::sqrt(0.5 * checks.residual_mm.segment<2>(row).squaredNorm()),
         std::sqrt(0.5 * (weighing.variance(row) + weighing.variance(row + 1)))});
  }
  tell(check);
  return check;
}

}  // namespace chaintrue::grid
