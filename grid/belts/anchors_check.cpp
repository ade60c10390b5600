// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/anchors_check.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "grid/belts/frame_solver.hpp"
#include "grid/holes/check_decision.hpp"
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
                                                     const belts::FrameSolver& solver,
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
                 const belts::FrameSolver& solver,
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

class Weighing {
 public:
  Weighing(const BeltsFit& fit, const Checks& checks)
      : spread_(fit.spread_mm), dof_(fit.checks), checks_(checks) {
    const Eigen::Index n = checks.residual_mm.size();
    base_ = checks.by_anchor * fit.covariance_mm2 * checks.by_anchor.transpose();
    base_ += spread_ * spread_ * Eigen::MatrixXd::Identity(n, n);
  }

  [[nodiscard]] const Eigen::MatrixXd& base() const { return base_; }

  /// (1), with B = column sigma^2 column'; the most probable size of what it is.
  double log_density(const Eigen::MatrixXd& columns, double sigma_mm, double* size_mm) const {
    const Eigen::MatrixXd own = sigma_mm * columns;
    const Eigen::MatrixXd v = (base_ + own * own.transpose()) / (spread_ * spread_);
    const Eigen::LLT<Eigen::MatrixXd> llt(v);
    const Eigen::VectorXd r = checks_.residual_mm / spread_;
    const Eigen::VectorXd solved = llt.solve(r);
    if (size_mm != nullptr) {
      const Eigen::VectorXd size = sigma_mm / spread_ * own.transpose() * solved;
      *size_mm = size.size() == 1 ? size(0) : size.norm();
    }
    const double log_det = 2.0 * Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum();
    return -0.5 * log_det -
           0.5 * (static_cast<double>(r.size()) + dof_) * std::log1p(r.dot(solved) / dof_);
  }

 private:
  double spread_;
  double dof_;
  const Checks& checks_;
  Eigen::MatrixXd base_;
};

std::vector<AnchorsHypothesis> weighed(const BeltsFit& fit, const Checks& checks) {
  const Weighing weighing(fit, checks);
  std::vector<AnchorsHypothesis> all;
  std::vector<double> logs;
  const auto weigh =
      [&](AnchorsHypothesis h, double prior, const Eigen::MatrixXd& columns, double sigma_mm) {
        logs.push_back(std::log(prior) + weighing.log_density(columns, sigma_mm, &h.size_mm));
        all.push_back(std::move(h));
      };
  const Eigen::Index n = checks.residual_mm.size();
  const auto places = static_cast<std::size_t>(n) / 2;
  const CheckPriors& prior = kCheckPriors;
  weigh({.what = "nothing"}, prior.nothing, Eigen::MatrixXd(n, 0), 0.0);
  const auto rezero = CheckVerdict::valid_after_rezeroing;
  const auto again = CheckVerdict::measure_again;
  for (const Belt belt : kBelts) {
    weigh({.what = "zero", .belt = belt, .verdict = rezero},
          (prior.one_zero + prior.tooth) / kBelts.size(),
          checks.by_belt.col(static_cast<Eigen::Index>(belt)),
          kBeltZeroShiftMm);
  }
  weigh({.what = "zero", .verdict = rezero},
        prior.both_zeros,
        checks.by_belt.rowwise().sum(),
        kBeltZeroShiftMm);
  // What the frame fixes of an anchor cannot move: it shows as the others moving.
  const auto moved = [&](Belt belt, std::vector<Eigen::Index> columns) {
    weigh({.what = "anchor", .belt = belt, .verdict = again},
          (prior.motors + prior.pitch) / 3.0,
          checks.by_anchor(Eigen::all, columns),
          kAnchorShiftMm);
  };
  moved(Belt::tl, {0, 1});
  moved(Belt::tr, {2, 3});
  moved(Belt::br, {4});
  for (std::size_t k = 0; k < places; ++k) {
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(n, 2);
    own.middleRows<2>(2 * static_cast<Eigen::Index>(k)).setIdentity();
    weigh({.what = "bad_point", .point = k, .verdict = again},
          prior.bad_point / static_cast<double>(places),
          own,
          kOutlierSigmaMm);
  }
  weigh({.what = "unknown", .verdict = again},
        prior.unknown,
        Eigen::MatrixXd::Identity(n, n),
        kUnknownSigmaMm);
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
  if (h.what == "bad_point") return fmt::format("point {} is wrong by itself", h.point);
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
        first.point,
        percent);
  } else {
    check.sentence = fmt::format("Find the anchors again ({:.0f} %): {}.", percent, why);
  }
  if (first.probability >= kDecided) return;
  constexpr double kWorthNaming = 0.05;
  std::vector<std::string> others;
  for (const AnchorsHypothesis& h : check.hypotheses) {
    if (h.probability >= kWorthNaming)
      others.push_back(fmt::format("{} ({:.0f} %)", in_words(h), 100.0 * h.probability));
  }
  check.not_told_apart =
      fmt::format("These places cannot tell apart: {}.", fmt::join(others, "; "));
  if (!check.decided)
    check.not_told_apart += " Measure more places, far from each other, before you rely on either.";
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
  const belts::FrameSolver solver(untaped, all, fit.spread_mm);
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
  check.hypotheses = weighed(fit, checks);
  decide_verdict(check);
  const Eigen::VectorXd variance = Weighing(fit, checks).base().diagonal();
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    const auto row = 2 * static_cast<Eigen::Index>(k);
    check.places.push_back({std::sqrt(0.5 * checks.residual_mm.segment<2>(row).squaredNorm()),
                            std::sqrt(0.5 * variance.segment<2>(row).sum())});
  }
  tell(check);
  return check;
}

}  // namespace chaintrue::grid
