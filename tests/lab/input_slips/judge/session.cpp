// SPDX-License-Identifier: GPL-3.0-or-later
#include "input_slips/judge/session.hpp"

#include <cmath>
#include <stdexcept>

#include "generator/hidden/belt_draw.hpp"
#include "generator/hidden/draw.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/observation/length_points.hpp"
#include "sealed/judge/holes_trial.hpp"

namespace chaintrue::slips {
namespace {

using generator::Cause;
using generator::Dice;
using generator::Hidden;
using generator::TrueMachine;
using generator::Vec2;
using generator::Where;

double rounded(double value, double to) { return std::round(value / to) * to; }

generator::Recipe recipe_of(std::uint64_t seed) {
  generator::Recipe recipe;
  recipe.kind = seed % 2 == 0 ? generator::Mix::nothing : generator::Mix::single;
  recipe.other_machines = true;
  return recipe;
}

grid::MeasuredGrid lengths_of(std::uint64_t seed) {
  grid::MeasuredGrid grid =
      grid::files::parse_grid(generator::draw_set(recipe_of(seed), seed).grid_text, "drawn").grid;
  for (grid::MeasuredPoint& point : grid.points) {
    point.mark = {rounded(point.mark.x_mm, 0.1), rounded(point.mark.y_mm, 0.1)};
    point.lengths = {rounded(point.lengths->left_mm, 0.1), rounded(point.lengths->right_mm, 0.1)};
  }
  return grid;
}

std::vector<Hidden> usual_effect(std::uint64_t seed) {
  if (seed % 2 == 0) return {};
  constexpr double kElongation = 0.001;
  return {{Cause::chain_pitch_error, seed % 4 == 1 ? Where::left : Where::right, kElongation, 0.0}};
}

/// Marks commanded on a raster, with six second visits, where the hidden machine comes to rest.
grid::MeasuredGrid commands_of(std::uint64_t seed) {
  Dice dice(seed, "commands");
  const TrueMachine truth = generator::with_settings_off({}, 1.0, dice);
  const generator::HiddenMachine machine(TrueMachine{}, truth, usual_effect(seed));
  grid::MeasuredGrid grid;
  grid.name = "commanded";
  grid.machine = model::Machine{};
  generator::Layout layout = generator::layout_of(28);
  layout.half_width_mm = rounded(dice.uniform(950.0, 1150.0), 10.0);
  layout.half_height_mm = rounded(dice.uniform(420.0, 550.0), 10.0);
  for (const auto& visit :
       generator::plan_visits(layout, generator::Order::serpentine_rows, dice)) {
    grid::MeasuredPoint point;
    point.commanded = {rounded(visit.place.x, 10.0), rounded(visit.place.y, 10.0)};
    point.order = static_cast<int>(grid.points.size());
    grid.points.push_back(point);
  }
  const auto paid_out = grid::length_points(grid);
  if (!paid_out) throw std::runtime_error("commands_of: " + paid_out.error());
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const model::BedPoint near = *grid.points[i].commanded;
    const Vec2 place =
        sealed::place_reached(machine, (*paid_out)[i].lengths, {near.x_mm, near.y_mm});
    grid.points[i].mark = {rounded(place.x + 0.4 * dice.normal(), 0.1),
                           rounded(place.y + 0.4 * dice.normal(), 0.1)};
  }
  return grid;
}

grid::MeasuredHoles holes_of(std::uint64_t seed) {
  grid::MeasuredHoles set = sealed::cut_holes(usual_effect(seed), seed).set;
  for (grid::HoleDistance& distance : set.distances)
    distance.distance_mm = rounded(distance.distance_mm, 0.5);
  return set;
}

/// The anchors as taped by their owner, commands for a frame with these, and a taped diagonal.
grid::MeasuredBelts belts_of(std::uint64_t seed) {
  generator::BeltRecipe recipe;
  recipe.nothing = seed % 2 == 0;
  recipe.effect = recipe.nothing ? "" : "belt_scale";
  const generator::BeltDraw draw = generator::draw_belts(recipe, seed);
  Dice dice(seed, "belts");
  grid::MeasuredBelts belts;
  belts.machine.lengths = model::BeltLengths::belt;
  belts.machine.anchors_known = true;
  const auto taped = [&](std::size_t i) {
    const auto& a = draw.frame.anchors[i];
    return model::Anchor{a[0] + (i == 2 ? 0.0 : 10.0 * dice.normal()),
                         a[1] + (i >= 2 ? 0.0 : 10.0 * dice.normal()), a[2]};
  };
  belts.machine.anchors = {taped(0), taped(1), taped(2), taped(3)};
  int order = 0;
  for (const generator::FourLengths& read : draw.lengths_mm) {
    grid::BeltPoint point;
    point.lengths_mm = {rounded(read[0], 0.01), rounded(read[1], 0.01), rounded(read[2], 0.01),
                        rounded(read[3], 0.01)};
    point.order = order++;
    belts.points.push_back(std::move(point));
  }
  const auto fit = grid::fit_belts(belts);
  if (!fit) throw std::runtime_error("belts_of: " + fit.error().sentence());
  const model::FramePoint centre = model::centre_of(belts.machine);
  for (std::size_t i = 0; i < belts.points.size(); ++i) {
    belts.points[i].commanded = model::BedPoint{rounded(fit->places[i].at.x_mm - centre.x_mm, 1.0),
                                                rounded(fit->places[i].at.y_mm - centre.y_mm, 1.0)};
  }
  const auto span = [&](std::size_t a, std::size_t b) {
    const auto& from = draw.frame.anchors[a];
    const auto& to = draw.frame.anchors[b];
    return std::hypot(from[0] - to[0], from[1] - to[1]);
  };
  belts.distances.push_back(
      {model::Belt::tl, model::Belt::br, rounded(span(0, 3) + dice.normal(), 1.0), 1.0});
  return belts;
}

}  // namespace

