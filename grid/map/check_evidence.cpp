// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in map_check.hpp; q, the changed quantities of a hypothesis.
#include "grid/map/check_evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "grid/chain_rows.hpp"

namespace chaintrue::grid {
namespace {

using model::Side;

/// A hypothesis before it has met the residuals.
struct Proposal {
  CheckHypothesis hypothesis;
  double prior = 0.0;
  Eigen::VectorXd mean;   ///< of r; empty: nothing
  Eigen::MatrixXd by_q;   ///< X
  Eigen::VectorXd sigma;  ///< of q
  /// Which q each chain's zero and elongation is; -1: none.
  model::PerSide<int> zero_column{-1, -1};
  model::PerSide<int> pitch_column{-1, -1};
};

/// Every hypothesis that the readings allow for.
class Proposals {
 public:
  explicit Proposals(const CheckReadings& readings)
      : readings_(readings), places_(readings.by_chain.cols() / 2) {}

  [[nodiscard]] std::vector<Proposal> all() {
    const CheckPriors& p = kCheckPriors;
    Proposal nothing = start("nothing", "", CheckVerdict::valid, p.nothing);
    add(std::move(nothing));
    for (const char* side : {"left", "right", "both"}) {
      const double zero = std::string_view(side) == "both" ? p.both_zeros : 0.5 * p.one_zero;
      add(with_zeros(start("zero", side, CheckVerdict::valid_after_rezeroing, zero)));
      add(with_pitch(start("pitch", side, CheckVerdict::measure_again, p.pitch / 3.0), side));
      Proposal both =
          start("zeros_and_pitch", side, CheckVerdict::measure_again, p.zeros_and_pitch / 3.0);
      both.hypothesis.side = "both";
      both = with_zeros(std::move(both));
      both.hypothesis.side = side;
      add(with_pitch(std::move(both), side));
    }
    for (const int teeth : {-2, -1, 1, 2}) {
      // A second tooth is four times as rare as the first.
      const double share = p.tooth * (std::abs(teeth) == 1 ? 0.2 : 0.05);
      for (const char* side : {"left", "right"}) add(tooth(side, teeth, share));
    }
    if (readings_.by_motor.cols() > 0) {
      Proposal motors = start("motors", "", CheckVerdict::measure_again, p.motors);
      for (Eigen::Index k = 0; k < readings_.by_motor.cols(); ++k) {
        add_column(motors, readings_.by_chain * readings_.by_motor.col(k), kMotorShiftSigmaMm);
      }
      add(std::move(motors));
    }
    add(start("unknown", "", CheckVerdict::measure_again, p.unknown));
    for (std::size_t i = 0; i < readings_.unit_names.size(); ++i) {
      Proposal bad = start("bad_point",
                           "",
                           CheckVerdict::measure_again,
                           p.bad_point / static_cast<double>(readings_.unit_names.size()));
      bad.hypothesis.count = static_cast<int>(i);
      add(std::move(bad));
    }
    return std::move(all_);
  }

 private:
  void add(Proposal proposal) { all_.push_back(std::move(proposal)); }

  [[nodiscard]] Proposal start(const char* what,
                               const char* side,
                               CheckVerdict verdict,
                               double prior) const {
    Proposal proposal;
    proposal.hypothesis.what = what;
    proposal.hypothesis.side = side;
    proposal.hypothesis.verdict = verdict;
    proposal.prior = prior;
    return proposal;
  }

  static int add_column(Proposal& proposal, const Eigen::VectorXd& column, double sigma) {
    const Eigen::Index at = proposal.by_q.cols();
    proposal.by_q.conservativeResize(column.size(), at + 1);
    proposal.by_q.col(at) = column;
    proposal.sigma.conservativeResize(at + 1);
    proposal.sigma[at] = sigma;
    return static_cast<int>(at);
  }

  /// What one more mm read on a chain, everywhere, does.
  [[nodiscard]] Eigen::VectorXd zero_column(Side side) const {
    Eigen::VectorXd chain = Eigen::VectorXd::Zero(2 * places_);
    for (Eigen::Index i = 0; i < places_; ++i) chain[2 * i + row_of(side)] = 1.0;
    return readings_.by_chain * chain;
  }

  [[nodiscard]] Proposal with_zeros(Proposal proposal) const {
    const std::string& side = proposal.hypothesis.side;
    if (side != "right")
      proposal.zero_column.left = add_column(proposal, zero_column(Side::left), kZeroShiftSigmaMm);
    if (side != "left")
      proposal.zero_column.right =
          add_column(proposal, zero_column(Side::right), kZeroShiftSigmaMm);
    return proposal;
  }

