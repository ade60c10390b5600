// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/plotter_map.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "interp/eigen.hpp"

namespace chaintrue::grid {
namespace {

template <class Point>
Point middle_of(const std::vector<Point>& points) {
  Point sum;
  for (const Point& point : points) {
    sum.x_mm += point.x_mm;
    sum.y_mm += point.y_mm;
  }
  const double count = as_double(points.size());
  return {sum.x_mm / count, sum.y_mm / count};
}

/// Where a plotter's pen is when these lengths are counted. \throws std::invalid_argument.
std::vector<MarkPoint> pens_of(const Mechanism& plotter, const std::vector<ChainLengths>& counted) {
  std::vector<MarkPoint> pens;
  for (const ChainLengths& lengths : counted) {
    const auto pen = plotter.locate_by_first(lengths);
    if (!pen)
      throw std::invalid_argument(
          fmt::format("a cross that the plotter cannot draw: {}", pen.error().sentence()));
    pens.push_back({pen->x_mm, pen->y_mm});
  }
  return pens;
}

}  // namespace

MechanismMap plotter_map(const KnownPlotter& plotter) {
  if (!plotter.found) throw std::invalid_argument("a plotter of which nothing was found");
  const SetPlotter& set = plotter.set;
  const auto found = make_plotter_mechanism(machine_found(set, *plotter.found));
  const BedPoint by = set.pins_middle;
  std::vector<BedPoint> crosses;  // as commanded, in the controller's coordinates
  std::vector<ChainLengths> counted;
  for (const auto& [name, commanded] : planned_drawing(set).crosses) {
    crosses.push_back({commanded.x_mm + by.x_mm, commanded.y_mm + by.y_mm});
    const auto lengths = paid_out(set.firmware, set.machine, commanded);
    if (!lengths)
      throw std::invalid_argument(fmt::format("a cross that the controller cannot hold: {}",
                                              sentence_of(lengths.error().reason)));
    counted.push_back(*lengths);
  }
  const BedPoint middle = middle_of(crosses);
  const MarkPoint drawn = middle_of(pens_of(*found, counted));
  const PlacedMechanism best{found, {{middle.x_mm - drawn.x_mm, middle.y_mm - drawn.y_mm}}};
  // The page of each plotter one sigma away is placed so that its crosses best match those of the fit.
  std::vector<ChainLengths> of_fit;
  std::vector<BedPoint> on_page;
  std::vector<MarkPoint> measured;
  for (const BedPoint& cross : crosses) {
    measured.push_back(identity_placement(cross));
    const auto lengths = found->first_lengths(best.sheet.in_frame(cross));
    if (!lengths) continue;
    of_fit.push_back(*lengths);
    on_page.push_back(cross);
  }
  const model::MechanismExtent e = found->extent();
  return {best,
          spread_about(found->values(), plotter.found->covariance(),
                       [&](const VectorXd& values) {
                         auto other = found->with_values(values);
                         const auto laid = laid_on(pens_of(*other, of_fit), on_page);
                         return PlacedMechanism{std::move(other), {laid}};
                       }),
          MeasuredArea(measured, {e.x_min_mm + by.x_mm, e.x_max_mm + by.x_mm, e.y_min_mm + by.y_mm,
                                  e.y_max_mm + by.y_mm})};
}

}  // namespace chaintrue::grid
