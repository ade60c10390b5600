// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation: u, all unknowns in the order of FitColumns; g, where the holes lie as a whole beside
/// their commands (shift x, y, turn); T, du/dv with the free directions of the sheet following from
/// the rest; the rest as in the header.
#include "grid/holes/holes_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "grid/holes/hole_marks.hpp"
#include "grid/holes/holes_solution.hpp"
#include "grid/map/joint_fit.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using model::Setting;
using model::Side;

constexpr int kMaximumPasses = 40;
constexpr double kSettledSigmas = 1e-3;
/// 95 % of good readings are nearer.
constexpr double kHuberSigmas = 1.96;
/// Passes with soft weights only, so that several outliers cannot mask each other.
constexpr int kSoftPasses = 4;
/// What is stated without any uncertainty is taken as known this well, in mm or as a ratio.
constexpr double kKnownSigma = 1e-7;

class HolesFitter {
 public:
  HolesFitter(observation::TapeDistances distances, const HolesPrior& prior)
      : distances_(std::move(distances)),
        set_(distances_.set()),
        measured_(observation::sheet_measured(set_)),
        view_(distances_, measured_),
        mean_(Eigen::VectorXd::Zero(view_.columns().total())),
        prior_(Eigen::MatrixXd::Zero(mean_.size(), mean_.size())),
        weights_(Eigen::VectorXd::Ones(distances_.measured().size())) {
    const auto place = machine_columns();
    for (Eigen::Index i = 0; i < kHolesUnknowns; ++i) {
      mean_[place[static_cast<std::size_t>(i)]] = prior.mean[i];
      for (Eigen::Index j = 0; j < kHolesUnknowns; ++j) {
        prior_(place[static_cast<std::size_t>(i)], place[static_cast<std::size_t>(j)]) =
            prior.covariance(i, j);
      }
    }
    const double sheet[] = {observation::kSheetShiftMm, observation::kSheetShiftMm, observation::kSheetTurnRad};
    const bool known[] = {measured_.knows_x, measured_.knows_y, measured_.knows_rotation};
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (known[i]) prior_(6 + i, 6 + i) = sheet[i] * sheet[i];
    }
    u_ = mean_;
  }

  tl::expected<HolesFit, FitFailure> run();

 private:
  /// Where the machine's own unknowns stand among all.
  [[nodiscard]] std::array<Eigen::Index, kHolesUnknowns> machine_columns() const {
    const FitColumns& columns = view_.columns();
    return {0, 1, 2, 3, 4, 5, columns.scale(Side::left), columns.scale(Side::right)};
  }
  /// About where the unknowns stand now, with the weights of now.
  [[nodiscard]] LinearHoles linear() const;
  [[nodiscard]] HolesSolution solve(const Eigen::MatrixXd& prior) const {
    return solve_holes(linear(), prior);
  }
  tl::expected<void, FitFailure> settle();
  [[nodiscard]] std::optional<Eigen::Index> worst_bad(const HolesSolution& solution);
  bool update_weights(int pass, const HolesSolution& solution);
  void choose_surface();
  [[nodiscard]] HolesFit result() const;

  observation::TapeDistances distances_;
  const MeasuredHoles& set_;
  observation::SheetPrior measured_;
  HoleMarks view_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd prior_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd u_;
  HoleMarks::View now_;
  std::vector<BedPoint> as_stated_;
  HolesSolution solution_;
  bool has_surface_ = false;
  bool settled_ = false;
  double surface_log_evidence_ = 0.0;
};

LinearHoles HolesFitter::linear() const {
  const Eigen::MatrixXd by_v = now_.design * now_.follows;
  return {set_, now_, by_v, now_.residual_mm + by_v * (u_ - mean_), weights_};
}

/// The reading that fits worst, where the others alone, with the noise that they alone show, put it
/// beyond kOutlierSigmas: an outlier raises the noise found and so masks itself.
std::optional<Eigen::Index> HolesFitter::worst_bad(const HolesSolution& solution) {
  constexpr double kSuspect = 2.5;
  Eigen::Index worst = -1;
  double worst_sigmas = kSuspect;
  for (const Eigen::Index k : used_rows(weights_)) {
    const double sigmas = std::abs(solution.left_out[k]) / solution.left_out_sigma[k];
    if (sigmas <= worst_sigmas) continue;
    worst = k;
    worst_sigmas = sigmas;
  }
  if (worst < 0) return std::nullopt;
  const double weight = weights_[worst];
  weights_[worst] = 0.0;
  const HolesSolution without = solve(prior_);
  weights_[worst] = weight;
  const double sigmas = std::abs(without.left_out[worst]) / without.left_out_sigma[worst];
  return sigmas > kOutlierSigmas ? std::optional(worst) : std::nullopt;
}