std::string_view word(Way way) {
  switch (way) {
    case Way::commands:
      return "commands";
    case Way::lengths:
      return "lengths";
    case Way::holes:
      return "holes";
    case Way::belts:
      break;
  }
  return "belts";
}

Session clean_session(Way way, std::uint64_t seed) {
  switch (way) {
    case Way::commands:
      return commands_of(seed);
    case Way::lengths:
      return lengths_of(seed);
    case Way::holes:
      return holes_of(seed);
    case Way::belts:
      break;
  }
  return belts_of(seed);
}

namespace {

/// An unknown hook is not stated.
std::string without_tape_zero(std::string text) {
  const std::size_t from = text.find("\"hook_offset_mm\"");
  if (from == std::string::npos) return text;
  std::size_t to = text.find_first_of(",}", from);
  if (text[to] == ',') return text.erase(from, to + 1 - from);
  const std::size_t comma = text.rfind(',', from);
  return text.erase(comma, to - comma);
}

}  // namespace

Reported reported_of(const Session& session) {
  Reported reported;
  const auto take = [&](const std::vector<grid::files::Warning>& warnings) {
    for (const auto& warning : warnings) reported.messages.push_back(warning.message());
  };
  try {
    if (const auto* grid = std::get_if<grid::MeasuredGrid>(&session)) {
      take(grid::files::parse_grid(grid::files::write_grid(*grid), "file").warnings);
    } else if (const auto* set = std::get_if<grid::MeasuredHoles>(&session)) {
      take(grid::files::parse_holes(without_tape_zero(grid::files::write_holes(*set)), "file")
               .warnings);
    } else {
      const auto& belts = std::get<grid::MeasuredBelts>(session);
      take(grid::files::parse_belts(grid::files::write_belts(belts), "file").warnings);
    }
  } catch (const grid::files::InputError& error) {
    reported.is_refused = true;
    for (const auto& problem : error.problems()) reported.messages.push_back(problem.message());
  }
  return reported;
}

}  // namespace chaintrue::slips
