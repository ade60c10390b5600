// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The machine of NISTIR 6556: modes, coordinate systems, moves and cycles.
#include "tests/gcode_witness/follower/program_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "tests/gcode_witness/follower/program_reader.hpp"

namespace chaintrue::follower {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kInchMm = 25.4;
constexpr std::array<char, 3> kAxes = {'x', 'y', 'z'};
constexpr std::array<char, 3> kCentres = {'i', 'j', 'k'};

struct System {
  Place origin{};
  double turn_rad = 0.0;
};

class Machine {
 public:
  void run(const Line& line, std::size_t number);
  bool ended() const { return ended_; }
  std::vector<Piece> pieces;

 private:
  double mm(double value) const { return inches_ ? kInchMm * value : value; }
  System& system() { return systems_[system_]; }
  Place to_machine(const Place& program);
  Place to_program(const Place& machine);
  Place target(const Line& line);
  void set_modes(const Line& line);
  void offsets(const Line& line);
  void go(const Place& program, bool rapid);
  void add(std::vector<Place> places, bool rapid);
  void arc(const Line& line, bool clockwise);
  void cycle(const Line& line);
  void hole(Place at, double retract, double clear, double bottom);

  Place here_{};  // in the machine's frame
  std::array<System, 9> systems_{};
  std::size_t system_ = 0;
  Place offset_{};
  Place kept_offset_{};
  int motion_ = -1;
  int plane_ = 170;
  bool inches_ = false;
  bool incremental_ = false;
  bool absolute_centres_ = false;
  bool to_r_ = false;
  bool inverse_time_ = false;
  double feed_ = 0.0;
  bool ended_ = false;
  std::size_t number_ = 0;
  bool says_xy_ = false;
  // Kept for the following lines of a row of cycles.
  double row_start_ = 0.0;
  double row_r_ = 0.0;
  double row_bottom_ = 0.0;
  double row_q_ = 0.0;
};

bool is_cycle(int code) { return code == 730 || (code >= 810 && code <= 890); }

/// First and second axis of a plane, and the one across.
std::array<std::size_t, 3> plane_axes(int plane) {
  if (plane == 180) return {2, 0, 1};
  if (plane == 190) return {1, 2, 0};
  return {0, 1, 2};
}

Place Machine::to_machine(const Place& program) {
  const double x = program[0] + offset_[0];
  const double y = program[1] + offset_[1];
  const double c = std::cos(system().turn_rad);
  const double s = std::sin(system().turn_rad);
  const Place& origin = system().origin;
  return {origin[0] + c * x - s * y, origin[1] + s * x + c * y,
          origin[2] + program[2] + offset_[2]};
}

Place Machine::to_program(const Place& machine) {
  const Place& origin = system().origin;
  const double x = machine[0] - origin[0];
  const double y = machine[1] - origin[1];
  const double c = std::cos(system().turn_rad);
  const double s = std::sin(system().turn_rad);
  return {c * x + s * y - offset_[0], c * y - s * x - offset_[1],
          machine[2] - origin[2] - offset_[2]};
}

Place Machine::target(const Line& line) {
  Place to = to_program(here_);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!line.has(kAxes[i])) continue;
    to[i] = mm(line.value(kAxes[i], 0.0)) + (incremental_ ? to[i] : 0.0);
  }
  return to;
}

void Machine::add(std::vector<Place> places, bool rapid) {
  const double rate = inverse_time_ ? 0.0 : feed_;
  here_ = places.back();
  pieces.push_back({rapid, number_, rapid ? 0.0 : rate, std::move(places), says_xy_});
}

void Machine::go(const Place& program, bool rapid) { add({here_, to_machine(program)}, rapid); }

void Machine::set_modes(const Line& line) {
  if (line.has('f')) feed_ = mm(line.value('f', 0.0));
  for (const int code : line.g) {
    if (code >= 540 && code <= 590) system_ = static_cast<std::size_t>(code / 10 - 54);
    if (code >= 591 && code <= 593) system_ = static_cast<std::size_t>(code - 591 + 6);
    if (code == 170 || code == 180 || code == 190) plane_ = code;
    if (code == 200 || code == 210) inches_ = code == 200;
    if (code == 900 || code == 910) incremental_ = code == 910;
    if (code == 901 || code == 911) absolute_centres_ = code == 901;
    if (code == 930 || code == 940) inverse_time_ = code == 930;
    if (code == 980 || code == 990) to_r_ = code == 990;
    if (code >= 382 && code <= 385) throw std::runtime_error("probing");
  }
}

