// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_orders: leaves out the numbers of the visits in many sets with an effect of the visits, or with nothing, and
/// prints how often the order that the readings show is right. Not part of the test run; its table is in
/// docs/diagnosis_rates.md.
///
///   sealed_orders --sets 200 --threads 2
#include <fmt/format.h>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/command/campaign.hpp"

namespace {

using namespace chaintrue;
using generator::Cause;
using generator::Order;
using sealed::Outcome;

struct Kind {
  Order order;
  std::optional<Cause> cause;

  std::string name() const {
    return fmt::format("{}/{}", word(order), cause ? generator::card(*cause).id : "nothing");
  }
};

const Kind kKinds[] = {{Order::rows, Cause::direction_hysteresis},
                       {Order::columns, Cause::direction_hysteresis},
                       {Order::serpentine_rows, Cause::direction_hysteresis},
                       {Order::serpentine_columns, Cause::direction_hysteresis},
                       {Order::rows, Cause::drift},
                       {Order::serpentine_columns, Cause::drift},
                       {Order::random, Cause::direction_hysteresis},
                       {Order::serpentine_columns, std::nullopt}};

/// Facts: right, and sound where no other order than the right one is found.
Outcome run_order(const Kind& kind, std::uint64_t seed, std::uint64_t index) {
  constexpr int kPoints[] = {28, 60, 117};
  generator::Recipe recipe;
  recipe.kind = kind.cause ? generator::Mix::single : generator::Mix::nothing;
  recipe.points = kPoints[index % 3];
  recipe.order = kind.order;
  recipe.cause = kind.cause;
  const generator::SealedSet set = generator::draw_set(recipe, seed);
  grid::MeasuredGrid grid = grid::files::parse_grid(set.grid_text, "sealed.json").grid;
  for (grid::MeasuredPoint& point : grid.points) point.order.reset();
  const grid::Measured measured(grid);
  const auto session = grid::diagnosis::observations_of(measured);
  const auto analysis = grid::diagnosis::analyse(session.value(), {});
  const auto found = grid::diagnosis::find_visiting_order(measured, analysis.value());

  Outcome outcome{.kind = kind.name(), .seed = seed, .points = recipe.points};
  if (!set.answer.delta.empty()) outcome.strength = set.answer.delta.front();
  const bool is_right =
      found && kind.cause && kind.order != Order::random &&
      found->order.rows == (kind.order == Order::rows || kind.order == Order::serpentine_rows) &&
      found->order.serpentine ==
          (kind.order == Order::serpentine_rows || kind.order == Order::serpentine_columns);
  outcome.add("right", is_right);
  outcome.add("sound", is_right || !found);
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  sealed::Campaign campaign("How often the order of visits is found in the readings", argc, argv);
  const std::vector<sealed::RateRow> rows = sealed::rows_of("orders");
  return campaign.run(
      [&] { return campaign.sets_of(kinds_of(rows)); },
      [&](const sealed::PlannedSet& set) {
        const Kind& kind = *std::ranges::find(kKinds, set.kind, &Kind::name);
        return std::vector{run_order(kind, set.seed, set.seed - campaign.first_seed)};
      },
      rows);
}
