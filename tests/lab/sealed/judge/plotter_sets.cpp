// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/plotter_sets.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "generator/hidden/plotter.hpp"
#include "generator/hidden/random.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "model/plotter/plotter_mechanism.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Dice;
using generator::HiddenPlotter;
using grid::TestDrawing;
using grid::observation::DrawnMeasure;

constexpr double kGravity = 9.80665;
constexpr double kRulerMm = 0.5;

model::PlotterMachine machine_of(PlotterKind kind) {
  model::PlotterMachine machine = model::mural(1500.0);
  machine.cord.compliance_per_n = 0.0;
  machine.cord.mass_kg_per_m = 0.0;
  machine.gondola.standoff_mm = 0.0;
  if (kind == PlotterKind::mural) return machine;
  machine.motors = model::MotorPlace::wall;
  machine.pulley_radius_mm = 10.0;
  if (kind == PlotterKind::body) return machine;
  machine.gondola = {.mass_kg = kind == PlotterKind::pen ? 0.5 : 0.2};
  // Links hang straight from the pins.
  if (kind == PlotterKind::light_pen) machine.pulley_radius_mm = 0.0;
  return machine;
}

model::PlotterFirmware firmware_of(PlotterKind kind) {
  return kind == PlotterKind::mural ? model::PlotterFirmware::mural
                                    : model::PlotterFirmware::fluidnc;
}

/// The true plotter: its settings, and the causes in its gondola and spools.
struct TruePlotter {
  HiddenPlotter hung;
  double zero_mm[2] = {};
  double scale_mm_per_m[2] = {};
  double wave_mm[2] = {};
  double phase_rad[2] = {};
  double turn_mm = 1.0;
  double growth_mm_per_m2[2] = {};
};

TruePlotter true_plotter(const model::PlotterMachine& machine, Dice& dice) {
  const model::Gondola& g = machine.gondola;
  const model::PlotterUncertainty& u = machine.uncertainty;
  TruePlotter plotter;
  plotter.hung = {machine.pin_spacing_mm + u.pin_spacing_mm * dice.normal(),
                  machine.pin_rise_mm + u.pin_rise_mm * dice.normal(),
                  machine.pulley_radius_mm,
                  machine.motors == model::MotorPlace::gondola,
                  g.spacing_mm,
                  g.pen_below_mm,
                  g.pen_right_mm,
                  g.mass_below_mm,
                  g.mass_right_mm,
                  0.0,
                  g.mass_kg * kGravity,
                  0.0,
                  0.0};
  for (int side = 0; side < 2; ++side) {
    plotter.zero_mm[side] = u.zero_mm * dice.normal();
    plotter.scale_mm_per_m[side] = u.scale_mm_per_m * dice.normal();
  }
  if (machine.pulley_radius_mm > 0.0)
    plotter.turn_mm = 2.0 * std::numbers::pi * machine.pulley_radius_mm;
  return plotter;
}

/// The usual size is 1.
void hide(const HiddenCause& cause, double size, double phase, TruePlotter& plotter) {
  const bool acts[2] = {cause.side != "right", cause.side != "left"};
  if (cause.effect == "pen_off_centre") plotter.hung.pen_right_mm += 5.0 * size;
  if (cause.effect == "servo_arm") plotter.hung.mass_right_mm += 4.0 * size;
  if (cause.effect == "gondola_width") plotter.hung.spacing_mm += 2.0 * size;
  if (cause.effect == "cord_weight")
    plotter.hung.cord_n_per_mm = 8e-6 * kGravity * std::abs(size);  // 8 g/m
  if (cause.effect == "cord_stretch") plotter.hung.compliance_per_n = 2e-4 * std::abs(size);
  for (int side = 0; side < 2; ++side) {
    if (!acts[side]) continue;
    if (cause.effect == "spool_eccentricity") {
      plotter.wave_mm[side] = 0.2 * std::abs(size);
      plotter.phase_rad[side] = phase;
    }
    if (cause.effect == "spool_layers") plotter.growth_mm_per_m2[side] = 5.0 * std::abs(size);
  }
}

