// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/joint_problem.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/chain_rows.hpp"
#include "grid/containers.hpp"
#include "grid/estimation/surface_correction.hpp"
#include "grid/estimation/unknowns.hpp"
#include "grid/precondition.hpp"
#include "interp/measured_region.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::estimation {
namespace {

using model::MarkPoint;
using model::Side;
using observation::Observation;

std::vector<MarkPoint> stated_marks(const observation::Observations& observations) {
  std::vector<MarkPoint> marks;
  for (const auto& observation : observations) {
    for (const observation::Place& place : observation->places()) marks.push_back(place.mark);
  }
  return marks;
}

/// The side of the square that each point has to itself.
double spacing_mm_of(const std::vector<MarkPoint>& points) {
  std::vector<interp::PlanePoint> in_plane;
  for (const MarkPoint point : points) in_plane.push_back({point.x_mm, point.y_mm});
  return std::sqrt(interp::ConvexHull(in_plane).area() / as_double(points.size()));
}

/// Intervals slightly wider than the square of each place: with three more coefficients than
/// intervals on each axis noise-free points can still be interpolated; the penalty makes excess
/// ones harmless, and more than some 200 per surface would only cost time. The smoother surface is
/// for accurate points, which resolve more.
interp::BsplineBasis basis_for(const EstimationInput& input, bool has_surface) {
  if (!has_surface) return {input.domain, 1, 1};
  if (input.intervals_x > 0 && input.intervals_y > 0)
    return {input.domain, input.intervals_x, input.intervals_y};
  const double widening = input.bending_order == 2 ? 1.2 : 0.8;
  const double spacing_mm = widening * spacing_mm_of(stated_marks(input.observations));
  const auto intervals = [spacing_mm](double length_mm, int most) {
    return std::clamp(static_cast<int>(std::ceil(length_mm / spacing_mm)), 3, most);
  };
  return {input.domain, intervals(input.domain.width(), 12), intervals(input.domain.height(), 8)};
}

/// Chain lengths at given marks are linear in the correction, so it can be omitted from the point
/// of linearisation; the tool's position depends on the correction.
bool is_linear_in_correction(const Observation& observation) {
  return observation.places().empty() || observation.kind().reads_chains;
}

double length_of(model::ChainLengths lengths, Side side) { return lengths[side]; }

}  // namespace

JointProblem::JointProblem(const EstimationInput& input,
                           bool has_surface,
                           RejectedReadings rejected)
    : input_(input),
      rejected_(std::move(rejected)),
      set_(observation_set(input.machine, input.observations, input.mechanism)),
      layout_(set_, {}),
      has_surface_(has_surface),
      basis_(basis_for(input, has_surface)) {
  if (has_surface && set_.mechanism->lengths().size() != 2) {
    throw precondition("a surface corrects two lengths, not the {} of {}",
                       set_.mechanism->lengths().size(),
                       set_.mechanism->kind());
  }
  for (const auto& observation : input.observations)
    places_move_ = places_move_ || !is_linear_in_correction(*observation);
}

const std::vector<Eigen::Index>& JointProblem::rejected(std::size_t unit) const {
  static const std::vector<Eigen::Index> kNone;
  return rejected_.empty() ? kNone : rejected_.at(unit);
}

double JointProblem::dof(const interp::PenalisedFit& fit) const {
  Eigen::Index rows = 0;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    rows += rejected(u).empty() ? units_[u].rows : without_readings(units_[u], rejected(u)).cols();
  }
  return as_double(rows) - fit.edf;
}

EstimationFailure JointProblem::unreachable(const UnreachablePlace& failure) const {
  const Observation& readings = *input_.observations[failure.place.observation];
  const observation::Place& there = readings.places()[failure.place.place];
  return {EstimationFailure::Reason::place_unreachable,
          fmt::format("{} {} at ({:.1f}, {:.1f}): {}",
                      readings.kind().place,
                      there.name,
                      there.mark.x_mm,
                      there.mark.y_mm,
                      failure.sentence())};
}

