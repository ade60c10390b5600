// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: rest.hpp. Unknowns: H of the right chain, V of the left, and per chain `a`: its free
// length on the drum, or the turn of the tooth it leaves on the polygon.
#include "generator/hidden/rest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

constexpr double kGravity = 9.80665;
// A slack chain bends within a link: near a tie either tooth is accepted.
constexpr double kSeat = 1.01;

/// End of a hanging chain and its derivatives by H, V and S.
struct Hang {
  double u = 0.0, y = 0.0;
  double u_h = 0.0, u_v = 0.0, u_s = 0.0;
  double y_h = 0.0, y_v = 0.0, y_s = 0.0;
};

// The pieces, one after another, from the ring up.
Hang hang(double h, double v, double free_mm, int pieces, double w, double c) {
  const double piece = free_mm / pieces;
  const double weight = w * piece;
  double inverse = 0.0, rising = 0.0, cubed = 0.0, cubed_v = 0.0, cubed_vv = 0.0;
  double cubed_v_k = 0.0, cubed_k = 0.0, sum_v = 0.0;
  for (int k = 0; k < pieces; ++k) {
    const double middle = k + 0.5;
    const double vk = v + weight * middle;
    const double t = 1.0 / std::sqrt(h * h + vk * vk);
    const double t3 = t * t * t;
    inverse += t;
    rising += vk * t;
    cubed += t3;
    cubed_v += vk * t3;
    cubed_vv += vk * vk * t3;
    cubed_k += middle * t3;
    cubed_v_k += vk * middle * t3;
    sum_v += vk;
  }
  const double n = pieces;
  const double sum_k = 0.5 * n * n;
  Hang r;
  r.u = piece * h * (inverse + c * n);
  r.y = piece * (rising + c * sum_v);
  r.u_h = piece * (inverse + c * n - h * h * cubed);
  r.u_v = -piece * h * cubed_v;
  r.y_h = r.u_v;
  r.y_v = piece * (inverse - cubed_vv + c * n);
  // By the piece's length: directly, and through the weight below it.
  r.u_s = (r.u / piece - piece * h * w * cubed_v_k) / n;
  r.y_s = (r.y / piece + piece * w * (h * h * cubed_k + c * sum_k)) / n;
  return r;
}

struct Wheel {
  double radius = 0.0;  ///< of the drum
  double corner = 0.0;  ///< of the polygon's corners
  double side = 0.0;    ///< of the polygon: one link
  double tooth_rad = 0.0;
  double sense = 1.0;  ///< +1 over the top
};

Wheel wheel_of(const TrueMachine& m) {
  Wheel w;
  const double nominal = m.pitch_mm * m.teeth / (2.0 * std::numbers::pi);
  w.radius = nominal + m.wheel_radius_offset_mm;
  w.side = m.pitch_mm * w.radius / nominal;
  w.tooth_rad = 2.0 * std::numbers::pi / m.teeth;
  w.corner = w.side / (2.0 * std::sin(0.5 * w.tooth_rad));
  w.sense = m.over_top ? 1.0 : -1.0;
  return w;
}

/// Constants of a solution, shared by both chains.
struct Setting {
  const TrueMachine& m;
  Wheel wheel;
  double w = 0.0;
  double weight_n = 0.0;
  std::array<double, 2> reach{};  ///< axis to bit, horizontally
  std::array<double, 2> rise{};
};

struct Unknowns {
  double h = 0.0;
  double v = 0.0;
  std::array<double, 2> a{};
};

/// The two closing errors of one chain and their derivatives by its own H, V and a.
struct Closure {
  std::array<double, 2> error{};
  std::array<std::array<double, 3>, 2> by{};
};

struct Pull {
  double h, v;
};
Pull pull_of(const Setting& s, const Unknowns& q, int side) {
  if (side == 0) return {q.h + s.m.side_force_n, q.v};
  return {q.h, s.weight_n - q.v};
}

// Ring and chain, common to drum and teeth; includes the tension at the sprocket.
Closure hung(const Setting& s, Pull p, double free_mm, int pieces, int side) {
  const double rho = s.m.ring_radius_mm;
  const double ta = std::hypot(p.h, p.v);
  const double ta3 = ta * ta * ta;
  const double vb = p.v + s.w * free_mm;
  const double give = s.m.beam_give_mm_per_n;
  const Hang chain = hang(p.h, p.v, free_mm, pieces, s.w, s.m.compliance_per_n);
  const auto i = static_cast<std::size_t>(side);
  Closure r;
  r.error = {rho * p.h / ta + chain.u + give * p.h - s.reach[i],
             rho * p.v / ta + chain.y + give * vb - s.rise[i]};
  r.by[0] = {
      rho * p.v * p.v / ta3 + chain.u_h + give, -rho * p.h * p.v / ta3 + chain.u_v, chain.u_s};
  r.by[1] = {-rho * p.h * p.v / ta3 + chain.y_h,
             rho * p.h * p.h / ta3 + chain.y_v + give,
             chain.y_s + give * s.w};
  return r;
}