/// G10 L2, G92 and related codes.
void Machine::offsets(const Line& line) {
  for (const int code : line.g) {
    if (code == 100) {
      const auto p = static_cast<std::size_t>(std::lround(line.value('p', 0.0)));
      if (line.value('l', 0.0) != 2.0 || p > 9) throw std::runtime_error("G10 L2 P0 to P9 only");
      System& changed = p == 0 ? system() : systems_[p - 1];
      for (std::size_t i = 0; i < 3; ++i) {
        if (line.has(kAxes[i])) changed.origin[i] = mm(line.value(kAxes[i], 0.0));
      }
      if (line.has('r')) changed.turn_rad = line.value('r', 0.0) * kTurn / 360.0;
    } else if (code == 920) {
      const Place program = to_program(here_);
      for (std::size_t i = 0; i < 3; ++i) {
        if (line.has(kAxes[i])) offset_[i] += program[i] - mm(line.value(kAxes[i], 0.0));
      }
      kept_offset_ = offset_;
    } else if (code == 921) {
      offset_ = kept_offset_ = {};
    } else if (code == 922) {
      offset_ = {};
    } else if (code == 923) {
      offset_ = kept_offset_;
    }
  }
}

void Machine::arc(const Line& line, bool clockwise) {
  const auto [a, b, n] = plane_axes(plane_);
  const Place start = to_program(here_);
  const Place end = target(line);
  double ca = 0.0;
  double cb = 0.0;
  if (line.has('r')) {
    const double radius = mm(line.value('r', 0.0));
    const double da = end[a] - start[a];
    const double db = end[b] - start[b];
    const double chord = std::hypot(da, db);
    const double height = std::sqrt(std::max(0.0, radius * radius - 0.25 * chord * chord));
    // The centre of a short counter-clockwise arc is to the left of the chord.
    const double side = (clockwise == (radius > 0.0) ? -1.0 : 1.0) * height / chord;
    ca = 0.5 * (start[a] + end[a]) - side * db;
    cb = 0.5 * (start[b] + end[b]) + side * da;
  } else {
    ca = mm(line.value(kCentres[a], 0.0)) + (absolute_centres_ ? 0.0 : start[a]);
    cb = mm(line.value(kCentres[b], 0.0)) + (absolute_centres_ ? 0.0 : start[b]);
  }
  const double from = std::atan2(start[b] - cb, start[a] - ca);
  double sweep = std::atan2(end[b] - cb, end[a] - ca) - from;
  const double whole = clockwise ? -kTurn : kTurn;
  // An end within rounding of the start makes a whole turn.
  constexpr double kSameRad = 5e-7;
  while (clockwise ? sweep >= -kSameRad : sweep <= kSameRad) sweep += whole;
  while (std::fabs(sweep) > kTurn + kSameRad) sweep -= whole;
  sweep += whole * (std::round(line.value('p', 1.0)) - 1.0);
  const double r0 = std::hypot(start[a] - ca, start[b] - cb);
  const double r1 = std::hypot(end[a] - ca, end[b] - cb);
  // Sagitta r (1 - cos(h/2)) <= r h^2 / 8.
  const double step = std::sqrt(8.0 * kChordMm / std::max({r0, r1, 1e-3}));
  const int count = std::max(8, static_cast<int>(std::ceil(std::fabs(sweep) / step)));
  std::vector<Place> places = {here_};
  for (int i = 1; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    Place place{};
    const double radius = r0 + t * (r1 - r0);
    place[a] = ca + radius * std::cos(from + t * sweep);
    place[b] = cb + radius * std::sin(from + t * sweep);
    place[n] = start[n] + t * (end[n] - start[n]);
    places.push_back(to_machine(i == count ? end : place));
  }
  add(std::move(places), false);
}

/// Down and up again; pecks of G83 and G73 retrace the hole.
void Machine::hole(Place at, double retract, double clear, double bottom) {
  const std::size_t n = plane_axes(plane_)[2];
  constexpr double kPeckClearanceMm = 0.254;  // LinuxCNC's G83_RAPID_DELTA
  if (motion_ == 830 || motion_ == 730) {
    for (double depth = retract - row_q_; depth > bottom; depth -= row_q_) {
      at[n] = depth;
      go(at, false);
      if (motion_ == 830) {
        at[n] = retract;
        go(at, true);
      }
      at[n] = depth + kPeckClearanceMm;
      go(at, true);
    }
  }
  at[n] = bottom;
  go(at, false);
  const bool feeds_out = motion_ == 850 || motion_ == 890;
  if (motion_ == 850) {
    at[n] = retract;
    go(at, false);
  }
  at[n] = clear;
  go(at, !feeds_out || motion_ == 850);
}