State JointProblem::stated() const {
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(basis_.size());
  return {Eigen::VectorXd::Zero(layout_.total()), {basis_, {0.0, 0.0}, {nothing, nothing}}};
}

tl::expected<void, EstimationFailure> JointProblem::linearise(const State& state) {
  const std::vector<SurfaceCorrection> corrections = corrections_of(state);
  const auto mechanism = layout_.mechanism_at(state.settings);
  std::vector<ObservedFrom> from;
  for (std::size_t k = 0; k < input_.observations.size(); ++k) {
    const bool about_none =
        is_linear_in_correction(*input_.observations[k]) && !input_.fixed_weights;
    from.push_back(
        {{mechanism, layout_.sheet_at(state.settings, k), about_none ? nullptr : &corrections[k]},
         state.settings(layout_.columns_of(k))});
  }
  const auto system = estimation::linearise(set_, from);
  if (!system) return tl::unexpected(unreachable(system.error()));
  std::vector<MarkPoint> marks;
  for (const SystemPlace& place : system->places) {
    marks.push_back(corrections[place.observation].to_surface(place.state.mark));
  }
  observe(std::move(marks));
  fill_design(*system, state);
  eliminate_free_directions(*system, from, state);
  local_.reset();
  const bool many = design_.rows() > LocalDesign::kRowsForEachUnknown * unknowns_->total();
  if (has_surface_ && many && free_.columns.empty())
    local_.emplace(design_, units_, *unknowns_, *observed_, basis_, surface_marks_);
  return {};
}

std::vector<SurfaceCorrection> JointProblem::corrections_of(const State& state) const {
  const model::SheetPlacement first = layout_.sheet_at(state.settings, 0);
  std::vector<SurfaceCorrection> corrections{SurfaceCorrection(state.surface)};
  for (std::size_t k = 1; k < input_.observations.size(); ++k)
    corrections.emplace_back(state.surface, first, layout_.sheet_at(state.settings, k));
  return corrections;
}

/// The part of the surface that the places observe; computed once if they are fixed.
void JointProblem::observe(std::vector<MarkPoint> places) {
  surface_marks_ = std::move(places);
  if (unknowns_ && !places_move_) return;
  SurfaceColumns surface;
  if (has_surface_) {
    observed_.emplace(basis_, input_.bending_order, surface_marks_);
    surface = {observed_->polynomials(), observed_->penalised()};
  }
  unknowns_.emplace(set_, surface);
}

/// e f + s at the state.
Eigen::Vector2d JointProblem::correction_at(std::size_t place,
                                            const SystemPlace& at,
                                            const State& state) const {
  const model::ChainLengths own = at.state.reading.lengths;
  const model::ChainLengths corrected =
      state.surface.apply(surface_marks_[place], own, Eigen::Matrix2d::Zero()).lengths;
  return {corrected.left_mm - own.left_mm, corrected.right_mm - own.right_mm};
}

void JointProblem::fill_design(const LinearisedSystem& system, const State& state) {
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(system.response.size(), unknowns_->total());
  Eigen::VectorXd response = system.response;
  design(Eigen::all, unknowns_->of_set()) = system.by_setting;
  for (const auto* units : {&system.units, &system.certain}) {
    for (const SystemUnit& unit : *units) {
      add_chain_columns(system, unit, state, design, response);
    }
  }
  std::vector<Eigen::Index> rows;
  std::vector<Eigen::Index> certain_rows;
  const auto take = [](const SystemUnit& unit, std::vector<Eigen::Index>& list) {
    for (Eigen::Index i = 0; i < unit.rows; ++i) list.push_back(unit.first_row + i);
  };
  units_ = system.units;
  for (SystemUnit& unit : units_) {
    const auto first = std::ssize(rows);
    take(unit, rows);
    unit.first_row = first;
  }
  for (const SystemUnit& unit : system.certain) take(unit, certain_rows);
  design_ = design(rows, Eigen::all);
  response_ = response(rows);
  sure_design_ = design(certain_rows, Eigen::all);
  sure_response_ = response(certain_rows);
}