// a = S: the chain touches the drum at its own slope.
Closure on_drum(const Setting& s, Pull p, double free_mm, int pieces, int side) {
  Closure r = hung(s, p, free_mm, pieces, side);
  const double vb = p.v + s.w * free_mm;
  const double tb = std::hypot(p.h, vb);
  const double tb3 = tb * tb * tb;
  const double k = s.wheel.sense * s.wheel.radius;
  r.error[0] += k * vb / tb;
  r.error[1] -= k * p.h / tb;
  const double sin_h = -vb * p.h / tb3, sin_v = p.h * p.h / tb3;
  const double cos_h = vb * vb / tb3, cos_v = -p.h * vb / tb3;
  r.by[0][0] += k * sin_h;
  r.by[0][1] += k * sin_v;
  r.by[0][2] += k * sin_v * s.w;
  r.by[1][0] -= k * cos_h;
  r.by[1][1] -= k * cos_v;
  r.by[1][2] -= k * cos_v * s.w;
  return r;
}

// a = turn of the tooth: the chain pivots on that corner.
Closure on_tooth(const Setting& s, Pull p, double turn, int links, int side) {
  Closure r = hung(s, p, links * s.wheel.side, links * s.m.pieces_per_link, side);
  r.error[0] += s.wheel.sense * s.wheel.corner * std::sin(turn);
  r.error[1] -= s.wheel.corner * std::cos(turn);
  r.by[0][2] = s.wheel.sense * s.wheel.corner * std::cos(turn);
  r.by[1][2] = s.wheel.corner * std::sin(turn);
  return r;
}

// Gaussian elimination with row exchange; false where the matrix is singular.
bool solve4(std::array<std::array<double, 5>, 4>& m) {
  for (std::size_t c = 0; c < 4; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < 4; ++r) {
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    }
    if (!(std::abs(m[pivot][c]) > 1e-14)) return false;
    std::swap(m[c], m[pivot]);
    for (std::size_t r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double f = m[r][c] / m[c][c];
      for (std::size_t k = c; k < 5; ++k) m[r][k] -= f * m[c][k];
    }
  }
  for (std::size_t c = 0; c < 4; ++c) m[c][4] /= m[c][c];
  return true;
}

template <class ClosureOf>
bool newton(const Setting& s, Unknowns& q, const ClosureOf& closure_of, double largest_a_step) {
  for (int n = 0; n < 60; ++n) {
    std::array<std::array<double, 5>, 4> m{};
    for (int side = 0; side < 2; ++side) {
      const auto i = static_cast<std::size_t>(side);
      const Closure r = closure_of(pull_of(s, q, side), q.a[i], side);
      const double v_sign = side == 0 ? 1.0 : -1.0;
      for (std::size_t e = 0; e < 2; ++e) {
        auto& row = m[2 * i + e];
        row[0] = r.by[e][0];
        row[1] = v_sign * r.by[e][1];
        row[2 + i] = r.by[e][2];
        row[4] = -r.error[e];
      }
    }
    if (!solve4(m)) return false;
    double share = 1.0;
    const double h_smallest = std::min(q.h, q.h + s.m.side_force_n);
    if (m[0][4] < -0.8 * h_smallest) share = -0.8 * h_smallest / m[0][4];
    const double a_step = std::max(std::abs(m[2][4]), std::abs(m[3][4]));
    if (a_step * share > largest_a_step) share = largest_a_step / a_step;
    q.h += share * m[0][4];
    q.v += share * m[1][4];
    q.a[0] += share * m[2][4];
    q.a[1] += share * m[3][4];
    if (!(std::isfinite(q.h) && std::isfinite(q.v) && q.h > 0.0)) return false;
    const double step = std::abs(m[0][4]) / q.h + std::abs(m[1][4]) / s.weight_n + a_step;
    // Quadratic convergence: the error is the square of this.
    if (share == 1.0 && step < 1e-7) return true;
  }
  return false;
}

int pieces_for(const TrueMachine& m, double free_mm) {
  return std::max(1, static_cast<int>(std::ceil(free_mm / m.pitch_mm))) * m.pieces_per_link;
}

