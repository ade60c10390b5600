// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/anchors_with_causes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "grid/belts/fit_diagnostics.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using AnchorSquare = decltype(AveragedAnchors::covariance_mm2);

/// Models below this share of the best weight change no sigma by 1 %.
constexpr double kLeastWeight = 1e-3;
/// Log evidence of a usual size below which the readings refute it and the fitted size is kept.
/// Chance does this in fewer than one of 100,000 sessions.
constexpr double kPlainlyUnusual = -12.0;
/// An unexpected cause is reported with the anchors if it is more likely than not.
constexpr double kMoreLikelyThanNot = 0.5;
/// Prior that belts or anchors yield under the pull: they do in every published frame.
constexpr double kGives = 0.9;
/// Each further cause of a set has a fifth of its weight, as kPriorOfTwo to kPriorOfOne.
constexpr double kWeightGivenOthers = 0.2;

/// Odds of a cause at its usual size against none, for sigmas: large enough that 95 % intervals
/// cover at least 92 %. Causes that the readings show plainly need none. A belt's zero is nearly
/// collinear with the anchors and would need 3 or more; but then five published runs of one frame,
/// whose belts were retracted each time, would scatter by a sixth of the stated variance. With
/// these odds it is half.
struct CauseWeight {
  std::string_view effect;
  double odds;
};
constexpr CauseWeight kWeights[] = {{"belt_zero", 0.06}, {"drift", 0.045}};
constexpr double kOtherWeight = 0.013;

double odds_of(const CauseId& cause) {
  const auto* found = find_where(kWeights, having(&CauseWeight::effect, cause.effect->id));
  return found == nullptr ? kOtherWeight : found->odds;
}

bool is_in(const std::vector<SizedCause>& known, const CauseId& cause) {
  return any_of(known, having(&SizedCause::cause, cause));
}

/// Prior variances of a coefficient in units of the noise: usual, and wide as in an estimate.
struct SizePrior {
  double usual = 0.0;
  double wide = 0.0;
  /// Log ratio of the evidence with the usual prior to that with the comparison's mixture, for a
  /// coefficient that the readings alone put at `at` with this variance.
  double log_evidence(double at, double variance) const {
    const auto log_density = [&](double prior) {
      return -0.5 * (at * at / (variance + prior) + std::log(variance + prior));
    };
    const double more = log_density(wide) - log_density(usual);
    return -std::log(1.0 - kWideSignalToNoisePrior + kWideSignalToNoisePrior * std::exp(more));
  }
};

SizePrior prior_of(const Regressor& regressor, double noise_square) {
  const double widening = kWideSignalToNoise / kUsualSignalToNoise;
  const double usual = regressor.coefficient_sigma * regressor.coefficient_sigma * noise_square;
  return {usual, usual * widening * widening};
}

/// Restricts sizes to their usual spread, except for known causes. \returns the logarithm of the
/// factor on the model's evidence.
double hold_to_usual_sizes(const std::vector<SizedCause>& known, const RegressorSystem& system,
                           Estimate& found) {
  const Index settings = found.setting_change.size();
  VectorXd change = VectorXd::Zero(found.covariance.rows());
  double log_evidence = 0.0;
  for (const auto i : each_index(found.free)) {
    const std::size_t k = found.free[i];
    const Regressor& regressor = system.regressor(found.regressors[k]);
    if (!(regressor.coefficient_sigma > 0.0) || is_in(known, regressor.cause)) continue;
    const SizePrior prior = prior_of(regressor, found.noise_square);
    const Index at = settings + as_index(i);
    const double variance = found.covariance(at, at);
    const double coefficient = found.coefficient(as_index(k)) + change(at);
    // If the variance is unchanged the readings carry no information.
    constexpr double kNothing = 1e-9;
    const double from_readings =
        variance * prior.wide / std::max(prior.wide - variance, kNothing * prior.wide);
    const double own = prior.log_evidence(coefficient * from_readings / variance, from_readings);
    log_evidence += std::max(own, kPlainlyUnusual);
    if (own < kPlainlyUnusual) continue;
    const VectorXd column = found.covariance.col(at);
    const double narrower = prior.usual * prior.wide / (prior.wide - prior.usual);
    const VectorXd gain = column / (variance + narrower);
    change -= gain * coefficient;
    found.covariance -= gain * column.transpose();
  }
  found.setting_change += change.head(settings);
  for (const auto i : each_index(found.free)) {
    const auto k = as_index(found.free[i]);
    const Index at = settings + as_index(i);
    found.coefficient(k) += change(at);
    found.coefficient_sigma(k) = std::sqrt(std::max(found.covariance(at, at), 0.0));
  }
  return log_evidence;
}

