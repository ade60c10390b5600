// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in the header; q, the changed quantities of a hypothesis.
#include "grid/holes/map_check.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/chain_rows.hpp"
#include "grid/holes/check_readings.hpp"

namespace chaintrue::grid {
namespace {

using model::Side;

/// A hypothesis before it has met the residuals.
struct Proposal {
  CheckHypothesis hypothesis;
  double prior = 0.0;
  Eigen::VectorXd mean;   ///< of r
  Eigen::MatrixXd by_q;   ///< X
  Eigen::VectorXd sigma;  ///< of q
  /// Which q each chain's zero and elongation is; -1: none.
  model::PerSide<int> zero_column{-1, -1};
  model::PerSide<int> pitch_column{-1, -1};
  /// Beside K, for what has no pattern.
  Eigen::VectorXd more_variance;
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
    Proposal unknown = start("unknown", "", CheckVerdict::measure_again, p.unknown);
    for (Eigen::Index k = 0; k < 2 * places_; ++k) {
      add_column(unknown, readings_.by_chain.col(k), kUnknownSigmaMm);
    }
    add(std::move(unknown));
    for (std::size_t i = 0; i < readings_.groups.size(); ++i) {
      Proposal bad = start("bad_point",
                           "",
                           CheckVerdict::measure_again,
                           p.bad_point / static_cast<double>(readings_.groups.size()));
      bad.hypothesis.count = static_cast<int>(i);
      for (const Eigen::Index row : readings_.groups[i]) {
        bad.more_variance[row] = kOutlierSigmaMm * kOutlierSigmaMm;
      }
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
    const Eigen::Index count = readings_.residual_mm.size();
    Proposal proposal;
    proposal.hypothesis.what = what;
    proposal.hypothesis.side = side;
    proposal.hypothesis.verdict = verdict;
    proposal.prior = prior;
    proposal.mean = Eigen::VectorXd::Zero(count);
    proposal.by_q = Eigen::MatrixXd(count, 0);
    proposal.more_variance = Eigen::VectorXd::Zero(count);
    return proposal;
  }

