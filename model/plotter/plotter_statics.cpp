// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_statics.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

namespace chaintrue::model {

MechanismReason named(PlotterReason reason) {
  constexpr std::array<MechanismReason, 5> kReasons = {{
      {"above_the_pins", "the gondola would be above a point that its cords hang from"},
      {"outside_the_pins", "the gondola would not be between the points that its cords hang from"},
      {"slack", "a cord would be slack: the gondola is too light for what pulls at it"},
      {"cords_do_not_meet", "cords of these lengths do not meet"},
      {"not_converged", "no equilibrium was found"},
  }};
  return kReasons.at(static_cast<std::size_t>(reason));
}

namespace plotter {
namespace {

constexpr double kStandardGravity = 9.80665;  // m/s^2, CGPM 1901
constexpr int kMostSteps = 60;
// Newton converges quadratically: after a step below these the error is less than rounding.
constexpr double kLengthStepMm = 1e-7;
constexpr double kRelativeForceStep = 1e-8;
constexpr double kTiltStepRad = 1e-9;

using Solved = Eigen::Matrix<double, kUnknowns, 1>;

std::optional<PlotterReason> outside(const Statics& m, const Placed<double>& at) {
  const double half_mm = 0.5 * at.pin_spacing;
  if (!(at.y < -0.5 * std::abs(at.pin_rise))) return PlotterReason::above_the_pins;
  if (!(std::abs(at.x) < half_mm)) return PlotterReason::outside_the_pins;
  if (!(std::abs(m.side_n) < m.weight_n)) return PlotterReason::slack;
  return std::nullopt;
}

/// Straight cords to a level gondola carry it and half of themselves.
Unknowns<double> straight_start(const Statics& m, const Placed<double>& at) {
  const auto chord = [&](double s, Side side) {
    const double u =
        s * (0.5 * s * at.pin_spacing - at.x + m.pen_right_mm - 0.5 * s * m.spacing_mm);
    const double y = 0.5 * s * at.pin_rise - at.y - m.pen_below_mm;
    // Beside a gondola's own width or at the pins the straight line has no equilibrium.
    const Offset<double> way{std::max(u, 0.02 * at.pin_spacing),
                             std::max(y, 0.02 * at.pin_spacing)};
    const double length = std::hypot(way.x, way.y, m.standoff_mm);
    return CordLoad<double>{
        way.y / way.x, 0.5 * m.cord[side].weight_n_per_mm * length, way.x, length};
  };
  const CordLoad<double> l = chord(-1.0, Side::left), r = chord(1.0, Side::right);
  const double load = m.weight_n - m.lift_n + l.v + r.v;
  Unknowns<double> q{};
  q[kH] = std::max((load + m.side_n * r.h) / (l.h + r.h), 0.01 * load + std::abs(m.side_n));
  q[kV] = q[kH] * l.h - l.v;
  q[kSLeft] = l.s;
  q[kSRight] = r.s;
  q[kNLeft] = q[kH] * m.standoff_mm / l.n;
  q[kNRight] = (q[kH] - m.side_n) * m.standoff_mm / r.n;
  return q;
}

/// The step, shortened where a pull or a length would fall below a tenth of itself or the gondola
/// would turn too far for its moment to be nearly linear. \returns whether it was below rounding.
bool advance(const Statics& m, const Solved& step, Unknowns<double>& q) {
  constexpr double kMostTurnRad = 0.3;
  double share = 1.0;
  const auto keep = [&share](double value, double change) {
    if (value + share * change < 0.1 * value) share = -0.9 * value / change;
  };
  keep(q[kH] + std::min(0.0, -m.side_n), step[kH]);
  keep(q[kSLeft], step[kSLeft]);
  keep(q[kSRight], step[kSRight]);
  if (std::abs(share * step[kTilt]) > kMostTurnRad) share = kMostTurnRad / std::abs(step[kTilt]);
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += share * step[static_cast<Eigen::Index>(i)];
  const auto small = [&](Unknown i, double scale) {
    return std::abs(step[i]) < kRelativeForceStep * scale;
  };
  const double force = m.weight_n + std::abs(q[kH]);
  return share == 1.0 && std::abs(step[kSLeft]) + std::abs(step[kSRight]) < kLengthStepMm &&
         small(kH, q[kH]) && small(kV, force) && small(kNLeft, force) && small(kNRight, force) &&
         std::abs(step[kTilt]) < kTiltStepRad;
}

/// Left sides of the equations with their derivatives by the unknowns.
struct Linear {
  Solved value;
  Eigen::Matrix<double, kUnknowns, kUnknowns> slope;
};

Linear linear_at(const Statics& m, const Unknowns<double>& q, const Placed<double>& at) {
  using D = Dual<kUnknowns>;
  Unknowns<D> unknowns;
  for (int i = 0; i < kUnknowns; ++i)
    unknowns[static_cast<std::size_t>(i)] = D::variable(q[static_cast<std::size_t>(i)], i);
  const Unknowns<D> left =
      residual(m, unknowns, Placed<D>{D(at.x), D(at.y), D(at.pin_spacing), D(at.pin_rise)});
  Linear linear;
  for (Eigen::Index i = 0; i < kUnknowns; ++i) {
    const D& own = left[static_cast<std::size_t>(i)];
    linear.value[i] = own.value;
    for (Eigen::Index j = 0; j < kUnknowns; ++j)
      linear.slope(i, j) = own.d[static_cast<std::size_t>(j)];
  }
  return linear;
}

/// Newton from `q`; false where it does not converge.
bool converge(const Statics& m, const Placed<double>& at, Unknowns<double>& q) {
  for (int n = 0; n < kMostSteps; ++n) {
    const Linear linear = linear_at(m, q, at);
    const Solved step = -linear.slope.partialPivLu().solve(linear.value);
    if (!step.allFinite()) return false;
    if (advance(m, step, q)) return true;
  }
  return false;
}

/// From below the pins' middle to the place in steps that Newton can follow.
bool converge_by_continuation(const Statics& m, const Placed<double>& at, Unknowns<double>& q) {
  Placed<double> middle = at;
  middle.x = 0.0;
  middle.y = std::min(at.y, -0.3 * at.pin_spacing);
  q = straight_start(m, middle);
  if (!converge(m, middle, q)) return false;
  constexpr double kShortest = 1e-4;
  double reached = 0.0, stride = 0.25;
  while (reached < 1.0) {
    const double next = std::min(1.0, reached + stride);
    Placed<double> on = at;
    on.x = middle.x + next * (at.x - middle.x);
    on.y = middle.y + next * (at.y - middle.y);
    Unknowns<double> trial = q;
    if (converge(m, on, trial)) {
      q = trial;
      reached = next;
      stride *= 1.5;
    } else if ((stride *= 0.5) < kShortest) {
      return false;
    }
  }
  return true;
}

/// The unknowns with their derivatives by the place: -(dF/dq)^-1 dF/d(place).
Unknowns<Number> with_derivatives(const Statics& m,
                                  const Unknowns<double>& q,
                                  const Placed<double>& at) {
  Unknowns<Number> fixed;
  for (std::size_t i = 0; i < q.size(); ++i) fixed[i] = Number(q[i]);
  const Unknowns<Number> left = residual(m,
                                         fixed,
                                         Placed<Number>{Number::variable(at.x, 0),
                                                        Number::variable(at.y, 1),
                                                        Number::variable(at.pin_spacing, 2),
                                                        Number::variable(at.pin_rise, 3)});
  Eigen::Matrix<double, kUnknowns, kPlaced> by_place;
  for (Eigen::Index i = 0; i < kUnknowns; ++i) {
    for (Eigen::Index j = 0; j < kPlaced; ++j)
      by_place(i, j) = left[static_cast<std::size_t>(i)].d[static_cast<std::size_t>(j)];
  }
  const Eigen::Matrix<double, kUnknowns, kPlaced> moved =
      -linear_at(m, q, at).slope.partialPivLu().solve(by_place);
  for (Eigen::Index i = 0; i < kUnknowns; ++i) {
    for (Eigen::Index j = 0; j < kPlaced; ++j)
      fixed[static_cast<std::size_t>(i)].d[static_cast<std::size_t>(j)] = moved(i, j);
  }
  return fixed;
}

}  // namespace

Statics statics_of(const PlotterMachine& machine) {
  const Gondola& g = machine.gondola;
  Statics m;
  m.spacing_mm = g.spacing_mm;
  m.pen_right_mm = g.pen_right_mm;
  m.pen_below_mm = g.pen_below_mm;
  m.mass_right_mm = g.mass_right_mm;
  m.mass_below_mm = g.mass_below_mm;
  m.standoff_mm = g.standoff_mm;
  m.weight_n = g.mass_kg * kStandardGravity;
  m.radius_mm = machine.pulley_radius_mm;
  m.feed_sign = machine.feed == Feed::over_top ? 1.0 : -1.0;
  m.motors_in_gondola = machine.motors == MotorPlace::gondola;
  const ChainMaterial cord{machine.cord.mass_kg_per_m * 1e-3 * kStandardGravity,
                           machine.cord.compliance_per_n};
  m.cord = {cord, cord};
  return m;
}

tl::expected<CordsAtRest, PlotterFailure> cords_at(const Statics& statics,
                                                   const Placed<double>& place) {
  if (const auto failure = outside(statics, place)) return tl::unexpected(*failure);
  Unknowns<double> q = straight_start(statics, place);
  if (!converge(statics, place, q) && !converge_by_continuation(statics, place, q))
    return tl::unexpected(PlotterReason::not_converged);
  const Unknowns<Number> at = with_derivatives(statics, q, place);
  return CordsAtRest{
      cord_state(statics, at, Side::left), cord_state(statics, at, Side::right), at[kTilt]};
}

}  // namespace plotter
}  // namespace chaintrue::model