/// Sums over models of weight, of weight by size, and of weight by size^2 + sigma^2.
struct SizeMoments {
  bool expected = false;
  double weight = 0.0;
  double first = 0.0;
  double second = 0.0;
  SizedCause weightiest;
  double most = 0.0;

  void add(double own, const SizedCause& cause, double sigma) {
    const double size = cause.values.front();
    weight += own;
    first += own * size;
    second += own * (size * size + sigma * sigma);
    if (own <= most) return;
    most = own;
    weightiest = cause;
  }
  AveragedCause averaged() const {
    AveragedCause result{weightiest, 0.0, 0.0};
    const double mean = first / weight;
    result.values.front() = mean;
    result.sigma = std::sqrt(std::max(second / weight - mean * mean, 0.0));
    return result;
  }
};

class Averaging {
 public:
  Averaging(const AnchorVector& about, const Analysis& a)
      : about_(about), a_(a), system_(a.system) {
    for (const Regressor& own : system_.regressors)
      share_of_effect_[own.cause.effect] += std::exp(own.log_prior);
  }

  AveragedAnchors averaged() {
    (void)a_.comparison.best();  // throws if there is none
    std::vector<double> log_weights;
    const std::vector<CandidateModel>& models = a_.comparison.models;
    for (const CandidateModel& model : models)
      log_weights.push_back(model.log_weight + log_prior_change(model));
    const double most = *max_element(log_weights);
    for (const auto m : each_index(log_weights)) {
      const double weight = std::exp(log_weights[m] - most);
      if (weight > kLeastWeight) add(models[m], weight);
    }
    const std::vector<CauseId> reported = reported_causes();
    const AnchorVector mean = change_with(reported);
    AveragedAnchors result;
    for (const Part& part : parts_) {
      const AnchorVector off = part.change - mean;
      result.covariance_mm2 += part.weight / total_ * (part.covariance + off * off.transpose());
    }
    result.anchors = about_ + mean;
    for (const CauseId& key : reported) {
      const SizeMoments& moments = sizes_.at(key);
      result.causes.push_back(moments.averaged());
      result.causes.back().probability = moments.weight / total_;
    }
    return result;
  }

 private:
  /// Anchors of one model, relative to the state.
  struct Part {
    double weight = 0.0;
    std::vector<CauseId> causes;  ///< sorted
    AnchorVector change;
    AnchorSquare covariance;
  };

  /// The likeliest expected cause, and all others more likely than not.
  std::vector<CauseId> reported_causes() const {
    double most = 0.0;
    for (const auto& [key, moments] : sizes_) {
      if (moments.expected) most = std::max(most, moments.weight);
    }
    std::vector<CauseId> reported;
    for (const auto& [key, moments] : sizes_) {
      const bool likeliest = moments.expected && moments.weight >= most;
      if (likeliest || moments.weight / total_ > kMoreLikelyThanNot) reported.push_back(key);
    }
    return reported;
  }

  /// Mean over the models with exactly these causes, or over all models if none has: anchors belong
  /// to the causes reported with them.
  AnchorVector change_with(const std::vector<CauseId>& causes) const {
    AnchorVector sum = AnchorVector::Zero();
    double weight = 0.0;
    for (const Part& part : parts_) {
      if (part.causes != causes) continue;
      sum += part.weight * part.change;
      weight += part.weight;
    }
    if (weight > 0.0) return sum / weight;
    for (const Part& part : parts_) sum += part.weight / total_ * part.change;
    return sum;
  }