  static int add_column(Proposal& proposal, const Eigen::VectorXd& column, double sigma) {
    const Eigen::Index at = proposal.by_q.cols();
    proposal.by_q.conservativeResize(Eigen::NoChange, at + 1);
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

/// K without any change, factored once: n^3. Every hypothesis adds a few directions U to it, or a
/// part that is diagonal, and costs n^2 or less:
///   (K + U U')^-1 = K^-1 - K^-1 U M^-1 U' K^-1,  |K + U U'| = |K| |M|,  M = I + U' K^-1 U     (W)
class Unchanged {
 public:
  explicit Unchanged(const CheckReadings& readings)
      : factor_(readings.covariance),
        inverse_(factor_.solve(
            Eigen::MatrixXd::Identity(readings.covariance.rows(), readings.covariance.cols()))),
        log_root_det_(Eigen::MatrixXd(factor_.matrixL()).diagonal().array().log().sum()) {}

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& y) const { return inverse_ * y; }
  [[nodiscard]] const Eigen::MatrixXd& inverse() const { return inverse_; }
  [[nodiscard]] double log_root_det() const { return log_root_det_; }

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd inverse_;
  double log_root_det_;
};

double log_root_det(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum();
}

/// The readings of some rows say nothing: s^2 is added to their variances.
double log_evidence_of_bad(const Unchanged& nothing,
                           const Eigen::VectorXd& y,
                           const Eigen::VectorXd& pulled,
                           const Eigen::VectorXd& more_variance) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < more_variance.size(); ++i) {
    if (more_variance[i] > 0.0) rows.push_back(i);
  }
  const Eigen::VectorXd s = more_variance(rows).cwiseSqrt();
  Eigen::MatrixXd m = s.asDiagonal() * nothing.inverse()(rows, rows) * s.asDiagonal();
  m.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(m);
  const Eigen::VectorXd seen = s.cwiseProduct(pulled(rows));
  return -nothing.log_root_det() - log_root_det(factor) -
         0.5 * (y.dot(pulled) - seen.dot(factor.solve(seen)));
}

/// Every place may have changed by itself: K and as much on it as all places together.
double log_evidence_of_unknown(const CheckReadings& readings,
                               const Eigen::MatrixXd& by_q,
                               double sigma,
                               const Eigen::VectorXd& y) {
  Eigen::MatrixXd k = readings.covariance;
  if (by_q.rows() == by_q.cols() && by_q.isIdentity(0.0)) {
    k.diagonal().array() += sigma * sigma;
  } else {
    k.selfadjointView<Eigen::Lower>().rankUpdate(by_q, sigma * sigma);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(k.selfadjointView<Eigen::Lower>());
  return -log_root_det(factor) - 0.5 * y.dot(factor.solve(y));
}

/// log of evidence times prior; the posterior of q goes into the hypothesis.
double weigh(Proposal& proposal, const CheckReadings& readings, const Unchanged& nothing) {
  const double prior = std::log(proposal.prior);
  const Eigen::VectorXd y = readings.residual_mm - proposal.mean;
  CheckHypothesis& hypothesis = proposal.hypothesis;
  if (hypothesis.what == "unknown") {
    return prior + log_evidence_of_unknown(readings, proposal.by_q, kUnknownSigmaMm, y);
  }
  const Eigen::VectorXd pulled = nothing.solve(y);
  if (hypothesis.what == "bad_point")
    return prior + log_evidence_of_bad(nothing, y, pulled, proposal.more_variance);
  if (proposal.by_q.cols() == 0) return prior - nothing.log_root_det() - 0.5 * y.dot(pulled);
  const Eigen::MatrixXd u = proposal.by_q * proposal.sigma.asDiagonal();
  Eigen::MatrixXd m = u.transpose() * (nothing.inverse() * u);
  m.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(m);
  const Eigen::VectorXd seen = u.transpose() * pulled;
  const Eigen::VectorXd taken = factor.solve(seen);
  double value = prior - nothing.log_root_det() - log_root_det(factor) -
                 0.5 * (y.dot(pulled) - seen.dot(taken));
  const Eigen::VectorXd q = proposal.sigma.cwiseProduct(taken);
  const Eigen::MatrixXd covariance = proposal.sigma.asDiagonal() *
                                     factor.solve(Eigen::MatrixXd::Identity(m.rows(), m.cols())) *
                                     proposal.sigma.asDiagonal();
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
  if (pitch >= 0) {
    value += std::log(
        std::max(1e-300, 2.0 * normal_cdf(q[pitch] / std::sqrt(covariance(pitch, pitch)))));
  }
  return value;
}

std::string side_words(const std::string& side) {
  return side == "both" ? std::string("both chains") : fmt::format("the {} chain", side);
}

std::string in_words(const CheckHypothesis& h, const CheckReadings& readings) {
  if (h.what == "nothing") return "nothing has changed";
  if (h.what == "zero" && h.side == "both") {
    return fmt::format("the zeros have shifted, the left by {:+.2f} mm and the right by {:+.2f} mm",
                       h.zero_mm.left,
                       h.zero_mm.right);
  }
  if (h.what == "zero") {
    const Side side = h.side == "left" ? Side::left : Side::right;
    return fmt::format(
        "the zero of {} has shifted by {:+.2f} mm", side_words(h.side), h.zero_mm[side]);
  }
  if (h.what == "tooth") {
    return fmt::format("{} skipped {} {}: it reads {:.2f} mm too {}",
                       side_words(h.side),
                       std::abs(h.count) == 1 ? "one" : "two",
                       std::abs(h.count) == 1 ? "tooth" : "teeth",
                       std::abs(h.count) * readings.pitch_mm,
                       h.count > 0 ? "much" : "little");
  }
  if (h.what == "pitch" || h.what == "zeros_and_pitch") {
    const double growth = h.side == "right" ? h.elongation.right : h.elongation.left;
    return fmt::format("the links of {} have grown by {:.3f} %{}",
                       side_words(h.side),
                       100.0 * growth,
                       h.what == "pitch" ? "" : ", and the zeros have shifted");
  }
  if (h.what == "motors") return "a motor has moved";
  if (h.what == "bad_point") {
    return fmt::format("{} is wrong by itself",
                       readings.group_names[static_cast<std::size_t>(h.count)]);
  }
  return "something has changed that follows no known pattern";
}

void tell(MapCheck& check, const CheckReadings& readings) {
  const CheckHypothesis& first = check.hypotheses.front();
  const auto at = static_cast<std::size_t>(check.verdict);
  const double percent = 100.0 * check.probability[at];
  const std::string why = in_words(first, readings);
  switch (check.verdict) {
    case CheckVerdict::valid:
      check.sentence = fmt::format("The map is still valid ({:.0f} %): {}.", percent, why);
      break;
    case CheckVerdict::valid_after_rezeroing:
      check.sentence = fmt::format(
          "The map is valid after re-zeroing ({:.0f} %): {}. New zeros: left {:.2f} mm, right "
          "{:.2f} "
          "mm.",
          percent,
          why,
          check.new_zero.left_mm,
          check.new_zero.right_mm);
      break;
    case CheckVerdict::measure_again:
      check.sentence =
          first.what == "bad_point"
              ? fmt::format(
                    "Measure {} again ({:.0f} %): it is wrong by itself, and "
                    "says nothing of the map.",
                    readings.group_names[static_cast<std::size_t>(first.count)],
                    percent)
              : fmt::format("The map is to be measured again ({:.0f} %): {}.", percent, why);
      break;
  }
  if (first.probability >= kDecided) return;
  constexpr double kWorthNaming = 0.05;
  std::vector<std::string> others;
  for (const CheckHypothesis& h : check.hypotheses) {
    if (h.probability < kWorthNaming) continue;
    others.push_back(fmt::format("{} ({:.0f} %)", in_words(h, readings), 100.0 * h.probability));
  }
  check.not_told_apart =
      fmt::format("These points cannot tell apart: {}.", fmt::join(others, "; "));
  if (!check.decided)
    check.not_told_apart += " Measure more points, far from each other, before you rely on either.";
}

MapCheck judge(const CheckReadings& readings) {
  std::vector<Proposal> proposals = Proposals(readings).all();
  std::vector<double> weights;
  const Unchanged nothing(readings);
  for (Proposal& proposal : proposals) weights.push_back(weigh(proposal, readings, nothing));
  const double most = *std::max_element(weights.begin(), weights.end());
  double sum = 0.0;
  for (double& weight : weights) sum += weight = std::exp(weight - most);
  MapCheck check;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    CheckHypothesis& hypothesis = proposals[i].hypothesis;
    hypothesis.probability = weights[i] / sum;
    check.probability[static_cast<std::size_t>(hypothesis.verdict)] += hypothesis.probability;
    check.hypotheses.push_back(std::move(hypothesis));
  }
  std::stable_sort(check.hypotheses.begin(),
                   check.hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  const auto best = std::max_element(check.probability.begin(), check.probability.end());
  check.verdict = static_cast<CheckVerdict>(best - check.probability.begin());
  check.decided = *best >= kDecided;
  // What is told first is what speaks most for the verdict.
  const auto first = std::find_if(check.hypotheses.begin(),
                                  check.hypotheses.end(),
                                  [&](const auto& h) { return h.verdict == check.verdict; });
  std::rotate(check.hypotheses.begin(), first, first + 1);
  const CheckHypothesis& told = check.hypotheses.front();
  check.new_zero = {readings.zero.left_mm + told.zero_mm.left,
                    readings.zero.right_mm + told.zero_mm.right};
  for (Eigen::Index k = 0; k < readings.residual_mm.size(); ++k) {
    check.residuals.push_back({readings.names[static_cast<std::size_t>(k)],
                               readings.residual_mm[k],
                               std::sqrt(readings.covariance(k, k))});
  }
  tell(check, readings);
  return check;
}

}  // namespace

std::string_view name(CheckVerdict verdict) {
  switch (verdict) {
    case CheckVerdict::valid:
      return "valid";
    case CheckVerdict::valid_after_rezeroing:
      return "valid_after_rezeroing";
    case CheckVerdict::measure_again:
      break;
  }
  return "measure_again";
}

tl::expected<MapCheck, CheckFailure> check_map(const CompensationMap& map,
                                               const Measured& measured) {
  return check_readings(map, measured).map(judge);
}

}  // namespace chaintrue::grid