// Straight chains from the axes to the bit.
Unknowns straight_start(const Setting& s) {
  Unknowns q;
  std::array<double, 2> slope{};
  for (std::size_t i = 0; i < 2; ++i) {
    slope[i] = s.rise[i] / s.reach[i];
    q.a[i] = std::max(10.0, std::hypot(s.reach[i], s.rise[i]) - s.m.ring_radius_mm);
  }
  const double carried = s.weight_n + 0.5 * s.w * (q.a[0] + q.a[1]);
  q.h = std::max(0.5, (carried - s.m.side_force_n * slope[0]) / (slope[0] + slope[1]));
  q.v = (q.h + s.m.side_force_n) * slope[0] - 0.5 * s.w * q.a[0];
  return q;
}

ChainRest state(const Setting& s, Pull p, double free_mm) {
  const double vb = p.v + s.w * free_mm;
  return {free_mm, std::atan2(vb, p.h), std::hypot(p.h, vb), 0.0};
}

double turn_of(const Setting& s, double angle_rad) {
  return s.wheel.sense > 0.0 ? angle_rad : std::numbers::pi - angle_rad;
}

// The tooth that holds a chain is the nearest one to the chain's direction.
bool settle_on_teeth(const Setting& s, Unknowns q, Rest& rest) {
  std::array<int, 2> links{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double turn = turn_of(s, rest.chain[i].angle_rad);
    links[i] = static_cast<int>(std::lround(q.a[i] / s.wheel.side));
    q.a[i] = turn + (q.a[i] - links[i] * s.wheel.side) / s.wheel.radius;
  }
  for (int n = 0; n < 6; ++n) {
    const auto closure = [&](Pull p, double turn, int side) {
      return on_tooth(s, p, turn, links[static_cast<std::size_t>(side)], side);
    };
    if (!newton(s, q, closure, 0.5)) return false;
    bool converged = true;
    for (int side = 0; side < 2; ++side) {
      const auto i = static_cast<std::size_t>(side);
      rest.chain[i] = state(s, pull_of(s, q, side), links[i] * s.wheel.side);
      rest.chain[i].length_mm = rest.chain[i].free_mm + s.wheel.radius * q.a[i];
      const double beyond = q.a[i] - turn_of(s, rest.chain[i].angle_rad);
      if (std::abs(beyond) > 0.5 * s.wheel.tooth_rad * kSeat) {
        const int more = beyond > 0.0 ? 1 : -1;
        links[i] += more;
        q.a[i] -= more * s.wheel.tooth_rad;
        converged = false;
      }
    }
    if (converged) return true;
  }
  return false;
}

}  // namespace

std::optional<Rest> come_to_rest(const TrueMachine& machine, Vec2 bit, const Rest* near) {
  const double in_plane = kGravity * std::cos(machine.tilt_from_vertical_deg * std::numbers::pi / 180.0);
  Setting s{machine, wheel_of(machine), 0.0, 0.0, {}, {}};
  s.w = machine.chain_mass_kg_per_m * 1e-3 * in_plane;
  s.weight_n = machine.sled_mass_kg * in_plane;
  s.reach = {bit.x - machine.axis[0].x, machine.axis[1].x - bit.x};
  s.rise = {machine.axis[0].y - bit.y, machine.axis[1].y - bit.y};
  if (s.reach[0] <= 0.0 || s.reach[1] <= 0.0 || s.rise[0] + s.rise[1] <= 0.0) return std::nullopt;

  Unknowns q;
  if (near != nullptr) {
    q = {near->horizontal_right_n, near->vertical_left_n, near->drum_free_mm};
  } else {
    q = straight_start(s);
  }
  const std::array<int, 2> pieces{pieces_for(machine, q.a[0]), pieces_for(machine, q.a[1])};
  const auto closure = [&](Pull p, double free_mm, int side) {
    return on_drum(s, p, free_mm, pieces[static_cast<std::size_t>(side)], side);
  };
  if (!newton(s, q, closure, 500.0)) return std::nullopt;
  Rest rest;
  rest.horizontal_right_n = q.h;
  rest.vertical_left_n = q.v;
  rest.drum_free_mm = q.a;
  for (int side = 0; side < 2; ++side) {
    const auto i = static_cast<std::size_t>(side);
    if (!(q.a[i] > 0.0)) return std::nullopt;
    ChainRest& chain = rest.chain[i];
    chain = state(s, pull_of(s, q, side), q.a[i]);
    chain.length_mm = chain.free_mm + s.wheel.radius * turn_of(s, chain.angle_rad);
  }
  if (machine.wheel == WheelShape::teeth && !settle_on_teeth(s, q, rest)) return std::nullopt;
  return rest;
}

}  // namespace chaintrue::generator