  /// Replaces the comparison's prior of causes by kWeights.
  double log_prior_change(const CandidateModel& model) const {
    const bool smooth = model.discrepancy >= 0;
    double change = log_prior(system_, {}, smooth) - log_prior(system_, model.regressors, smooth);
    bool gives = false;
    bool given_others = false;
    for (const int index : model.regressors) {
      const Regressor& own = system_.regressor(index);
      if (own.expected) {
        change += std::log(own.cause.effect->expected);
        if (gives) change += std::log(kWeightGivenOthers);
        gives = true;
        continue;
      }
      change += own.log_prior - std::log(share_of_effect_.at(own.cause.effect)) +
                std::log(odds_of(own.cause));
      if (given_others) change += std::log(kWeightGivenOthers);
      given_others = true;
    }
    return change + std::log(gives ? kGives : 1.0 - kGives);
  }

  void add(const CandidateModel& model, double weight) {
    const MarginalisedSystem& marginalised = a_.comparison.marginalised_systems[model.marginalised];
    const auto [noise, is_new] = noise_.try_emplace({model.marginalised, model.discrepancy});
    if (is_new) noise->second = discrepancy_noise(system_, marginalised, model.discrepancy);
    Estimate found = estimate(system_, marginalised, model.regressors, noise->second);
    weight *= std::exp(hold_to_usual_sizes(a_.known, system_, found));
    total_ += weight;
    auto causes =
        mapped(model.regressors, [&](int index) { return system_.regressor(index).cause; });
    sort_unique(causes);
    parts_.push_back(
        {weight, std::move(causes), found.setting_change.head<kAnchorUnknowns>(),
         AnchorSquare(found.covariance.topLeftCorner<kAnchorUnknowns, kAnchorUnknowns>())});
    for (const auto k : each_index(model.regressors)) {
      const auto row = as_index(k);
      const Regressor& own = system_.regressor(model.regressors[k]);
      SizedCause cause = own;
      cause.values.front() = size_at(own, found.coefficient(row));
      const double slope = std::abs(size_slope(own, found.coefficient(row)));
      SizeMoments& moments = sizes_[own.cause];
      moments.expected = own.expected;
      moments.add(weight, cause, own.fixed ? 0.0 : slope * found.coefficient_sigma(row));
    }
  }

  const AnchorVector& about_;
  const Analysis& a_;
  const RegressorSystem& system_;
  std::map<const Effect*, double> share_of_effect_;
  double total_ = 0.0;
  std::vector<Part> parts_;
  std::map<std::pair<std::size_t, int>, DiscrepancyNoise> noise_;
  std::map<CauseId, SizeMoments> sizes_;
};

}  // namespace

AveragedAnchors averaged_anchors(const AnchorVector& about, const Analysis& analysis) {
  return Averaging(about, analysis).averaged();
}

