// SPDX-License-Identifier: GPL-3.0-or-later
/// Treatment specific to points with their chain lengths: unstated noise is estimated, and
/// noise-free readings on a lattice are interpolated.
#include <fmt/format.h>

#include <algorithm>

#include "grid/containers.hpp"
#include "grid/estimation/spatial_blocks.hpp"
#include "grid/failed.hpp"
#include "grid/map/corrected_data.hpp"
#include "grid/map/fit_part.hpp"
#include "grid/map/lattice_residual.hpp"
#include "grid/map/map_parts.hpp"
#include "grid/map/noise_from_repeats.hpp"
#include "grid/raster.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {
namespace {

/// The least noise: a stated zero means readings with all digits. With settings known to a
/// millimetre the squares of finer weights leave no digits for what the points do not determine: at
/// 1e-6 mm the fit appears undetermined.
constexpr double kLeastNoiseMm = 1e-5;

constexpr WorkStep kSmoother{"a smoother correction", 2, FitPart::kStepsToFindNoise};
constexpr WorkStep kNoise{"how large the noise is", 3, FitPart::kStepsToFindNoise};

/// The bed, the margin for hand-laid marks beyond it, and all points.
interp::Rectangle domain_of(const MeasuredGrid& grid, const std::vector<LengthPoint>& points) {
  const Bed& bed = grid.machine->bed;
  double beyond = 0.0;
  if (grid.sheet)
    beyond = 2.0 * grid.sheet->shift_mm + 1e-3 * grid.sheet->rotation_mrad * 0.5 * bed.width_mm;
  interp::Rectangle domain = area_of(bed, beyond);
  for (const LengthPoint& point : points) take_in(domain, point.mark);
  return domain;
}

/// A stated noise of zero counts as unstated: it is estimated from the points.
bool states_noise(const MeasuredGrid& grid) {
  return grid.noise && (grid.noise->length_mm > 0.0 || grid.noise->position_mm > 0.0);
}

/// A surface through every node has no residuals there, but its own left-out residuals.
void replace_residuals(std::vector<FittedPoint>& points, const LatticeFit& lattice) {
  for (const auto i : each_index(points)) {
    if (points[i].is_rejected()) continue;
    points[i].residual.setZero();
    points[i].left_out = lattice.left_out_residual_mm[i];
  }
}

void append_lattice_notes(std::vector<std::string>& notes, const LatticeResidual& lattice) {
  notes.emplace_back(
      "The readings have no noise and are on full rows and columns, so the map passes through "
      "every one of them.");
  for (const Index iy : each_below(lattice.doubt_mm.cols())) {
    for (const Index ix : each_below(lattice.doubt_mm.rows())) {
      if (lattice.doubt_mm(ix, iy) == 0.0) continue;
      notes.push_back(
          fmt::format("No reading at ({:.0f}, {:.0f}) was used; the map there comes from the row "
                      "or column through it and is accurate to about {:.2g} mm.",
                      lattice.x_nodes_mm[as_size(ix)], lattice.y_nodes_mm[as_size(iy)],
                      lattice.doubt_mm(ix, iy)));
    }
  }
}

class PointsPart final : public FitPart {
 public:
  PointsPart(MeasuredGrid grid, std::vector<LengthPoint> points, observation::PointNoise rounding)
      : grid_(std::move(grid)), points_(std::move(points)), rounding_(rounding) {
    constexpr std::size_t kFewestPoints = 6;
    fewest_good = kFewestPoints;
    machine = *grid_.machine;
    readings = grid_.readings;
    sheet = grid_.sheet;
    domain = domain_of(grid_, points_);
    held_out_together = spatial_blocks(points_);
    noise = {interp::NoiseKnowledge::unknown, 0.0};
    if (states_noise(grid_)) {
      noise_ = {std::max(grid_.noise->length_mm, kLeastNoiseMm),
                std::max(grid_.noise->position_mm, kLeastNoiseMm)};
      noise = {interp::NoiseKnowledge::from_repeats, grid_.noise->dof};
      source_ = NoiseSource::stated;
    }
    observe();
  }

