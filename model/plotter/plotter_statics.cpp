// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_statics.hpp"

#include <algorithm>
#include <optional>

namespace chaintrue::model {

MechanismReason named(PlotterReason reason) {
  constexpr std::array<MechanismReason, 5> kReasons = {{
      {"above_the_pins", "the gondola would be above a point where its cords are attached"},
      {"outside_the_pins",
       "the gondola would not be between the points where its cords are "
       "attached"},
      {"slack", "a cord would be slack, because the gondola is too light for the forces on it"},
      {"cords_do_not_meet", "cords of these lengths do not meet"},
      {"not_converged", "no equilibrium was found"},
  }};
  return kReasons.at(static_cast<std::size_t>(reason));
}

namespace plotter {
namespace {

constexpr double kStandardGravity = 9.80665;  // m/s^2, CGPM 1901

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
    return CordLoad<double>{way.y / way.x, 0.5 * m.cord[side].weight_n_per_mm * length, way.x,
                            length};
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

/// The equations at a place, as a function of the unknowns.
template <class T>
auto equations_at(const Statics& m, const Placed<T>& at) {
  return [&m, at](const Unknowns<T>& q) { return residual(m, q, at); };
}

/// At a place where derivatives are not computed.
auto equations_of_unknowns(const Statics& m, const Placed<double>& at) {
  return equations_at(m, Placed<Dual<kUnknowns>>{at.x, at.y, at.pin_spacing, at.pin_rise});
}

bool converge(const Statics& m, const Placed<double>& at, Unknowns<double>& q) {
  return hanging::converge(equations_of_unknowns(m, at), {m.weight_n, m.side_n}, q) != 0;
}

/// From below the pins' middle to the place.
bool converge_by_continuation(const Statics& m, const Placed<double>& at, Unknowns<double>& q) {
  Placed<double> middle = at;
  middle.x = 0.0;
  middle.y = std::min(at.y, -0.3 * at.pin_spacing);
  q = straight_start(m, middle);
  return hanging::follow(q, [&](double share, Unknowns<double>& trial) {
           Placed<double> on = at;
           on.x = middle.x + share * (at.x - middle.x);
           on.y = middle.y + share * (at.y - middle.y);
           return converge(m, on, trial) ? 1 : 0;
         }) != 0;
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
  const Placed<Number> varied{Number::variable(place.x, 0), Number::variable(place.y, 1),
                              Number::variable(place.pin_spacing, 2),
                              Number::variable(place.pin_rise, 3)};
  const Unknowns<Number> at = hanging::with_derivatives<kPlaced>(
      equations_of_unknowns(statics, place), equations_at(statics, varied), q);
  return CordsAtRest{cord_state(statics, at, Side::left), cord_state(statics, at, Side::right),
                     at[kTurn]};
}

}  // namespace plotter
}  // namespace chaintrue::model