namespace {

/// Places, and the spread about them.
void place_and_judge(const MeasuredBelts& without_causes, std::size_t sizes, AnchorFit& frame) {
  const MeasuredBelts untaped = without_distances(without_causes);
  place_all(untaped, frame);
  frame.checks = std::max<Index>(belts::checks_of(frame.counting) - as_index(sizes), 1);
  const belts::ReadingLines lines = reading_lines(untaped, frame.state);
  double square = 0.0;
  for (const auto k : each_index(frame.counting)) {
    for (const Belt belt : kBelts) {
      if (frame.counting[k][belt]) square += std::pow(lines.residual_mm[belts::row_of(k, belt)], 2);
    }
  }
  frame.residual_sigma_mm =
      std::max(std::sqrt(square / as_double(frame.checks)), belts::kLeastSpreadMm);
}

/// (1) of anchors_with_causes.hpp. \returns the covariance of anchors and scale; empty if the
/// distances do not converge.
std::optional<MatrixXd> take_distances(const MeasuredBelts& without_causes,
                                       const AveragedAnchors& averaged, AnchorFit& frame) {
  const MeasuredBelts untaped = without_distances(without_causes);
  const auto alone = fit_anchors_from(untaped, frame.state, frame.counting);
  const auto taped = fit_anchors_from(without_causes, frame.state, frame.counting);
  if (!alone || !taped || !taped->is_sound) return std::nullopt;
  constexpr Index kAll = kAnchorUnknowns + 1;
  const MatrixXd own = FitDiagnostics(untaped, *alone).precision();
  const MatrixXd with_tape = FitDiagnostics(without_causes, *taped).precision();
  const MatrixXd known = linear::Cholesky(averaged.covariance_mm2).inverse();
  VectorXd there(kAll);
  there << taped->state.anchors, taped->state.log_scale;
  MatrixXd precision = with_tape;
  precision.topLeftCorner(kAnchorUnknowns, kAnchorUnknowns) += known - own;
  VectorXd sum = with_tape * there;
  sum.head(kAnchorUnknowns) += known * averaged.anchors - own * alone->state.anchors;
  const linear::PivotedCholesky factor(precision);
  const VectorXd found = factor.solve(sum);
  frame.state.anchors = found.head<kAnchorUnknowns>();
  frame.state.log_scale = found[kAnchorUnknowns];
  place_all(without_causes, frame);
  return factor.inverse();
}

/// Clamped, because an average over models may be slightly outside the parameter's range.
CauseInAnchorFit cause_in_fit(const AveragedCause& own) {
  CauseInAnchorFit result;
  result.effect = own.cause.effect->id;
  result.side = name(own.cause.side);
  for (const auto i : each_index(own.values)) {
    const auto& parameter = own.cause.effect->parameters[i];
    result.parameters[std::string(parameter.name)] =
        std::clamp(own.values[i], parameter.lower, parameter.upper);
  }
  result.sigma = own.sigma;
  result.probability = own.probability;
  return result;
}

/// A fit, with the prior it gives for holes.
struct AnchorsWithCauses {
  BeltsByThemselves alone;
  MeasuredBelts without_causes;
};

tl::expected<AnchorsWithCauses, BeltsFitFailure> fit_anchors_with_causes(
    const BeltsAnalysis& analysis) {
  const MeasuredBelts& belts = analysis.measured;
  const AveragedAnchors& averaged = analysis.averaged;
  std::vector<CauseInAnchorFit> causes;
  std::vector<SizedCause> sizes;
  for (const AveragedCause& own : averaged.causes) {
    causes.push_back(cause_in_fit(own));
    sizes.push_back(own);
  }
  AnchorFit frame = analysis.frame;
  frame.counting = decided_counting(analysis);
  frame.state.anchors = averaged.anchors;
  MeasuredBelts without_causes = without_effects(belts, sizes, frame.state);
  place_and_judge(without_causes, sizes.size(), frame);
  MatrixXd covariance = averaged.covariance_mm2;
  if (!belts.distances.empty()) {
    const auto with_scale = take_distances(without_causes, averaged, frame);
    // Distances without positions with these readings: the contradiction shows with the uncorrected
    // readings.
    if (!with_scale) {
      return fit_by_themselves(belts).map([&](BeltsByThemselves as_read) {
        return AnchorsWithCauses{std::move(as_read), belts};
      });
    }
    covariance = *with_scale;
  }
  BeltsFit fit = fit_report(without_causes, FitDiagnostics(without_causes, frame), covariance);
  fit.causes = std::move(causes);
  fit.rms_mm = analysis.before.rms_mm;
  fit.half_left_out = prediction_by_halves(analysis.belts, frame, sizes);
  return AnchorsWithCauses{{std::move(fit), std::move(frame), std::move(covariance)},
                           std::move(without_causes)};
}

}  // namespace

tl::expected<BeltsFit, BeltsFitFailure> fit_with_causes(const BeltsAnalysis& analysis) {
  return fit_anchors_with_causes(analysis).map(
      [](AnchorsWithCauses found) { return std::move(found.alone.fit); });
}

tl::expected<BeltsFit, BeltsFitFailure> fit_with_causes(const MeasuredBelts& belts) {
  return analyse(belts, {}).and_then(
      [](const BeltsAnalysis& analysis) { return fit_with_causes(analysis); });
}

tl::expected<BeltsAndHolesFit, BeltsFitFailure> fit_with_causes_and_holes(
    const MeasuredBelts& belts, const std::vector<BeltHoles>& sets) {
  if (belts.points.empty()) return fit_belts_and_holes(belts, sets);
  return analyse(belts, {})
      .and_then(fit_anchors_with_causes)
      .and_then([&sets](AnchorsWithCauses found) {
        return fit_belts_and_holes(found.without_causes, sets, std::move(found.alone));
      });
}

}  // namespace chaintrue::grid::diagnosis
