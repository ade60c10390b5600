// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: rest.hpp. Unknowns: H of the right chain, V of the left, and per chain `a`: its free
// length on the drum, or the turn of the tooth it leaves on the polygon. Slopes are differences.
#include "generator/hidden/rest.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::generator {
namespace {

constexpr double kGravity = 9.80665;
// A slack chain bends within a link: near a tie either tooth is accepted.
constexpr double kSeat = 1.01;

struct Pull {
  double h, v;
};

// The pieces, one after another, from the ring up: where the chain ends.
Eigen::Vector2d hang(Pull p, double free_mm, int pieces, double w, double c) {
  const double piece = free_mm / pieces;
  Eigen::Vector2d end = Eigen::Vector2d::Zero();
  for (int k = 0; k < pieces; ++k) {
    const Eigen::Vector2d pull(p.h, p.v + w * piece * (k + 0.5));
    end += piece * (1.0 / pull.norm() + c) * pull;
  }
  return end;
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

/// H, V, and `a` of the left and of the right chain.
using Unknowns = Eigen::Vector4d;

Pull pull_of(const Setting& s, const Unknowns& q, int side) {
  if (side == 0) return {q[0] + s.m.side_force_n, q[1]};
  return {q[0], s.weight_n - q[1]};
}

// The closing error of ring and chain, common to drum and teeth.
Eigen::Vector2d hung(const Setting& s, Pull p, double free_mm, int pieces, int side) {
  const auto i = static_cast<std::size_t>(side);
  const Eigen::Vector2d at_ring(p.h, p.v), at_sprocket(p.h, p.v + s.w * free_mm);
  return s.m.ring_radius_mm * at_ring.normalized() +
         hang(p, free_mm, pieces, s.w, s.m.compliance_per_n) +
         s.m.beam_give_mm_per_n * at_sprocket - Eigen::Vector2d(s.reach[i], s.rise[i]);
}

// a = S: the chain touches the drum at its own slope.
Eigen::Vector2d on_drum(const Setting& s, Pull p, double free_mm, int pieces, int side) {
  const Eigen::Vector2d along = Eigen::Vector2d(p.h, p.v + s.w * free_mm).normalized();
  return hung(s, p, free_mm, pieces, side) +
         s.wheel.sense * s.wheel.radius * Eigen::Vector2d(along.y(), -along.x());
}

// a = turn of the tooth: the chain pivots on that corner.
Eigen::Vector2d on_tooth(const Setting& s, Pull p, double turn, int links, int side) {
  return hung(s, p, links * s.wheel.side, links * s.m.pieces_per_link, side) +
         s.wheel.corner * Eigen::Vector2d(s.wheel.sense * std::sin(turn), -std::cos(turn));
}

template <class ErrorOf>
bool newton(const Setting& s, Unknowns& q, const ErrorOf& error_of, double largest_a_step) {
  // Of the differences: the slope is good to a millionth, and so is the last step.
  constexpr double kStep = 1e-6;
  const auto errors = [&](const Unknowns& at) {
    Eigen::Vector4d both;
    for (int side = 0; side < 2; ++side)
      both.segment<2>(2 * side) = error_of(pull_of(s, at, side), at[2 + side], side);
    return both;
  };
  for (int n = 0; n < 60; ++n) {
    const Eigen::Vector4d here = errors(q);
    Eigen::Matrix4d slope;
    for (Eigen::Index k = 0; k < 4; ++k) {
      Unknowns aside = q;
      aside[k] += kStep * std::max(std::abs(q[k]), 1.0);
      slope.col(k) = (errors(aside) - here) / (aside[k] - q[k]);
    }
    const Unknowns step = slope.partialPivLu().solve(-here);
    double share = 1.0;
    const double h_smallest = std::min(q[0], q[0] + s.m.side_force_n);
    if (step[0] < -0.8 * h_smallest) share = -0.8 * h_smallest / step[0];
    const double a_step = step.tail<2>().cwiseAbs().maxCoeff();
    if (a_step * share > largest_a_step) share = largest_a_step / a_step;
    q += share * step;
    if (!(q.allFinite() && q[0] > 0.0)) return false;
    if (share == 1.0 && std::abs(step[0]) / q[0] + std::abs(step[1]) / s.weight_n + a_step < 1e-7)
      return true;
  }
  return false;
}

int pieces_for(const TrueMachine& m, double free_mm) {
  return std::max(1, static_cast<int>(std::ceil(free_mm / m.pitch_mm))) * m.pieces_per_link;
}

// Straight chains from the axes to the bit.
Unknowns straight_start(const Setting& s) {
  std::array<double, 2> slope{}, a{};
  for (std::size_t i = 0; i < 2; ++i) {
    slope[i] = s.rise[i] / s.reach[i];
    a[i] = std::max(10.0, std::hypot(s.reach[i], s.rise[i]) - s.m.ring_radius_mm);
  }
  const double carried = s.weight_n + 0.5 * s.w * (a[0] + a[1]);
  const double h = std::max(0.5, (carried - s.m.side_force_n * slope[0]) / (slope[0] + slope[1]));
  return {h, (h + s.m.side_force_n) * slope[0] - 0.5 * s.w * a[0], a[0], a[1]};
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
    double& a = q[2 + static_cast<Eigen::Index>(i)];
    links[i] = static_cast<int>(std::lround(a / s.wheel.side));
    a = turn_of(s, rest.chain[i].angle_rad) + (a - links[i] * s.wheel.side) / s.wheel.radius;
  }
  for (int n = 0; n < 6; ++n) {
    const auto error = [&](Pull p, double turn, int side) {
      return on_tooth(s, p, turn, links[static_cast<std::size_t>(side)], side);
    };
    if (!newton(s, q, error, 0.5)) return false;
    bool converged = true;
    for (int side = 0; side < 2; ++side) {
      const auto i = static_cast<std::size_t>(side);
      rest.chain[i] = state(s, pull_of(s, q, side), links[i] * s.wheel.side);
      rest.chain[i].length_mm = rest.chain[i].free_mm + s.wheel.radius * q[2 + side];
      const double beyond = q[2 + side] - turn_of(s, rest.chain[i].angle_rad);
      if (std::abs(beyond) > 0.5 * s.wheel.tooth_rad * kSeat) {
        const int more = beyond > 0.0 ? 1 : -1;
        links[i] += more;
        q[2 + side] -= more * s.wheel.tooth_rad;
        converged = false;
      }
    }
    if (converged) return true;
  }
  return false;
}

}  // namespace

