// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/plotter_map.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using model::PlotterMechanism;
using model::ToolPosition;

/// The page in a plotter's frame, moved and turned about the page's middle.
class Page final : public SheetInFrame {
 public:
  Page(BedPoint middle, BedPoint moved_to, double turn_rad)
      : middle_(middle), moved_to_(moved_to), c_(std::cos(turn_rad)), s_(std::sin(turn_rad)) {}
  [[nodiscard]] ToolPosition in_frame(BedPoint sheet) const override {
    const double x = sheet.x_mm - middle_.x_mm, y = sheet.y_mm - middle_.y_mm;
    return {moved_to_.x_mm + c_ * x - s_ * y, moved_to_.y_mm + s_ * x + c_ * y};
  }
  [[nodiscard]] BedPoint on_sheet(ToolPosition position) const override {
    const double x = position.x_mm - moved_to_.x_mm, y = position.y_mm - moved_to_.y_mm;
    return {middle_.x_mm + c_ * x + s_ * y, middle_.y_mm - s_ * x + c_ * y};
  }

 private:
  BedPoint middle_;    ///< of the crosses, on the page
  BedPoint moved_to_;  ///< where that is in the frame
  double c_, s_;
};

BedPoint middle_of(const std::vector<BedPoint>& points) {
  BedPoint sum;
  for (const BedPoint& point : points) {
    sum.x_mm += point.x_mm;
    sum.y_mm += point.y_mm;
  }
  const double count = static_cast<double>(points.size());
  return {sum.x_mm / count, sum.y_mm / count};
}

/// The turn that brings `page` about its middle nearest to `drawn` about its own, least squares.
double turn_between(const std::vector<BedPoint>& page, const std::vector<BedPoint>& drawn) {
  const BedPoint from = middle_of(page), to = middle_of(drawn);
  double across = 0.0, along = 0.0;
  for (std::size_t i = 0; i < page.size(); ++i) {
    const double x = page[i].x_mm - from.x_mm, y = page[i].y_mm - from.y_mm;
    const double u = drawn[i].x_mm - to.x_mm, v = drawn[i].y_mm - to.y_mm;
    across += x * v - y * u;
    along += x * u + y * v;
  }
  return std::atan2(across, along);
}

/// Commands of the test page's crosses in the controller's coordinates.
std::vector<BedPoint> crosses_of(const SetPlotter& set) {
  std::vector<BedPoint> crosses;
  for (const DrawnCross& cross : planned_drawing(set).crosses) {
    crosses.push_back({cross.commanded.x_mm + set.pins_middle.x_mm,
                       cross.commanded.y_mm + set.pins_middle.y_mm});
  }
  return crosses;
}

/// Where a plotter's pen is when these lengths are counted. \throws std::invalid_argument.
std::vector<BedPoint> pens_of(const PlotterMechanism& plotter,
                              const std::vector<model::ChainLengths>& counted) {
  std::vector<BedPoint> pens;
  for (const model::ChainLengths& lengths : counted) {
    const auto pen = plotter.locate_by_first(lengths);
    if (!pen)
      throw std::invalid_argument(
          fmt::format("a cross that the plotter cannot draw: {}", pen.error().sentence()));
    pens.push_back({pen->x_mm, pen->y_mm});
  }
  return pens;
}

struct Fitted {
  PlacedMechanism placed;
  MechanismSpread spread;
  MeasuredArea area;
};

Fitted fitted_of(const KnownPlotter& plotter) {
  if (!plotter.found) throw std::invalid_argument("a plotter of which nothing was found");
  const SetPlotter& set = plotter.set;
  const auto found = model::make_plotter_mechanism(machine_found(set, *plotter.found));
  const std::vector<BedPoint> crosses = crosses_of(set);
  std::vector<model::ChainLengths> counted;
  for (const BedPoint& cross : crosses) {
    const auto lengths = model::paid_out(
        set.firmware,
        set.machine,
        {cross.x_mm - set.pins_middle.x_mm, cross.y_mm - set.pins_middle.y_mm});
    if (!lengths)
      throw std::invalid_argument(fmt::format("a cross that the controller cannot hold: {}",
                                              sentence_of(lengths.error().reason)));
    counted.push_back(*lengths);
  }
  const BedPoint middle = middle_of(crosses);
  const std::vector<BedPoint> drawn = pens_of(*found, counted);
  const PlacedMechanism best{found,
                             std::make_shared<const Page>(middle, middle_of(drawn), 0.0)};
  MechanismSpread spread{best, {}};
  // The page of each plotter one sigma away is placed so that its crosses best match those of the fit.
  const linear::SymmetricEigen parts(plotter.found->covariance());
  std::vector<model::ChainLengths> of_fit;
  std::vector<BedPoint> on_page;
  for (std::size_t i = 0; i < crosses.size(); ++i) {
    const auto lengths = found->first_lengths(best.sheet->in_frame(crosses[i]));
    if (!lengths) continue;
    of_fit.push_back(*lengths);
    on_page.push_back(crosses[i]);
  }
  for (Eigen::Index k = 0; k < parts.eigenvalues().size(); ++k) {
    if (!(parts.eigenvalues()[k] > 0.0)) continue;
    const auto other = std::dynamic_pointer_cast<const PlotterMechanism>(found->with_values(
        found->values() + std::sqrt(parts.eigenvalues()[k]) * parts.eigenvectors().col(k)));
    const std::vector<BedPoint> pens = pens_of(*other, of_fit);
    spread.others.push_back(
        {other,
         std::make_shared<const Page>(
             middle_of(on_page), middle_of(pens), turn_between(on_page, pens))});
  }
  std::vector<model::MarkPoint> measured;
  for (const BedPoint& cross : crosses) measured.push_back(model::identity_placement(cross));
  const model::MechanismExtent e = found->extent();
  const BedPoint by = set.pins_middle;
  return {best,
          std::move(spread),
          MeasuredArea(measured,
                       {e.x_min_mm + by.x_mm,
                        e.x_max_mm + by.x_mm,
                        e.y_min_mm + by.y_mm,
                        e.y_max_mm + by.y_mm})};
}

MechanismMap map_of(const KnownPlotter& plotter) {
  Fitted fitted = fitted_of(plotter);
  return MechanismMap(
      std::move(fitted.placed), std::move(fitted.spread), std::move(fitted.area));
}

}  // namespace

PlotterMap::PlotterMap(const KnownPlotter& plotter)
    : MechanismMap(map_of(plotter)) {}

}  // namespace chaintrue::grid