/// (1); what is added changes with the cord by some hundredths at most, so that a step gains a digit.
double cord_out(const TruePlotter& p, int side, double counted_mm) {
  constexpr int kSteps = 40;
  const double own = (counted_mm - p.zero_mm[side]) / (1.0 + 1e-3 * p.scale_mm_per_m[side]);
  double cord = own;
  for (int step = 0; step < kSteps; ++step) {
    const double wave =
        p.wave_mm[side] * std::sin(2.0 * std::numbers::pi * cord / p.turn_mm + p.phase_rad[side]);
    const double metres = 1e-3 * cord;
    cord = own - wave - 0.5 * p.growth_mm_per_m2[side] * metres * metres;
  }
  return cord;
}

/// The position of a pen on cords of links: Newton on lengths_of_links from where straight cords
/// meet.
Eigen::Vector2d pen_of_links(const HiddenPlotter& hung, double left_mm, double right_mm) {
  // The links' error falls with the square of their number: a thousandth of the millimetres that the
  // cords are longer by than straight ones, far below a ruler's.
  constexpr int kLinks = 60, kMostSteps = 40;
  constexpr double kDifferenceMm = 0.01, kConvergedMm = 1e-4, kLongestStepMm = 40.0;
  const auto lengths_at = [&](double x, double y) {
    const auto l = generator::lengths_of_links(hung, x, y, kLinks);
    return Eigen::Vector2d(l[0], l[1]);
  };
  const double half = 0.5 * hung.pin_spacing_mm;
  const double x = (left_mm * left_mm - right_mm * right_mm) / (4.0 * half);
  Eigen::Vector2d pen(x, -std::sqrt(left_mm * left_mm - (x + half) * (x + half)));
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector2d here = lengths_at(pen.x(), pen.y());
    Eigen::Matrix2d slope;
    slope << (lengths_at(pen.x() + kDifferenceMm, pen.y()) - here) / kDifferenceMm,
        (lengths_at(pen.x(), pen.y() + kDifferenceMm) - here) / kDifferenceMm;
    const Eigen::Vector2d change =
        slope.partialPivLu().solve(Eigen::Vector2d(left_mm, right_mm) - here);
    pen += change * std::min(1.0, kLongestStepMm / change.norm());
    if (change.norm() < kConvergedMm) return pen;
  }
  throw std::runtime_error("a pen on links that comes to no rest");
}

Eigen::Vector2d pen_at_rest(const HiddenPlotter& hung, double left_mm, double right_mm) {
  if (hung.cord_n_per_mm > 0.0 || hung.compliance_per_n > 0.0)
    return pen_of_links(hung, left_mm, right_mm);
  const generator::PenAtRest pen = generator::lowest_pose(hung, left_mm, right_mm);
  return {pen.x_mm, pen.y_mm};
}

/// A ruler between two pens, or a string and a ruler across it.
double measured(const DrawnMeasure& m, const std::vector<Eigen::Vector2d>& pens) {
  const Eigen::Vector2d way = pens[m.to] - pens[m.from];
  if (m.kind == DrawnMeasure::Kind::length) return way.norm();
  const Eigen::Vector2d out = pens[m.middle] - pens[m.from];
  return (way.x() * out.y() - way.y() * out.x()) / way.norm();
}

Eigen::Vector2d pen_of(const TruePlotter& plotter, model::ChainLengths counted) {
  return pen_at_rest(plotter.hung, cord_out(plotter, 0, counted.left_mm),
                     cord_out(plotter, 1, counted.right_mm));
}

Eigen::VectorXd drawn(const TestDrawing& drawing, const TruePlotter& plotter) {
  const auto crosses = grid::drawn_measures_of(drawing).value();
  std::vector<Eigen::Vector2d> pens;
  for (const auto& cross : crosses.points()) pens.push_back(pen_of(plotter, cross.paid_out));
  Eigen::VectorXd values(std::ssize(drawing.measures));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = measured(drawing.measures[static_cast<std::size_t>(i)], pens);
  return values;
}

bool acts_on_links(const HiddenCause& cause) {
  return cause.effect == "cord_weight" || cause.effect == "cord_stretch";
}

/// The part of a change of the measures that settings with the stated sigmas do not absorb, in
/// units of noise.
double strength_of(const TestDrawing& drawing, const Eigen::VectorXd& change) {
  const auto readings = grid::drawn_measures_of(drawing).value();
  const auto mechanism = model::make_plotter_mechanism(drawing.machine);
  const auto line =
      readings.linearise(grid::observation::View(mechanism), {.parameters = true}).value();
  Eigen::VectorXd in_rows(change.size());
  for (const auto& unit : readings.units())
    in_rows[unit.first_row] = change[static_cast<Eigen::Index>(unit.index)] / kRulerMm;
  Eigen::MatrixXd columns = line.by_setting / kRulerMm;
  for (Eigen::Index k = 0; k < columns.cols(); ++k)
    columns.col(k) *= *mechanism->parameters()[static_cast<std::size_t>(k)].prior_sigma;
  const Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(change.size(), change.size()) + columns * columns.transpose();
  return std::sqrt(in_rows.dot(covariance.llt().solve(in_rows)));
}

}  // namespace

