// SPDX-License-Identifier: GPL-3.0-or-later
// The whole fit and the map's queries. 28 points are a usual grid, 91 a large one.
#include <span>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/map/query_points.hpp"
#include "grid/synthetic/generator.hpp"
#include "tools/bench/work.hpp"

namespace {

using namespace chaintrue;

grid::MeasuredGrid grid_of(int columns, int rows) {
  grid::synthetic::SyntheticSpec spec;
  spec.design.columns = columns;
  spec.design.rows = rows;
  spec.jitter_mm = 8.0;
  spec.noise.length_mm = 0.2;
  spec.noise.position_mm = 0.3;
  spec.draw_settings = true;
  return grid::synthetic::generate(model::Machine{}, spec).value().grid;
}

/// One place after the other, along a line.
template <class Ask>
auto place_by_place(Ask ask) {
  return [ask](const benchmark::State&) {
    return [ask, map = grid::fit(grid_of(7, 4)).value(), x = -1000.0]() mutable {
      const model::MarkPoint place{x, 0.25 * x};
      x = x < 1000.0 ? x + 1.0 : -1000.0;
      return ask(map, place);
    };
  };
}

/// A thousand places at once, as in compensating or drawing a program.
template <class Answer>
auto thousand_places(void (*ask)(const grid::CompensationMap&, std::span<const model::MarkPoint>,
                                 std::span<Answer>)) {
  return [ask](const benchmark::State&) {
    std::vector<model::MarkPoint> places;
    for (int i = 0; i < 1000; ++i) places.push_back({2.0 * i - 1000.0, 0.5 * i - 250.0});
    return [ask, places, map = grid::fit(grid_of(7, 4)).value(),
            answers = std::vector<Answer>(places.size())]() mutable {
      ask(map, places, answers);
      return answers.data();
    };
  };
}

auto fit_of(int columns, int rows) {
  return [=](const benchmark::State&) {
    return [grid = grid_of(columns, rows)] { return grid::fit(grid); };
  };
}

const benchmark::internal::Benchmark* const of_maps[] = {
    bench::add("map/fit/28_points", fit_of(7, 4)),
    bench::add("map/fit/91_points", fit_of(13, 7)),
    bench::add("map/lengths", place_by_place([](const auto& map, const auto& place) {
                 return map.lengths(place);
               }),
               benchmark::kNanosecond),
    bench::add("map/query",
               place_by_place([](const auto& map, const auto& place) { return map.query(place); }),
               benchmark::kNanosecond),
    bench::add("map/query/1000_places", thousand_places<grid::MapAnswerOrFailure>(grid::query),
               benchmark::kMillisecond, 1000),
    bench::add("map/lengths/1000_places", thousand_places<grid::MapLengthsOrFailure>(grid::lengths),
               benchmark::kMillisecond, 1000)};

}  // namespace
