// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lines, arcs, cycles.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/gcode_witness/support/program_writer.hpp"

namespace chaintrue::witness {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace

void ProgramWriter::straight() {
  const bool rapid = random_.one_in(4);
  std::vector<std::string> words = motion(rapid ? "G0" : "G1");
  std::array<double, 3> to = somewhere();
  if (random_.one_in(2)) {
    for (std::size_t i = 0; i < 2; ++i) to[i] = place_[i] + random_.between(-10.0, 10.0);
  }
  const auto before = place_;
  bool any = false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (random_.one_in(i == 2 ? 2 : 4)) continue;
    words.push_back(axis(i, to[i], place_[i], random_.whole(0, 4)));
    any = true;
  }
  if (!any) words.push_back(axis(0, to[0], place_[0]));
  const double way =
      std::hypot(place_[0] - before[0], place_[1] - before[1], place_[2] - before[2]);
  if (!rapid) add_feed(words, way);
  line(std::move(words));
}

/// From the current position about a centre in the plane; a negative sweep is clockwise.
void ProgramWriter::arc_to(double centre_first, double centre_second, double sweep, bool whole,
                           int turns) {
  const Plane plane = axes();
  const bool clockwise = sweep < 0.0;
  std::vector<std::string> words = motion(clockwise ? "G2" : "G3");
  // The centre as rounded in its words.
  const double base_first = absolute_centres_ ? 0.0 : place_[plane.first];
  const double base_second = absolute_centres_ ? 0.0 : place_[plane.second];
  const double written_first = rounded(centre_first - base_first, 4);
  const double written_second = rounded(centre_second - base_second, 4);
  const double first = base_first + written_first;
  const double second = base_second + written_second;
  const double u = place_[plane.first] - first;
  const double v = place_[plane.second] - second;
  const double radius = std::hypot(u, v);
  const double c = std::cos(sweep);
  const double s = std::sin(sweep);
  if (!whole) {
    const double end_first = first + c * u - s * v;
    const double end_second = second + s * u + c * v;
    words.push_back(axis(plane.first, end_first, place_[plane.first], 4));
    words.push_back(axis(plane.second, end_second, place_[plane.second], 4));
  }
  if (absolute_centres_ || written_first != 0.0 || random_.one_in(2))
    words.push_back(length("IJK"[plane.first], written_first, 4));
  if (absolute_centres_ || written_second != 0.0 || words.back().front() != "IJK"[plane.first])
    words.push_back(length("IJK"[plane.second], written_second, 4));
  if (turns > 1) words.push_back(fmt::format("P{}", turns));
  if (random_.one_in(3)) {
    words.push_back(axis(plane.normal, place_[plane.normal] + random_.between(-4.0, 4.0),
                         place_[plane.normal]));
  }
  add_feed(words, radius * (std::fabs(sweep) + kTurn * (turns - 1)));
  line(std::move(words));
}

void ProgramWriter::arc_by_centre() {
  const Plane plane = axes();
  const double radius = random_.one_in(3) ? random_.between(0.3, 3.0) : random_.between(3.0, 60.0);
  // Towards the middle, so that the program stays in its area.
  const double inward = std::atan2(-place_[plane.second], -place_[plane.first]);
  const double towards = inward + random_.between(-1.0, 1.0);
  const double sweep = random_.one_in(5) ? 0.5 * kTurn : random_.between(0.02, 0.99) * kTurn;
  arc_to(place_[plane.first] + radius * std::cos(towards),
         place_[plane.second] + radius * std::sin(towards), random_.one_in(2) ? sweep : -sweep,
         false, random_.one_in(8) ? random_.whole(2, 3) : 1);
}

void ProgramWriter::whole_circle() {
  const Plane plane = axes();
  const double radius = random_.between(0.2, 20.0);
  const double towards = random_.between(0.0, kTurn);
  arc_to(place_[plane.first] + radius * std::cos(towards),
         place_[plane.second] + radius * std::sin(towards), random_.one_in(2) ? kTurn : -kTurn,
         true, random_.one_in(4) ? random_.whole(2, 4) : 1);
}

