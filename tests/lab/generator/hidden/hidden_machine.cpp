// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "generator/hidden/draw.hpp"

namespace chaintrue::generator {

HiddenMachine::HiddenMachine(TrueMachine stated, TrueMachine truth, std::vector<Hidden> hidden)
    : stated_(stated), truth_(truth), hidden_(std::move(hidden)) {}

std::optional<std::vector<Lengths>> HiddenMachine::exact(std::span<const Visit> visits) const {
  const TrueMachine with = altered(truth_, hidden_);
  std::vector<Visit> where(visits.begin(), visits.end());
  if (disturbance_ && disturbance_->moves_tool) {
    // Its argument is the place where the mark is.
    const auto at_marks = rests(with, where);
    if (!at_marks) return std::nullopt;
    const std::vector<Site> sites = sites_of(where, *at_marks);
    for (std::size_t i = 0; i < where.size(); ++i) {
      const Vec2 moved = disturbance_->at(sites[i]);
      where[i].place = {where[i].place.x + moved.x, where[i].place.y + moved.y};
    }
  }
  const auto at_rest = rests(with, where);
  if (!at_rest) return std::nullopt;
  std::vector<Lengths> read = readings(with, hidden_, where, *at_rest);
  if (disturbance_ && !disturbance_->moves_tool) {
    const std::vector<Site> sites = sites_of(where, *at_rest);
    for (std::size_t i = 0; i < read.size(); ++i) {
      const Vec2 extra = disturbance_->at(sites[i]);
      read[i][0] += extra.x;
      read[i][1] += extra.y;
    }
  }
  return read;
}

std::optional<HiddenMachine::Note> HiddenMachine::measure(Vec2 mark, NoiseLevel noise, Dice& dice) {
  const int number = visits_.empty() ? 0 : visits_.back().number + 1;
  std::vector<Visit> all = visits_;
  all.push_back({place_of(mark, hidden_), number});
  const auto read = exact(all);
  if (!read) return std::nullopt;
  visits_ = std::move(all);
  Note note;
  note.number = number;
  note.mark = {mark.x + noise.position_mm * dice.normal(),
               mark.y + noise.position_mm * dice.normal()};
  for (std::size_t c = 0; c < 2; ++c) {
    note.lengths[c] = read->back()[c] + noise.length_mm * dice.normal();
  }
  return note;
}

std::optional<HiddenMachine::Reading> HiddenMachine::read(std::string_view what,
                                                          std::string_view side, Dice& dice) const {
  const TrueMachine with = altered(truth_, hidden_);
  const auto noisy = [&](double value, double sigma) {
    return Reading{value + sigma * dice.normal(), sigma};
  };
  if (what == "motor_spacing_mm") return noisy(with.axis[1].x - with.axis[0].x, 1.0);
  if (what == "beam_rise_mm") return noisy(with.axis[1].y - with.axis[0].y, 1.0);
  if (what == "ring_radius_mm") return noisy(with.ring_radius_mm, 0.3);
  if (what == "sled_mass_kg") return noisy(with.sled_mass_kg, 0.1);
  if (what == "chain_mass_kg_per_m") return noisy(with.chain_mass_kg_per_m, 0.002);
  if (what == "tape_error_mm_per_m") {
    double scale = 0.0;
    for (const Hidden& e : hidden_) {
      const bool other =
          (e.where == Where::x && side == "y") || (e.where == Where::y && side == "x");
      if (e.cause == Cause::tape_scale && !other) scale += e.size;
    }
    return noisy(1000.0 * scale, 0.15);
  }
  if (what == "link_pitch_mm") {
    const std::size_t chain = side == "right" ? 1 : 0;
    double elongation = 0.0;
    for (const Hidden& e : hidden_) {
      if (e.cause != Cause::chain_pitch_error) continue;
      const bool other =
          (e.where == Where::left && chain == 1) || (e.where == Where::right && chain == 0);
      if (!other) elongation += e.size;
    }
    return noisy(with.pitch_mm * (1.0 + elongation), 0.001);
  }
  return std::nullopt;
}

std::vector<Visit> fresh_session(const HiddenMachine& machine, double shift_mm, Dice& dice) {
  std::vector<Visit> fresh = machine.visits();
  const TrueMachine with = altered(machine.truth(), machine.hidden());
  for (Visit& v : fresh) {
    const Vec2 place{std::clamp(v.place.x + dice.uniform(-shift_mm, shift_mm), -1200.0, 1200.0),
                     std::clamp(v.place.y + dice.uniform(-shift_mm, shift_mm), -600.0, 600.0)};
    if (come_to_rest(with, place)) v.place = place;
  }
  return fresh;
}

std::vector<Visit> area_session(const HiddenMachine& machine, Dice& dice) {
  constexpr int kColumns = 14;
  constexpr int kRows = 8;
  Vec2 low = machine.visits().front().place;
  Vec2 high = low;
  for (const Visit& v : machine.visits()) {
    low = {std::min(low.x, v.place.x), std::min(low.y, v.place.y)};
    high = {std::max(high.x, v.place.x), std::max(high.y, v.place.y)};
  }
  const TrueMachine with = altered(machine.truth(), machine.hidden());
  std::vector<Visit> fresh;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const double x = (i + dice.uniform(0.0, 1.0)) / kColumns;
      const double y = (j + dice.uniform(0.0, 1.0)) / kRows;
      Visit v = machine.visits().front();
      v.place = {low.x + x * (high.x - low.x), low.y + y * (high.y - low.y)};
      v.number = j * kColumns + i;
      if (come_to_rest(with, v.place)) fresh.push_back(v);
    }
  }
  return fresh;
}

}  // namespace chaintrue::generator