/// True where the weights changed enough to solve again.
bool HolesFitter::update_weights(int pass, const HolesSolution& solution) {
  constexpr double kSettledWeight = 1e-2;
  double change = 0.0;
  for (const Eigen::Index k : used_rows(weights_)) {
    const double sigmas = std::abs(solution.left_out[k]) / solution.left_out_sigma[k];
    const double weight = std::min(1.0, kHuberSigmas / std::max(sigmas, 1e-12));
    change = std::max(change, std::abs(weight - weights_[k]));
    weights_[k] = weight;
  }
  if (pass >= kSoftPasses) {
    if (const auto worst = worst_bad(solution)) {
      weights_[*worst] = 0.0;
      return true;
    }
  }
  return change > kSettledWeight;
}

tl::expected<void, FitFailure> HolesFitter::settle() {
  weights_.setOnes();
  settled_ = false;
  for (int pass = 0; pass < kMaximumPasses; ++pass) {
    auto view = view_.at(u_);
    if (!view) {
      return tl::unexpected(FitFailure{FitFailure::Reason::point_unreachable, view.error()});
    }
    now_ = *std::move(view);
    if (as_stated_.empty()) as_stated_ = now_.aligned;
    solution_ = solve(prior_);
    const Eigen::VectorXd next = mean_ + solution_.change;
    const Eigen::VectorXd move = next - u_;
    double step = 0.0;
    for (Eigen::Index i = 0; i < move.size(); ++i) {
      const double sigma = std::sqrt(prior_(i, i));
      if (sigma > kKnownSigma) step = std::max(step, std::abs(move[i]) / sigma);
    }
    // Free directions of the sheet follow from the rest, and from where the holes lie now.
    Eigen::VectorXd changed = u_ + now_.follows * move;
    for (const Eigen::Index i : now_.free) changed[i] += now_.to_rest[i];
    const Eigen::VectorXd solved_with = weights_;
    const bool weights_move = update_weights(pass, solution_);
    u_ = changed;
    settled_ = !weights_move && step < kSettledSigmas && pass > kSoftPasses;
    if (settled_) {
      weights_ = solved_with;
      break;
    }
    if (static_cast<std::size_t>(used_rows(weights_).size()) < kFewestHoleDistances) break;
  }
  return {};
}

/// The surface with the amplitude that the readings speak for most, where they speak for one.
void HolesFitter::choose_surface() {
  Eigen::MatrixXd best;
  for (const double amplitude_mm : {0.3, 0.6, 1.2, 2.4, 4.8}) {
    Eigen::MatrixXd with = prior_;
    view_.add_surface_prior(with, amplitude_mm);
    const double gain = solve(with).log_evidence - solution_.log_evidence;
    if (best.size() != 0 && gain <= surface_log_evidence_) continue;
    surface_log_evidence_ = gain;
    best = std::move(with);
  }
  if (surface_log_evidence_ < kSurfaceEvidence) return;
  prior_ = std::move(best);
  has_surface_ = true;
}

ErrorSummary summary_of(const std::vector<FittedDistance>& distances, bool with_set_aside) {
  ErrorSummary summary;
  double squares = 0.0;
  std::size_t count = 0;
  for (const FittedDistance& distance : distances) {
    if (distance.set_aside && !with_set_aside) continue;
    squares += distance.left_out_mm * distance.left_out_mm;
    summary.maximum_mm = std::max(summary.maximum_mm, std::abs(distance.left_out_mm));
    ++count;
  }
  if (count > 0) summary.rms_mm = std::sqrt(squares / static_cast<double>(count));
  return summary;
}