  /// Links that grew by e are counted 1 / (1 + e) times as often. Both chains wear alike.
  [[nodiscard]] Proposal with_pitch(Proposal proposal, std::string_view side) const {
    Eigen::VectorXd chain = Eigen::VectorXd::Zero(2 * places_);
    if (side != "right") chain -= readings_.lengths_mm.col(0);
    if (side != "left") chain -= readings_.lengths_mm.col(1);
    const int column = add_column(proposal, readings_.by_chain * chain, kPitchGrowthSigma);
    if (side != "right") proposal.pitch_column.left = column;
    if (side != "left") proposal.pitch_column.right = column;
    return proposal;
  }

  [[nodiscard]] Proposal tooth(const char* side, int teeth, double prior) const {
    Proposal proposal = start("tooth", side, CheckVerdict::valid_after_rezeroing, prior);
    const Side chain = std::string_view(side) == "left" ? Side::left : Side::right;
    proposal.mean = teeth * readings_.pitch_mm * zero_column(chain);
    proposal.hypothesis.count = teeth;
    proposal.hypothesis.zero_mm[chain] = teeth * readings_.pitch_mm;
    return proposal;
  }

  const CheckReadings& readings_;
  Eigen::Index places_;
  std::vector<Proposal> all_;
};

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// K with what every place may have changed by itself: kUnknownSigmaMm of its chains. A place that
/// one unit alone sees adds to that unit's noise; the others' readings share it.
ReadingCovariance with_unknown(const CheckReadings& readings) {
  ReadingCovariance k = readings.covariance;
  std::vector<std::size_t> unit_of;
  std::vector<Eigen::Index> first_row;
  Eigen::Index row = 0;
  for (std::size_t u = 0; u < k.own.size(); ++u) {
    first_row.push_back(row);
    row += k.own[u].rows();
    unit_of.resize(static_cast<std::size_t>(row), u);
  }
  std::vector<Eigen::Triplet<double>> shared;
  Eigen::Index columns = 0;
  for (Eigen::Index chain = 0; chain < readings.by_chain.cols(); ++chain) {
    std::vector<std::pair<Eigen::Index, double>> seen;
    for (Eigen::SparseMatrix<double>::InnerIterator at(readings.by_chain, chain); at; ++at)
      seen.emplace_back(at.row(), kUnknownSigmaMm * at.value());
    if (seen.empty()) continue;
    const std::size_t unit = unit_of[static_cast<std::size_t>(seen.front().first)];
    if (unit == unit_of[static_cast<std::size_t>(seen.back().first)]) {
      for (const auto& [i, by_i] : seen) {
        for (const auto& [j, by_j] : seen)
          k.own[unit](i - first_row[unit], j - first_row[unit]) += by_i * by_j;
      }
      continue;
    }
    for (const auto& [i, by_i] : seen) shared.emplace_back(i, columns, by_i);
    ++columns;
  }
  if (columns == 0) return k;
  for (Eigen::Index column = 0; column < k.shared.cols(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator at(k.shared, column); at; ++at)
      shared.emplace_back(at.row(), columns + column, at.value());
  }
  k.shared.resize(k.rows(), columns + k.shared.cols());
  k.shared.setFromTriplets(shared.begin(), shared.end());
  return k;
}

/// log of evidence times prior of each proposal, K being factored once. A hypothesis adds a few
/// directions U, or makes one unit say nothing:
///   x' (K + U U')^-1 x = x' K^-1 x - x' K^-1 U M^-1 U' K^-1 x,  |K + U U'| = |K| |M|,
///   M = I + U' K^-1 U     (W)
class Evidence {
 public:
  explicit Evidence(const CheckReadings& readings)
      : readings_(readings),
        nothing_(readings.covariance),
        residual_(nothing_.seen(readings.residual_mm)),
        pulled_(nothing_.pulled(residual_)),
        precision_(nothing_.precision_of_units()) {
    Eigen::Index row = 0;
    for (const Eigen::MatrixXd& unit : precision_) {
      first_row_.push_back(row);
      row += unit.rows();
    }
  }

  /// The posterior of q goes into the hypothesis.
  [[nodiscard]] double weigh(Proposal& proposal) const {
    const double prior = std::log(proposal.prior);
    if (proposal.hypothesis.what == "unknown") return prior + of_unknown();
    if (proposal.hypothesis.what == "bad_point")
      return prior + of_bad_unit(static_cast<std::size_t>(proposal.hypothesis.count));
    return prior + of_change(proposal);
  }