std::optional<Rest> come_to_rest(const TrueMachine& machine, Vec2 bit, const Rest* near) {
  const double in_plane =
      kGravity * std::cos(machine.tilt_from_vertical_deg * std::numbers::pi / 180.0);
  Setting s{machine, wheel_of(machine), 0.0, 0.0, {}, {}};
  s.w = machine.chain_mass_kg_per_m * 1e-3 * in_plane;
  s.weight_n = machine.sled_mass_kg * in_plane;
  s.reach = {bit.x - machine.axis[0].x, machine.axis[1].x - bit.x};
  s.rise = {machine.axis[0].y - bit.y, machine.axis[1].y - bit.y};
  if (s.reach[0] <= 0.0 || s.reach[1] <= 0.0 || s.rise[0] + s.rise[1] <= 0.0) return std::nullopt;

  Unknowns q = near != nullptr ? Unknowns(near->horizontal_right_n, near->vertical_left_n,
                                          near->drum_free_mm[0], near->drum_free_mm[1])
                               : straight_start(s);
  const std::array<int, 2> pieces{pieces_for(machine, q[2]), pieces_for(machine, q[3])};
  const auto error = [&](Pull p, double free_mm, int side) {
    return on_drum(s, p, free_mm, pieces[static_cast<std::size_t>(side)], side);
  };
  if (!newton(s, q, error, 500.0)) return std::nullopt;
  Rest rest;
  rest.horizontal_right_n = q[0];
  rest.vertical_left_n = q[1];
  rest.drum_free_mm = {q[2], q[3]};
  for (int side = 0; side < 2; ++side) {
    const auto i = static_cast<std::size_t>(side);
    if (!(q[2 + side] > 0.0)) return std::nullopt;
    ChainRest& chain = rest.chain[i];
    chain = state(s, pull_of(s, q, side), q[2 + side]);
    chain.length_mm = chain.free_mm + s.wheel.radius * turn_of(s, chain.angle_rad);
  }
  if (machine.wheel == WheelShape::teeth && !settle_on_teeth(s, q, rest)) return std::nullopt;
  return rest;
}

}  // namespace chaintrue::generator
