// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/found_plotter.hpp"

#include <cmath>

#include "grid/containers.hpp"

namespace chaintrue::grid {

namespace {

/// Above the diagonal, row by row.
std::vector<double> correlations_of(const MatrixXd& covariance) {
  std::vector<double> upper;
  for (const Index row : each_below(covariance.rows())) {
    for (Index column = row + 1; column < covariance.cols(); ++column) {
      const double both = std::sqrt(covariance(row, row) * covariance(column, column));
      upper.push_back(both > 0.0 ? covariance(row, column) / both : 0.0);
    }
  }
  return upper;
}

}  // namespace

MatrixXd FoundPlotter::covariance() const {
  VectorXd sigma(+model::kPlotterParameters);
  sigma << pin_spacing_mm.sigma, pin_rise_mm.sigma, zero_left_mm.sigma, zero_right_mm.sigma,
      scale_left_mm_per_m.sigma, scale_right_mm_per_m.sigma;
  MatrixXd covariance = sigma.cwiseAbs2().asDiagonal();
  std::size_t next = 0;
  for (const Index row : each_below(sigma.size())) {
    for (Index column = row + 1; column < sigma.size(); ++column, ++next)
      covariance(row, column) = covariance(column, row) =
          correlations.at(next) * sigma[row] * sigma[column];
  }
  return covariance;
}

FoundPlotter found_by(const DrawingFit& fit) {
  const auto at = [&](model::PlotterParameter parameter) {
    const PlotterSetting& own = fit.settings.at(as_size(parameter));
    return FoundSetting{own.found, own.sigma};
  };
  return {at(model::kPinSpacing),         at(model::kPinRise),   at(model::kZeroLeft),
          at(model::kZeroRight),          at(model::kScaleLeft), at(model::kScaleRight),
          correlations_of(fit.covariance)};
}

PlotterMachine machine_found(const SetPlotter& set, const FoundPlotter& found) {
  PlotterMachine machine = set.machine;
  machine.pin_spacing_mm = found.pin_spacing_mm.value;
  machine.pin_rise_mm = found.pin_rise_mm.value;
  machine.zero_mm = {found.zero_left_mm.value, found.zero_right_mm.value};
  machine.scale_mm_per_m = {found.scale_left_mm_per_m.value, found.scale_right_mm_per_m.value};
  return machine;
}

double more_steps(const SetPlotter& set, const PlotterMachine& found, Side side) {
  return (1.0 + 1e-3 * typed_in(set.firmware, found).scale_mm_per_m[side]) /
         (1.0 + 1e-3 * set.machine.scale_mm_per_m[side]);
}

SetPlotter once_typed_in(const SetPlotter& set, const PlotterMachine& found) {
  const PlotterMachine held = typed_in(set.firmware, found);
  SetPlotter next = set;
  next.machine.pin_spacing_mm = held.pin_spacing_mm;
  next.machine.pin_rise_mm = held.pin_rise_mm;
  for (const Side side : kSides) next.steps_per_mm[side] *= more_steps(set, found, side);
  if (set.firmware == model::PlotterFirmware::mural) {
    const double factor = more_steps(set, found, Side::left);
    const double too_much_mm = held.zero_mm.left_mm - set.machine.zero_mm.left_mm;
    next.machine.pulley_radius_mm /= factor;
    next.homed_offset_mm = (set.homed_offset_mm - too_much_mm) / factor;
  } else if (set.home) {
    const auto mechanism = make_plotter_mechanism(found);
    const auto pen = pen_of_command(set.firmware, set.machine, *mechanism, *set.home);
    if (pen) next.home = BedPoint{pen->x_mm, pen->y_mm};
  }
  return next;
}

}  // namespace chaintrue::grid