void ProgramWriter::arc_by_radius() {
  const Plane plane = axes();
  std::vector<std::string> words = motion(random_.one_in(2) ? "G2" : "G3");
  const double chord = random_.between(1.0, 40.0);
  const double towards =
      std::atan2(-place_[plane.second], -place_[plane.first]) + random_.between(-1.0, 1.0);
  const auto before = place_;
  for (const std::size_t i : {plane.first, plane.second}) {
    const double step = chord * (i == plane.first ? std::cos(towards) : std::sin(towards));
    words.push_back(axis(i, place_[i] + step, place_[i]));
  }
  const double half =
      0.5 * std::hypot(place_[0] - before[0], place_[1] - before[1], place_[2] - before[2]);
  const double radius = half * random_.between(1.02, 3.0) + 0.01;
  // The long arc of a large circle would leave the sheet.
  const bool is_long = radius < 60.0 && random_.one_in(4);
  words.push_back(length('R', is_long ? -radius : radius));
  if (random_.one_in(5)) {
    words.push_back(axis(plane.normal, place_[plane.normal] + random_.between(-4.0, 4.0),
                         place_[plane.normal]));
  }
  add_feed(words, 4.0 * half);
  line(std::move(words));
}

/// A row of one to four holes.
void ProgramWriter::cycle() {
  if (inverse_time_) inverse_time();
  const Plane plane = axes();
  std::vector<std::string> kinds = {"G81", "G82", "G83", "G73", "G85", "G89"};
  // Cycles that stop the spindle have words that differ between NIST and LinuxCNC.
  if (spindle_on_ && options_.scope == Scope::language) kinds.emplace_back("G86");
  const std::string kind =
      kinds[static_cast<std::size_t>(random_.whole(0, static_cast<int>(kinds.size()) - 1))];
  if (random_.one_in(3)) line({random_.any({"G98", "G99"})});
  const bool again = random_.one_in(5);
  const int holes = random_.whole(1, 4);
  const double depth = random_.decimal(1.0, 8.0, 2);
  const double height = random_.decimal(-2.0, 4.0, 2);
  for (int i = 0; i < holes; ++i) {
    std::vector<std::string> words;
    if (i == 0) words.push_back(kind);
    double ignored = 0.0;
    const auto to = somewhere();
    for (const std::size_t index : {plane.first, plane.second}) {
      const double there = incremental_ ? place_[index] + random_.between(-10.0, 10.0) : to[index];
      if (index == plane.first || random_.one_in(2)) words.push_back(axis(index, there, ignored));
    }
    if (i == 0 || random_.one_in(5)) {
      words.push_back(length("XYZ"[plane.normal], incremental_ ? -depth : height - depth));
      words.push_back(length('R', incremental_ ? random_.between(-1.0, 1.0) : height));
    }
    if (i == 0) {
      if (kind == "G82" || kind == "G86" || kind == "G89")
        words.push_back(number('P', random_.decimal(0.0, 1.0, 2), 2));
      if (kind == "G83" || kind == "G73") words.push_back(length('Q', random_.between(0.4, 3.0)));
    }
    if (again) words.push_back(fmt::format("L{}", random_.whole(1, 3)));
    line(std::move(words));
  }
  line({"G80"});
  motion_.clear();
  go_somewhere();
}

void ProgramWriter::machine_move() {
  if (incremental_) distance_mode();
  std::vector<std::string> words = {"G53", random_.any({"G0", "G1"})};
  motion_ = words.back();
  const auto to = somewhere();
  for (std::size_t i = 0; i < 2; ++i) words.push_back(length("XYZ"[i], rounded(to[i])));
  if (motion_ == "G1") add_feed(words, 50.0);
  line(std::move(words));
  go_somewhere();
}

void ProgramWriter::polar() {
  if (plane_ != 17) {
    plane_ = 17;
    line({"G17"});
  }
  go_somewhere();
  if (random_.one_in(3)) distance_mode();
  std::vector<std::string> words = motion(random_.any({"G0", "G1"}));
  if (!random_.one_in(3)) words.push_back(length('@', random_.between(5.0, 60.0)));
  if (words.empty() || words.back().front() != '@' || random_.one_in(2))
    words.push_back(number('^', random_.decimal(-180.0, 180.0, 1), 1));
  if (motion_ == "G1") add_feed(words, 50.0);
  line(std::move(words));
  go_somewhere();
}

void ProgramWriter::probe() {
  if (inverse_time_) inverse_time();
  go_somewhere();
  line({random_.any({"G38.2", "G38.3", "G38.4", "G38.5"}),
        axis(2, place_[2] + random_.between(2.0, 5.0), place_[2])});
  motion_.clear();
  probed_ = true;
  go_somewhere();
}

}  // namespace chaintrue::witness