  [[nodiscard]] tl::expected<void, FitFailure> find_noise(Fitting& alone) override {
    if (noise.knowledge != interp::NoiseKnowledge::unknown) return {};
    prefer_smoother(alone);
    if (const auto repeats = noise_from_repeats(points_of(alone), noise_, rounding_)) {
      noise_.length_mm *= repeats->factor;
      noise_.position_mm *= repeats->factor;
      noise = {interp::NoiseKnowledge::from_repeats, repeats->dof};
      source_ = NoiseSource::repeats;
      observe();
      alone.input.observations.front() = observation;
      alone.input.noise = noise;
      alone.input.step = kNoise;
      auto again = Fitting::of(std::move(alone.input));
      if (!again) return failed(again);
      alone = *std::move(again);
      return {};
    }
    Fitting plain = with_plain_calibration(alone);
    if ((lattice_ = fit_lattice(plain.estimate, points_of(plain)))) alone = std::move(plain);
    return {};
  }

  void take_noise(const Fitting& alone) override {
    const estimation::Estimate& estimate = alone.estimate;
    const double left = 2.0 * as_double(points_.size()) - estimate.effective_parameters;
    noise_ = {estimate.noise_factor * noise_.length_mm, estimate.noise_factor * noise_.position_mm};
    noise = {interp::NoiseKnowledge::from_repeats,
             source_ == NoiseSource::repeats ? noise.degrees_of_freedom : std::max(left, 1.0)};
    lattice_.reset();
    observe();
  }

  std::string to_check() const override {
    return "the machine's measures, the order of the columns and the units";
  }

  void add_to(MapDraft& draft, const Fitting& fitting, std::size_t file,
              const std::string& name) const override {
    std::vector<FittedPoint> points = points_of(fitting, file);
    if (lattice_) replace_residuals(points, *lattice_);
    if (draft.points.empty()) {
      draft.map.noise = {noise_.length_mm, noise_.position_mm, source_,
                         fitting.estimate.noise_factor};
    }
    if (name.empty()) note_noise(draft);
    std::size_t number = 0;
    std::size_t rejected = 0;
    for (MapPoint& point : map_points(points, grid_, noise_)) {
      ++number;
      if (point.bad) {
        ++rejected;
        note_rejected(point, number, name, draft.notes);
      }
      point.mark = fitting.in_frame(file, point.mark);
      if (!point.bad) draft.good.push_back(point.mark);
      draft.map.points.push_back(point);
    }
    append_all(draft.points, points);
    draft.sources.push_back(
        fmt::format("{} points of {}{}", points.size(), name,
                    rejected == 0 ? "" : fmt::format(" ({} left out)", rejected)));
    if (lattice_) {
      std::get<ModelSurface>(draft.map.surface).lattice = lattice_->residual;
      append_lattice_notes(draft.last_notes, lattice_->residual);
    }
  }

 private:
  /// The observation of the points with the current noise.
  void observe() {
    observation = std::make_shared<const observation::ChainLengthReadings>(
        chain_length_readings(points_, noise_, noise.degrees_of_freedom, grid_.sheet));
  }

  std::vector<FittedPoint> points_of(const Fitting& fitting, std::size_t file = 0) const {
    return fitted_points(points_, fitting.estimate, file);
  }

  /// Readings with all digits, from a simulator or a very good measurement, support a smoother
  /// surface than noisy ones. It is used if it predicts left-out points a fifth better.
  void prefer_smoother(Fitting& alone) const {
    constexpr double kClearlyBetter = 0.8;
    estimation::EstimationInput smoother = alone.input;
    smoother.bending_order = 3;
    smoother.step = kSmoother;
    auto fit = Fitting::of(std::move(smoother));
    if (!fit) return;
    const auto left_out_mm = [&](const Fitting& one) {
      return held_out_accuracy(points_of(one)).leave_one_out.chain.rms_mm;
    };
    if (left_out_mm(*fit) > kClearlyBetter * left_out_mm(alone)) return;
    alone = *std::move(fit);
  }