HolesFit HolesFitter::result() const {
  HolesFit fit{
      view_.machine_at(u_),
      view_.sheet_at(u_),
      measured_,
      view_.surface_of(
          u_, now_.follows * solution_.covariance * now_.follows.transpose(), has_surface_),
      {},
      std::sqrt(solution_.noise2),
      surface_log_evidence_,
      has_surface_,
      {},
      {},
      solution_.hooks,
      {},
      {},
      {}};
  fit.posterior.covariance.resize(kHolesUnknowns, kHolesUnknowns);
  const auto place = machine_columns();
  for (Eigen::Index i = 0; i < kHolesUnknowns; ++i) {
    fit.posterior.mean[i] = u_[place[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < kHolesUnknowns; ++j) {
      fit.posterior.covariance(i, j) = solution_.covariance(place[static_cast<std::size_t>(i)],
                                                            place[static_cast<std::size_t>(j)]);
    }
  }
  for (std::size_t k = 0; k < set_.distances.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    FittedDistance distance;
    distance.measured_mm = distances_.measured()[at];
    distance.commanded_mm = commanded_mm(set_, set_.distances[k]);
    distance.predicted_mm = now_.geometry.predicted_mm[at];
    distance.left_out_mm = solution_.left_out[at];
    distance.left_out_sigma_mm = solution_.left_out_sigma[at];
    distance.set_aside = weights_[at] == 0.0;
    fit.distances.push_back(distance);
  }
  for (std::size_t i = 0; i < set_.holes.size(); ++i) {
    const auto at = 2 * static_cast<Eigen::Index>(i);
    const BedPoint mark = now_.marks[i];
    fit.holes.push_back(
        {distances_.places()[i].lengths,
         as_stated_[i],
         mark,
         {mark.x_mm + solution_.hole_shift[at], mark.y_mm + solution_.hole_shift[at + 1]}});
  }
  fit.left_out_all = summary_of(fit.distances, true);
  fit.left_out_good = summary_of(fit.distances, false);
  return fit;
}

tl::expected<HolesFit, FitFailure> HolesFitter::run() {
  if (auto done = settle(); !done) return tl::unexpected(done.error());
  choose_surface();
  if (has_surface_) {
    if (auto done = settle(); !done) return tl::unexpected(done.error());
  }
  const std::size_t good = used_rows(weights_).size();
  if (3 * good < 2 * set_.distances.size() || good < kFewestHoleDistances) {
    std::string sentence = fmt::format(
        "{} of {} distances contradict the others or the machine as stated; check the "
        "machine's measures, the controller's settings in force and which holes the "
        "distances join",
        set_.distances.size() - good,
        set_.distances.size());
    if (const auto hook = suspected_hook_offset_mm(set_)) {
      sentence += fmt::format(", and whether the tape's hook offset ({:.0f} mm?) was left out",
                              std::round(*hook));
    }
    return tl::unexpected(FitFailure{FitFailure::Reason::rank_deficient, sentence});
  }
  HolesFit fit = result();
  if (!settled_) {
    fit.notes.emplace_back(
        "The fit had not quite settled after its last pass: some distances hover between good and "
        "bad. Measure the ones with the largest errors again.");
  }
  return fit;
}

}  // namespace

HolesPrior stated_prior(const model::Machine& machine) {
  HolesPrior prior;
  prior.covariance = Eigen::MatrixXd::Zero(kHolesUnknowns, kHolesUnknowns);
  for (std::size_t i = 0; i < model::kMachineSettings.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double sigma =
        std::max(model::stated_sigma(machine, model::kMachineSettings[i]), kKnownSigma);
    prior.covariance(at, at) = sigma * sigma;
  }
  prior.covariance(6, 6) = prior.covariance(7, 7) = kScaleSigma * kScaleSigma;
  return prior;
}

tl::expected<HolesFit, FitFailure> fit_holes(const MeasuredHoles& set,
                                             const std::optional<HolesPrior>& prior) {
  if (!set.machine || set.distances.empty()) {
    throw std::invalid_argument(fmt::format("a fit of {} distances {} a machine",
                                            set.distances.size(),
                                            set.machine ? "with" : "without"));
  }
  auto distances = observation::TapeDistances::in_given_order(set);
  if (!distances) {
    return tl::unexpected(FitFailure{FitFailure::Reason::no_lengths, distances.error()});
  }
  auto fit = HolesFitter(*std::move(distances), prior.value_or(stated_prior(*set.machine))).run();
  if (fit) {
    const std::vector<std::string> notes = fit_notes(set, *fit);
    fit->notes.insert(fit->notes.begin(), notes.begin(), notes.end());
  }
  return fit;
}

}  // namespace chaintrue::grid
