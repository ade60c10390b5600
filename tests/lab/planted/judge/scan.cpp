// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/scan.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <variant>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/observation/length_points.hpp"

namespace chaintrue::planted {
namespace {

using generator::Cause;
using generator::Dice;
using generator::Hidden;
using generator::Lengths;
using generator::Nature;
using generator::Visit;
using generator::Where;

constexpr std::size_t kDrawnMarks = 60;

generator::TrueMachine machine_of(const model::Machine& stated) {
  generator::TrueMachine m;
  m.axis = {{{stated.motors.left.x_mm, stated.motors.left.y_mm},
             {stated.motors.right.x_mm, stated.motors.right.y_mm}}};
  m.chain_zero_mm = {stated.chain_zero.left_mm, stated.chain_zero.right_mm};
  m.teeth = stated.sprocket.teeth;
  m.pitch_mm = stated.sprocket.pitch_mm;
  m.over_top = stated.feed == model::Feed::over_top;
  m.ring_radius_mm = std::get<model::Ring>(stated.attachment).radius_mm;
  m.chain_mass_kg_per_m = stated.chain.mass_kg_per_m;
  m.compliance_per_n = stated.chain.compliance_per_n;
  m.sled_mass_kg = stated.sled.mass_kg;
  m.tilt_from_vertical_deg = stated.frame.tilt_from_vertical_deg;
  return m;
}

std::vector<ReadMark> marks_of(const grid::MeasuredGrid& grid) {
  std::vector<ReadMark> marks;
  for (const auto& p : grid.points) {
    marks.push_back({{p.mark.x_mm, p.mark.y_mm}, {p.lengths->left_mm, p.lengths->right_mm}});
  }
  return marks;
}

generator::NoiseLevel noise_of(const grid::MeasuredGrid& grid) {
  return {grid.noise->length_mm, grid.noise->position_mm};
}

CalibratedSession calibrated(const Scan& scan, const grid::MeasuredGrid& grid) {
  return calibrate(scan.machine, marks_of(grid), noise_of(grid));
}

/// Numbered in an order drawn at random.
grid::MeasuredGrid some_of(const Scan& scan, std::size_t marks, Dice& dice) {
  grid::MeasuredGrid some = scan.grid;
  if (marks > some.points.size()) {
    throw std::runtime_error("the scan " + scan.name + " has fewer marks than are drawn");
  }
  dice.shuffle(some.points);
  some.points.resize(marks);
  for (std::size_t i = 0; i < marks; ++i) some.points[i].order = static_cast<int>(i);
  return some;
}

/// What a cause adds to the readings at the marks as they are written.
std::vector<Lengths> added_by(const CalibratedSession& session, const std::vector<ReadMark>& marks,
                              const Hidden& hidden) {
  const Hidden one[] = {hidden};
  std::vector<Visit> visits;
  for (const ReadMark& m : marks) {
    visits.push_back(
        {session.on_bed(generator::place_of(m.mark, one)), static_cast<int>(visits.size())});
  }
  const generator::TrueMachine machine = generator::altered(session.machine, one);
  const auto at_rest = generator::rests(machine, visits, &session.yardstick.at_rest());
  if (!at_rest) throw std::runtime_error("added_by: the machine cannot reach a mark");
  std::vector<Lengths> added = generator::readings(machine, one, visits, *at_rest);
  const std::vector<Lengths> plain = generator::readings(
      session.machine, {}, session.yardstick.visits(), session.yardstick.at_rest());
  for (std::size_t i = 0; i < added.size(); ++i) {
    for (std::size_t c = 0; c < 2; ++c) added[i][c] -= plain[i][c];
  }
  return added;
}

Hidden drawn_cause(const CalibratedSession& session, std::uint64_t seed, Dice& dice) {
  constexpr std::array kCauses = {
      Cause::chain_stretch, Cause::beam_flex,  Cause::sprocket_eccentricity,
      Cause::angular_kink,  Cause::zero_shift, Cause::drift,
      Cause::tape_scale};
  const Cause cause = kCauses[seed % kCauses.size()];
  for (int n = 0; n < 30; ++n) {
    const auto drawn = generator::draw_sized_effect(session.yardstick, cause, 8.0, 20.0, dice);
    if (!drawn) continue;
    // The scans' own banner is long along x.
    if (cause == Cause::tape_scale && drawn->hidden.where != Where::y) continue;
    return drawn->hidden;
  }
  throw std::runtime_error("drawn_cause: no size of " + std::string(generator::card(cause).id) +
                           " has the strength asked");
}

}  // namespace

Scan read_scan(const std::filesystem::path& scan, const std::filesystem::path& groundcontrol_ini) {
  grid::files::OpticalOptions options;
  options.machine = grid::files::read(grid::files::parse_groundcontrol, groundcontrol_ini,
                                      grid::files::Tolerances::unexplained)
                        .machine;
  Scan result{scan.stem().string(), machine_of(options.machine),
              grid::files::read(grid::files::parse_optical, scan, options)};
  result.grid.noise = grid::StatedNoise{0.1, 0.3, 12.0};
  const auto lengths = grid::length_points(result.grid);
  if (!lengths) throw std::runtime_error(lengths.error());
  for (std::size_t i = 0; i < lengths->size(); ++i) {
    result.grid.points[i].lengths = (*lengths)[i].lengths;
    result.grid.points[i].commanded.reset();
  }
  return result;
}

grid::diagnosis::Diagnosis diagnosed(const grid::MeasuredGrid& grid) {
  grid::diagnosis::DiagnosisOptions options;
  options.improvement = false;
  options.next_measurements = false;
  options.accept_class = true;
  auto found = grid::diagnosis::diagnose(grid, options);
  if (!found) throw std::runtime_error(found.error().sentence());
  return std::move(*found);
}

Reference make_reference(const Scan& scan) {
  // Enough for a field of four numbers; its likelihood costs the third power of the marks.
  constexpr std::size_t kFieldMarks = 160;
  Dice dice(0, "field");
  const grid::MeasuredGrid some =
      some_of(scan, std::min(kFieldMarks, scan.grid.points.size()), dice);
  return {scan.name, scan.grid.points.size(), likeliest_field(calibrated(scan, some)),
          claims_of(diagnosed(scan.grid))};
}

Draw draw_planted(const Scan& scan, const std::vector<Reference>& references, std::uint64_t seed) {
  Dice mark_dice(seed, "marks"), cause_dice(seed, "cause");
  Draw draw;
  draw.plain = some_of(scan, kDrawnMarks, mark_dice);
  const CalibratedSession session = calibrated(scan, draw.plain);
  draw.hidden = drawn_cause(session, seed, cause_dice);
  draw.with_order = generator::card(draw.hidden.cause).nature == Nature::of_order;
  const std::vector<Lengths> added = added_by(session, marks_of(draw.plain), draw.hidden);
  const generator::Signature signature = session.yardstick.signature_of_lengths(added);
  const SmoothField& field = reference_of(references, scan.name).field;
  draw.strength = strength_given(field, session, signature);
  if (!draw.with_order) {
    for (auto& point : draw.plain.points) point.order.reset();
  }
  draw.planted = draw.plain;
  for (std::size_t i = 0; i < added.size(); ++i) {
    draw.planted.points[i].lengths->left_mm += added[i][0];
    draw.planted.points[i].lengths->right_mm += added[i][1];
  }
  return draw;
}

}  // namespace chaintrue::planted