/// The scales' and the surface's columns of a unit.
void JointProblem::add_chain_columns(const LinearisedSystem& system,
                                     const SystemUnit& unit,
                                     const State& state,
                                     Eigen::MatrixXd& design,
                                     Eigen::VectorXd& response) const {
  auto own = design.middleRows(unit.first_row, unit.rows);
  const Observation& observation = *input_.observations[unit.observation];
  for (const observation::PlaceColumns& place : unit.places) {
    const SystemPlace& at = system.places[place.place];
    for (const Side side : model::kSides) {
      const Eigen::VectorXd by_chain = place.by_chain.col(row_of(side));
      own.col(unknowns_->scale(side)) += by_chain * length_of(at.state.reading.lengths, side);
      if (!has_surface_) continue;
      const auto row = as_index(place.place);
      own.middleCols(unknowns_->polynomial(side), observed_->polynomials()) +=
          by_chain * observed_->polynomial_rows().row(row);
      own.middleCols(unknowns_->first_penalised_of(side), observed_->penalised()) +=
          by_chain * observed_->bend_rows().row(row);
    }
    if (!is_linear_in_correction(observation) || input_.fixed_weights)
      response.segment(unit.first_row, unit.rows) +=
          place.by_chain * correction_at(place.place, at, state);
  }
}

/// d(corrected lengths at a mark)/d(unknowns), 2 x total.
Eigen::MatrixXd JointProblem::lengths_by_unknown(std::size_t place,
                                                 const SystemPlace& at,
                                                 const observation::View& view) const {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, unknowns_->total());
  for (Eigen::Index i = 0; i < kMachineSettingCount; ++i) {
    rows.col(i) = at.state.by_length.cwiseProduct(
        view.chains().sensitivity(at.state.reading, model::kMachineSettings[as_size(i)]));
  }
  if (const Eigen::Index sheet = unknowns_->sheet(at.observation); sheet >= 0) {
    rows.middleCols<3>(sheet) =
        at.state.by_length.asDiagonal() *
        (at.state.reading.position_jacobian * view.sheet.sensitivity(at.state.mark));
  }
  for (const Side side : model::kSides) {
    const Eigen::Index row = row_of(side);
    rows(row, unknowns_->scale(side)) = length_of(at.state.reading.lengths, side);
    if (!has_surface_) continue;
    const auto own = as_index(place);
    rows.row(row).segment(unknowns_->polynomial(side), observed_->polynomials()) =
        observed_->polynomial_rows().row(own);
    rows.row(row).segment(unknowns_->first_penalised_of(side), observed_->penalised()) =
        observed_->bend_rows().row(own);
  }
  return rows;
}

void JointProblem::eliminate_free_directions(const LinearisedSystem& system,
                                             const std::vector<ObservedFrom>& from,
                                             const State& state) {
  free_ = {};
  laid_marks_.assign(input_.observations.size(), {});
  for (std::size_t k = 0; k < input_.observations.size(); ++k) {
    const Observation& observation = *input_.observations[k];
    PlacesOnSheet places;
    for (std::size_t i = 0; observation.sheet() && i < model::kSheetSettings.size(); ++i) {
      if (observation.sheet()->knows(model::kSheetSettings[i])) continue;
      places.free_rows.push_back(as_index(i));
      places.free_columns.push_back(unknowns_->sheet(k) + as_index(i));
    }
    const Eigen::Index rows = 2 * std::ssize(observation.places());
    places.by_unknown = Eigen::MatrixXd::Zero(rows, unknowns_->total());
    places.moved = Eigen::VectorXd::Zero(rows);
    for (std::size_t p = 0; p < system.places.size(); ++p) {
      const SystemPlace& at = system.places[p];
      if (at.observation != k) continue;
      places.commanded.push_back(observation.places()[at.place].mark);
      places.marks.push_back(at.state.mark);
      if (places.free_columns.empty()) continue;
      const Eigen::Matrix2d to_mark = -at.state.by_mark.inverse();
      const auto row = 2 * as_index(at.place);
      const Eigen::MatrixXd lengths = lengths_by_unknown(p, at, from[k].view);
      places.by_unknown.middleRows<2>(row) = to_mark * lengths;
      Eigen::VectorXd now = Eigen::VectorXd::Zero(unknowns_->total());
      now(unknowns_->columns_of(k)) = from[k].settings;
      places.moved.segment<2>(row) = to_mark * (lengths * now + correction_at(p, at, state));
    }
    laid_marks_[k] = placed_rigidly(places);
    add_free_directions(places, free_);
  }
  if (free_.columns.empty()) return;
  const Eigen::MatrixXd by_free = design_(Eigen::all, free_.columns);
  response_ -= by_free * free_.constant;
  design_ += by_free * free_.following;
  design_(Eigen::all, free_.columns).setZero();
}