  /// `fit` with settings and chain scales by least squares alone, for a surface that passes through
  /// every point: with the machine, sheet and scales that minimise
  ///
  ///   sum over good points |y - (1 + e) f(theta)|^2 / s^2 + |theta / sigma|^2 + |e / kScaleSigma|^2
  ///
  /// with s, the residual's size, by restricted maximum likelihood. The joint fit trades a setting
  /// against the bending of the surface that would replace it: right for estimating settings, but
  /// the part left to the surface need not be small. The error of a surface through all nodes is
  /// proportional to its size, so here the settings minimise the residual at the nodes. For
  /// machines whose lengths have unmodelled errors of 0.8 mm this lowers the largest error between
  /// 4 x 7 to 7 x 13 nodes by a fifth to a half.
  ///
  /// Covariances of the settings and scales grow by the square of what they moved: the joint fit's
  /// estimate remains the best one of the settings themselves. Unchanged if the least squares fail.
  [[nodiscard]] Fitting with_plain_calibration(Fitting fit) const {
    estimation::EstimationInput input = fit.input;
    input.observations.front() = std::make_shared<const observation::ChainLengthReadings>(
        chain_length_readings(points_, {1.0, 0.0}, noise.degrees_of_freedom, grid_.sheet));
    input.noise = {interp::NoiseKnowledge::unknown, 0.0};
    input.surface = estimation::SurfaceUse::none;
    input.held_out_together.clear();
    const auto& units = fit.estimate.units;
    VectorXd& weights = input.fixed_weights.emplace(std::ssize(units));
    for (const auto u : each_index(units))
      weights[as_index(u)] = units[u].is_rejected() ? 0.0 : 1.0;
    const auto plain = estimation::estimate(input);
    if (!plain || !plain->converged) return fit;
    estimation::Estimate& estimate = fit.estimate;
    const Index known = estimate.columns.settings + 2;
    const VectorXd change = plain->map_unknowns - estimate.map_unknowns;
    estimate.machine = plain->machine;
    estimate.observations.front().sheet = plain->observations.front().sheet;
    estimate.surface.scale = plain->surface.scale;
    estimate.map_unknowns = plain->map_unknowns;
    estimate.covariance.topLeftCorner(known, known) += change * change.transpose();
    return fit;
  }

  /// For a single file: the noise relative to the stated one.
  static void note_noise(MapDraft& draft) {
    const MapNoise& noise = draft.map.noise;
    if (noise.source == NoiseSource::stated && noise.factor_found > kNoiseDisagreement) {
      draft.notes.push_back(
          fmt::format("The readings scatter {:.1f} times as much as you entered: check how the "
                      "marks and the lengths were measured.",
                      noise.factor_found));
    }
  }

  static void note_rejected(const MapPoint& point, std::size_t number, const std::string& name,
                            std::vector<std::string>& notes) {
    notes.push_back(
        fmt::format("{} {} at ({:.0f}, {:.0f}) is off by {:.1f} mm, {:.0f} times the scatter of "
                    "the readings, and was left out. Measure it again.",
                    name.empty() ? "Point" : name + ": point", number, point.mark.x_mm,
                    point.mark.y_mm, point.left_out_mm.norm(), point.distance_sigmas));
  }

  MeasuredGrid grid_;  ///< corrected
  std::vector<LengthPoint> points_;
  observation::PointNoise rounding_;  ///< from the readings as written
  observation::PointNoise noise_;
  NoiseSource source_ = NoiseSource::fit;
  /// Replaces the surface if noise-free readings lie on a lattice.
  std::optional<LatticeFit> lattice_;
};

}  // namespace

tl::expected<std::unique_ptr<FitPart>, FitFailure> part_of(const MeasuredGrid& grid) {
  if (!grid.machine) {
    return failed(FitReason::no_machine,
                  "the grid has no machine, which a residual surface needs: add --machine, or use "
                  "--surface direct");
  }
  auto corrected = corrected_data(grid);
  if (!corrected) return failed(corrected);
  auto points = length_points(corrected->grid);
  if (!points) return failed(FitReason::no_lengths, points.error());
  MeasuredGrid& own = corrected->grid;
  if (states_noise(own)) own.noise = not_below_rounding(*own.noise, grid);
  if (auto possible = check_readings_of(*own.machine, own.readings, "grid's"); !possible)
    return failed(possible);
  auto part = std::make_unique<PointsPart>(own, *std::move(points), rounding_noise(grid));
  part->corrections = std::move(corrected->notes);
  return part;
}

}  // namespace chaintrue::grid