void Machine::cycle(const Line& line) {
  const auto [a, b, n] = plane_axes(plane_);
  Place at = to_program(here_);
  if (line.has('r')) row_r_ = mm(line.value('r', 0.0));
  if (line.has(kAxes[n])) row_bottom_ = mm(line.value(kAxes[n], 0.0));
  if (line.has('q')) row_q_ = mm(line.value('q', 0.0));
  const double retract = incremental_ ? row_start_ + row_r_ : row_r_;
  const double bottom = incremental_ ? retract + row_bottom_ : row_bottom_;
  const double clear = to_r_ ? retract : std::max(row_start_, retract);
  if (row_start_ < retract) {
    at[n] = retract;
    go(at, true);
  }
  const double step_a = mm(line.value(kAxes[a], 0.0));
  const double step_b = mm(line.value(kAxes[b], 0.0));
  for (long count = std::lround(line.value('l', 1.0)); count > 0; --count) {
    if (incremental_) {
      at[a] += step_a;
      at[b] += step_b;
    } else {
      if (line.has(kAxes[a])) at[a] = step_a;
      if (line.has(kAxes[b])) at[b] = step_b;
    }
    go(at, true);
    at[n] = retract;
    go(at, true);
    hole(at, retract, clear, bottom);
    at[n] = clear;
  }
}

void Machine::run(const Line& line, std::size_t number) {
  number_ = number;
  set_modes(line);
  bool axes_used = false;
  bool absolute = false;
  int motion = motion_;
  for (const int code : line.g) {
    axes_used = axes_used || code == 100 || code == 920;
    absolute = absolute || code == 530;
    if (code <= 30 || code == 800 || is_cycle(code)) motion = code;
    if (code == 40 || code == 100 || code >= 400) continue;
    if (code > 30 && code != 170 && code != 180 && code != 190 && code != 200 && code != 210)
      throw std::runtime_error("a G code that is not followed");
  }
  offsets(line);
  if (is_cycle(motion) && !is_cycle(motion_)) row_start_ = to_program(here_)[plane_axes(plane_)[2]];
  motion_ = motion;
  const bool centre = line.has('i') || line.has('j') || line.has('k');
  const bool moves = line.has('x') || line.has('y') || line.has('z') || centre;
  if (moves && !axes_used) {
    says_xy_ =
        line.has('x') || line.has('y') || motion_ == 20 || motion_ == 30 || is_cycle(motion_);
    if (absolute) {
      Place to = here_;
      for (std::size_t i = 0; i < 3; ++i) {
        if (line.has(kAxes[i])) to[i] = mm(line.value(kAxes[i], 0.0));
      }
      add({here_, to}, motion_ == 0);
    } else if (motion_ == 0 || motion_ == 10) {
      go(target(line), motion_ == 0);
    } else if (motion_ == 20 || motion_ == 30) {
      arc(line, motion_ == 20);
    } else if (is_cycle(motion_)) {
      cycle(line);
    } else {
      throw std::runtime_error("axis words without a motion");
    }
  }
  for (const int code : line.m) ended_ = ended_ || code == 2 || code == 30;
}

}  // namespace

std::vector<Piece> program_path(const std::string& program) {
  Machine machine;
  Reader reader;
  std::istringstream lines(program);
  std::size_t number = 0;
  for (std::string text; !machine.ended() && std::getline(lines, text);) {
    ++number;
    if (text.starts_with("%")) continue;
    try {
      machine.run(reader.read(text), number);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("line " + std::to_string(number) + ": " + error.what());
    }
  }
  return std::move(machine.pieces);
}

std::vector<Place> joined(const std::vector<Piece>& pieces) {
  std::vector<Place> path;
  for (const Piece& piece : pieces) {
    if (path.empty() && !piece.says_xy) continue;
    if (path.empty() && piece.rapid) {
      path.push_back(piece.places.back());
      continue;
    }
    for (const Place& place : piece.places) {
      if (path.empty() || path.back() != place) path.push_back(place);
    }
  }
  return path;
}

}  // namespace chaintrue::follower