Eigen::VectorXd JointProblem::coefficients(const interp::PenalisedFit& fit) const {
  Eigen::VectorXd all = fit.coefficients;
  if (!free_.columns.empty()) {
    const Eigen::VectorXd free = free_.constant + free_.following * all;
    all(free_.columns) = free;
  }
  return all;
}

Eigen::MatrixXd JointProblem::covariance(const interp::PenalisedFit& fit) const {
  if (free_.columns.empty()) return fit.corrected_covariance;
  Eigen::MatrixXd follows = Eigen::MatrixXd::Identity(unknowns_->total(), unknowns_->total());
  follows(free_.columns, Eigen::all) = free_.following;
  return follows * fit.corrected_covariance * follows.transpose();
}

State JointProblem::state_of(const interp::PenalisedFit& fit) const {
  const Eigen::VectorXd all = coefficients(fit);
  State state = stated();
  state.settings.head(unknowns_->settings()) = all.head(unknowns_->settings());
  for (std::size_t k = 1; k < input_.observations.size(); ++k) {
    if (layout_.sheet(k) >= 0)
      state.settings.segment<3>(layout_.sheet(k)) = all.segment<3>(unknowns_->sheet(k));
  }
  for (const Side side : model::kSides) {
    if (unknowns_->scales() == 0) break;
    state.surface.scale[side] = all[unknowns_->scale(side)];
    if (!has_surface_) continue;
    state.surface.coefficients[side] =
        observed_->polynomial_coefficients() *
            all.segment(unknowns_->polynomial(side), observed_->polynomials()) +
        observed_->penalised_basis() *
            all.segment(unknowns_->first_penalised_of(side), observed_->penalised());
  }
  return state;
}

Eigen::MatrixXd JointProblem::map_covariance(const interp::PenalisedFit& fit,
                                             const FitColumns& columns) const {
  const Eigen::Index plain = unknowns_->settings() + unknowns_->scales();
  Eigen::MatrixXd to_splines = Eigen::MatrixXd::Zero(columns.total(), unknowns_->total());
  to_splines.topLeftCorner(plain, plain).setIdentity();
  for (const Side side : model::kSides) {
    if (!has_surface_) break;
    to_splines.block(columns.spline(side),
                     unknowns_->polynomial(side),
                     columns.basis,
                     observed_->polynomials()) = observed_->polynomial_coefficients();
    to_splines.block(columns.spline(side),
                     unknowns_->first_penalised_of(side),
                     columns.basis,
                     observed_->penalised()) = observed_->penalised_basis();
  }
  Eigen::MatrixXd result = to_splines * covariance(fit) * to_splines.transpose();
  if (!has_surface_) return result;
  const Eigen::MatrixXd unobserved = fit.inverse_lambda * observed_->null_space_coefficients() *
                                     observed_->null_space_coefficients().transpose();
  for (const Side side : model::kSides) {
    result.block(columns.spline(side), columns.spline(side), columns.basis, columns.basis) +=
        unobserved;
  }
  return result;
}

}  // namespace chaintrue::grid::estimation