std::string_view name(PlotterKind kind) {
  constexpr std::string_view kNames[] = {"mural", "body", "pen", "light_pen"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<HiddenCause> causes_of(PlotterKind kind) {
  std::vector<HiddenCause> causes;
  if (kind == PlotterKind::light_pen) return {{"cord_weight", "both"}, {"cord_stretch", "both"}};
  if (kind != PlotterKind::pen)
    causes = {{"pen_off_centre", ""}, {"servo_arm", ""}, {"gondola_width", ""}};
  for (const char* side : {"left", "right"}) {
    causes.push_back({"spool_eccentricity", side});
    causes.push_back({"spool_layers", side});
  }
  causes.push_back({"spool_layers", "both"});
  return causes;
}

PlotterSet plotter_set(PlotterKind kind, const HiddenCause& cause, double least_strength,
                       double most_strength, std::uint64_t seed) {
  constexpr int kDraws = 200, kScalings = 12;
  PlotterSet set{cause, 0.0, grid::planned_drawing({machine_of(kind), firmware_of(kind)}), {}};
  Dice settings(seed, "settings of a plotter"), sizes(seed, "size of a cause"),
      ruler(seed, "ruler");
  const TruePlotter sound = true_plotter(set.drawing.machine, settings);
  const Eigen::VectorXd without = drawn(set.drawing, sound);
  Eigen::VectorXd values = without;
  TruePlotter plotter = sound;
  if (acts_on_links(cause)) {
    // The effect of such a cause is proportional to its size: scaled to a drawn strength instead of
    // repeated draws.
    const double wanted = sizes.log_uniform(least_strength, most_strength);
    double size = 1.0;
    for (int scaling = 0; scaling < kScalings; ++scaling) {
      plotter = sound;
      hide(cause, size, 0.0, plotter);
      values = drawn(set.drawing, plotter);
      set.strength = strength_of(set.drawing, values - without);
      if (set.strength >= least_strength && set.strength <= most_strength) break;
      size *= wanted / set.strength;
    }
  }
  for (int draw = 0; draw < kDraws && !cause.effect.empty() && !acts_on_links(cause); ++draw) {
    plotter = sound;
    const double size = sizes.sign() * sizes.log_uniform(0.3, 12.0);
    hide(cause, size, sizes.uniform(-std::numbers::pi, std::numbers::pi), plotter);
    values = drawn(set.drawing, plotter);
    set.strength = strength_of(set.drawing, values - without);
    if (set.strength >= least_strength && set.strength <= most_strength) break;
    if (draw + 1 == kDraws)
      throw std::runtime_error("no size of " + cause.effect + " is that strong");
  }
  for (std::size_t i = 0; i < set.drawing.measures.size(); ++i)
    set.drawing.measures[i].value_mm =
        values[static_cast<Eigen::Index>(i)] + kRulerMm * ruler.normal();
  set.pen = [plotter](model::ChainLengths counted) { return pen_of(plotter, counted); };
  return set;
}

PlotterOutcome outcome_of(const PlotterSet& set) {
  grid::diagnosis::DiagnosisOptions options;
  const auto found = grid::diagnosis::diagnose(set.drawing, options);
  if (!found) return PlotterOutcome::refused;
  if (found->causes.empty()) return PlotterOutcome::nothing;
  std::size_t listed = 0;
  bool is_right = false;
  const auto look_at = [&](const grid::diagnosis::CauseId& one) {
    ++listed;
    is_right = is_right || (one.effect->id == set.cause.effect && name(one.side) == set.cause.side);
  };
  for (const grid::diagnosis::Cause& one : found->causes) {
    look_at(one.cause);
    for (const auto& other : one.same_as) look_at(other.cause);
  }
  if (!is_right || listed > 3) return PlotterOutcome::wrong;
  return listed == 1 ? PlotterOutcome::named : PlotterOutcome::in_set;
}

}  // namespace chaintrue::sealed