 private:
  static double log_root_det(const Eigen::LLT<Eigen::MatrixXd>& factor) {
    return factor.matrixLLT().diagonal().array().log().sum();
  }

  /// Every place may have changed by itself.
  [[nodiscard]] double of_unknown() const {
    const FactoredCovariance all(with_unknown(readings_));
    return -all.log_root_det() - 0.5 * all.seen(readings_.residual_mm).squaredNorm();
  }

  /// The readings of a unit say nothing: kOutlierSigmaMm is added to their noise.
  [[nodiscard]] double of_bad_unit(std::size_t unit) const {
    const Eigen::MatrixXd& precision = precision_[unit];
    Eigen::MatrixXd m = kOutlierSigmaMm * kOutlierSigmaMm * precision;
    m.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> factor(m);
    const Eigen::VectorXd seen =
        kOutlierSigmaMm * pulled_.segment(first_row_[unit], precision.rows());
    return -nothing_.log_root_det() - log_root_det(factor) -
           0.5 * (residual_.squaredNorm() - seen.dot(factor.solve(seen)));
  }

  [[nodiscard]] double of_change(Proposal& proposal) const {
    const Eigen::VectorXd y = proposal.mean.size() == 0
                                  ? residual_
                                  : Eigen::VectorXd(residual_ - nothing_.seen(proposal.mean));
    if (proposal.by_q.cols() == 0) return -nothing_.log_root_det() - 0.5 * y.squaredNorm();
    const Eigen::MatrixXd u = nothing_.seen(proposal.by_q * proposal.sigma.asDiagonal());
    Eigen::MatrixXd m = u.transpose() * u;
    m.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> factor(m);
    const Eigen::VectorXd seen = u.transpose() * y;
    const Eigen::VectorXd taken = factor.solve(seen);
    const double value =
        -nothing_.log_root_det() - log_root_det(factor) - 0.5 * (y.squaredNorm() - seen.dot(taken));
    const Eigen::VectorXd q = proposal.sigma.cwiseProduct(taken);
    const Eigen::MatrixXd covariance = proposal.sigma.asDiagonal() *
                                       factor.solve(Eigen::MatrixXd::Identity(m.rows(), m.cols())) *
                                       proposal.sigma.asDiagonal();
    return value + tell_posterior(proposal, q, covariance);
  }

  /// Fills the hypothesis; what a pitch that only grows adds to the evidence.
  static double tell_posterior(Proposal& proposal,
                               const Eigen::VectorXd& q,
                               const Eigen::MatrixXd& covariance) {
    CheckHypothesis& hypothesis = proposal.hypothesis;
    int pitch = -1;
    for (const Side side : model::kSides) {
      if (const int column = proposal.zero_column[side]; column >= 0) {
        hypothesis.zero_mm[side] = q[column];
        hypothesis.zero_sigma_mm[side] = std::sqrt(covariance(column, column));
      }
      if (const int column = proposal.pitch_column[side]; column >= 0) {
        hypothesis.elongation[side] = q[column];
        hypothesis.elongation_sigma[side] = std::sqrt(covariance(column, column));
        pitch = column;
      }
    }
    if (pitch < 0) return 0.0;
    return std::log(
        std::max(1e-300, 2.0 * normal_cdf(q[pitch] / std::sqrt(covariance(pitch, pitch)))));
  }

  const CheckReadings& readings_;
  FactoredCovariance nothing_;
  Eigen::VectorXd residual_;  ///< Y of reading_covariance.hpp (2)
  Eigen::VectorXd pulled_;    ///< K^-1 r
  std::vector<Eigen::MatrixXd> precision_;
  std::vector<Eigen::Index> first_row_;
};

}  // namespace

std::vector<CheckHypothesis> weighed_hypotheses(const CheckReadings& readings) {
  std::vector<Proposal> proposals = Proposals(readings).all();
  std::vector<double> weights;
  const Evidence evidence(readings);
  for (Proposal& proposal : proposals) weights.push_back(evidence.weigh(proposal));
  const double most = *std::max_element(weights.begin(), weights.end());
  double sum = 0.0;
  for (double& weight : weights) sum += weight = std::exp(weight - most);
  std::vector<CheckHypothesis> hypotheses;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    proposals[i].hypothesis.probability = weights[i] / sum;
    hypotheses.push_back(std::move(proposals[i].hypothesis));
  }
  return hypotheses;
}

}  // namespace chaintrue::grid
