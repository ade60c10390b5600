// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace chaintrue::grid::diagnosis {
namespace {

/// Radius of a sled: that far from the border its rim begins to hang over.
constexpr double kSledMm = 230.0;

/// The field's arguments at a place, for the two components that it enters; equal except for the
/// border.
struct FieldArgument {
  double first = 0.0;
  double second = 0.0;  ///< of the place: y
  double weight = 1.0;  ///< of the field there, with its sign
};

FieldArgument field_argument(const DiscrepancyField& field, const SystemPlace& place,
                             Index component) {
  switch (field.of) {
    case Coordinate::place:
      return {place.mark.x_mm, place.mark.y_mm};
    case Coordinate::border: {
      const double from_middle = component == 0 ? place.mark.x_mm : place.mark.y_mm;
      const double half = 0.5 * (component == 0 ? place.bed.width_mm : place.bed.height_mm);
      const double beyond = std::abs(from_middle) - half;
      return {beyond, 0.0, std::copysign(std::exp(beyond / kSledMm), from_middle)};
    }
    default:
      return {value_at(place, field.of, field.across_rad)};
  }
}

/// For the field's values at two arguments.
double field_covariance(const DiscrepancyField& field, const FieldArgument& a,
                        const FieldArgument& b) {
  const double square = std::pow(a.first - b.first, 2) + std::pow(a.second - b.second, 2);
  return a.weight * b.weight * std::exp(-0.5 * square / (field.length * field.length));
}

/// How a field enters: d of its direction; (1, 1) of the border, where both components are one
/// field's; nothing if the components are independent.
std::optional<Vector2d> entry_direction(const DiscrepancyField& field) {
  if (field.of == Coordinate::border) return Vector2d::Ones();
  if (!field.direction_rad) return std::nullopt;
  return Vector2d(std::cos(*field.direction_rad), std::sin(*field.direction_rad));
}

/// How each component of a field's entry enters the rows of a unit at one of its places: the chains,
/// the tool's coordinates, or the lengths.
MatrixXd field_entry(const DiscrepancyField& field, const RegressorSystem& system,
                     const SystemUnit& unit, const PlaceColumns& place) {
  if (field.entry == FieldEntry::chains) return place.by_chain;
  if (field.entry == FieldEntry::tool)
    return place.by_chain * system.places[place.place].state.by_mark;
  return field.alone ? MatrixXd(unit.by_reading.col(*field.alone)) : unit.by_reading;
}

/// The largest residual of a field's unit variance that is rounding.
constexpr double kFieldRounding = 1e-13;

/// Places and units of two systems as one: the rows of `b` behind those of `a`.
RegressorSystem joined(const RegressorSystem& a, const RegressorSystem& b) {
  RegressorSystem both;
  both.e.resize(a.e.size() + b.e.size());
  both.places = a.places;
  append_all(both.places, b.places);
  both.units = a.units;
  for (SystemUnit unit : b.units) {
    unit.first_row += a.e.size();
    for (PlaceColumns& place : unit.places) place.place += a.places.size();
    both.units.push_back(std::move(unit));
  }
  return both;
}

/// F with F F' ~= a covariance of n, n x r, what is left of its diagonal below `least`, by a pivoted Cholesky
/// factorisation (H. Harbrecht, M. Peters and R. Schneider, Applied Numerical Mathematics 62 (2012), 428,
/// algorithm 1).
template <class CovarianceOf>
MatrixXd low_rank(Index n, double least, const CovarianceOf& covariance) {
  MatrixXd factor(n, std::min<Index>(n, 32));  // with room for more
  Index rank = 0;
  VectorXd left(n);
  for (const Index i : each_below(n)) left(i) = covariance(i, i);
  for (; rank < n; ++rank) {
    Index pivot = 0;
    const double most = left.maxCoeff(&pivot);
    if (most < least) break;
    VectorXd column(n);
    for (const Index i : each_below(n)) column(i) = covariance(i, pivot);
    const VectorXd own = factor.row(pivot).head(rank);
    linear::add_product(column, -1.0, factor.leftCols(rank), own);
    column /= std::sqrt(most);
    if (rank == factor.cols()) factor.conservativeResize(n, std::min(n, 2 * rank));
    factor.col(rank) = column;
    left -= column.cwiseAbs2();
  }
  return factor.leftCols(rank);
}

}  // namespace

MatrixXd low_rank(const MatrixXd& covariance, double share) {
  const Index n = covariance.rows();
  const double most = n > 0 ? covariance.diagonal().maxCoeff() : 0.0;
  if (!(most > 0.0)) return MatrixXd(n, 0);
  return low_rank(n, share * most, [&](Index i, Index j) { return covariance(i, j); });
}

std::vector<MatrixXd> field_factor(const RegressorSystem& system, const DiscrepancyField& field,
                                   double least) {
  std::vector<FieldArgument> arguments;
  // Only the border's second component has its own arguments.
  for (const Index component : each_below(field.of == Coordinate::border ? 2 : 1)) {
    for (const SystemPlace& place : system.places)
      arguments.push_back(field_argument(field, place, component));
  }
  const MatrixXd factor = low_rank(std::ssize(arguments), least, [&](Index i, Index j) {
    return field_covariance(field, arguments[as_size(i)], arguments[as_size(j)]);
  });
  const Index second = factor.rows() - std::ssize(system.places);
  std::vector<MatrixXd> parts;
  for (const SystemUnit& unit : system.units) {
    for (const PlaceColumns& place : unit.places) {
      const MatrixXd entry = field_entry(field, system, unit, place);
      if (parts.empty())
        parts.assign(as_size(entry.cols()), MatrixXd::Zero(system.e.size(), factor.cols()));
      for (const Index c : each_below(entry.cols())) {
        parts[as_size(c)].middleRows(unit.first_row, unit.rows) +=
            entry.col(c) * factor.row((c > 0 ? second : 0) + as_index(place.place));
      }
    }
  }
  return parts;
}

std::vector<VectorXd> entries_of(const DiscrepancyField& field, std::size_t components) {
  if (const auto direction = entry_direction(field)) return {*direction};
  const auto count = as_index(components);
  return mapped(each_below(count),
                [&](Index c) { return VectorXd(VectorXd::Unit(count, c)); });
}

MatrixXd discrepancy_factor(const RegressorSystem& system, const DiscrepancyKernel& kernel) {
  MatrixXd all(system.e.size(), 0);
  for (const DiscrepancyField& field : kernel.fields) {
    const std::vector<MatrixXd> parts = field_factor(system, field, kFieldRounding);
    for (const VectorXd& entry : entries_of(field, parts.size())) {
      const Index rank = all.cols();
      all.conservativeResize(Eigen::NoChange, rank + parts.front().cols());
      all.rightCols(all.cols() - rank).setZero();
      for (const auto c : each_index(parts))
        all.rightCols(all.cols() - rank) += entry[as_index(c)] * parts[c];
    }
  }
  all /= std::sqrt(as_double(kernel.fields.size()));
  // The lengths' fields are one, and together more than the rows.
  return kernel.of_lengths() ? low_rank(linear::outer(all), kFieldRounding) : all;
}

DiscrepancyElsewhere discrepancy_at(const RegressorSystem& there, const Discrepancy& process,
                                    const RegressorSystem& system, const KeptRows& kept) {
  const MatrixXd factor =
      process.sigma_mm * discrepancy_factor(joined(there, system), process.kernel);
  const MatrixXd own = factor.topRows(there.e.size());
  const MatrixXd here = kept(MatrixXd(factor.bottomRows(system.e.size())));
  return {linear::outer(own), linear::product(own, linear::transposed(here))};
}

namespace {

/// Density of a half-Cauchy over the logarithm of the strength, up to a constant.
double cauchy_weight(double strength) {
  return strength / (1.0 + std::pow(strength / kDiscrepancyScale, 2));
}

/// Directions of entry, an eighth of half a turn apart: any ratio is within 11 degrees of one, and
/// loses at most 4 % of its square to the other component.
constexpr int kDirections = 8;

/// Length of a trend over the bed: two thirds of its height, a third of its width.
constexpr double kTrendMm = 800.0;

class Kernels {
 public:
  Kernels() {
    // One field over the bed, at any ratio of the chains: dents and waves of a fifth of the bed's
    // height up to the whole.
    std::vector<DiscrepancyField> group;
    for (const double mm : {140.0, 250.0, 450.0}) at_any_ratio({Coordinate::place, mm}, group);
    take(group, 0.35);
    // Each chain separately.
    for (const double mm : {250.0, 450.0, 800.0}) group.push_back({Coordinate::place, mm});
    take(group, 0.15);
    // The tool moved along x and along y by functions of x alone and of y alone, as edges, boards
    // and folds do it. These have a trend over the whole bed, which must not be mistaken for a
    // scale.
    all_.push_back({{{Coordinate::x, 180.0, FieldEntry::tool},
                     {Coordinate::y, 180.0, FieldEntry::tool},
                     {Coordinate::x, kTrendMm, FieldEntry::tool},
                     {Coordinate::y, kTrendMm, FieldEntry::tool}},
                    0.10});
    // The tool moved where the sled hangs over the border, equally on all sides.
    all_.push_back({{{Coordinate::border, 180.0, FieldEntry::tool}}, 0.05});
    // The tool moved along one axis of the sheet.
    for (const Coordinate of : {Coordinate::place, Coordinate::x, Coordinate::y}) {
      for (const double mm : {250.0, 450.0}) along_an_axis({of, mm}, group);
    }
    // The tool moved the way it goes across something: a board's wave, a fold.
    oblique({Coordinate::across, 200.0}, group);
    take(group, 0.20);
    // A function of one coordinate: a strip of the banner, a beam, a chain, its angle, its pull.
    for (const Coordinate of :
         {Coordinate::x, Coordinate::y, Coordinate::length_left, Coordinate::length_right}) {
      for (const double mm : {150.0, 400.0}) at_any_ratio({of, mm}, group);
    }
    for (const Coordinate of : {Coordinate::angle_left, Coordinate::angle_right}) {
      for (const double rad : {0.1, 0.25}) at_any_ratio({of, rad}, group);
    }
    for (const Coordinate of : {Coordinate::tension_left, Coordinate::tension_right}) {
      at_any_ratio({of, 15.0}, group);
    }
    take(group, 0.15);
  }
  const std::vector<DiscrepancyKernel>& all() const { return all_; }

 private:
  static void at_any_ratio(DiscrepancyField field, std::vector<DiscrepancyField>& group) {
    for (const int k : each_below(kDirections)) {
      field.direction_rad = std::numbers::pi * k / kDirections;
      group.push_back(field);
    }
  }
  static void along_an_axis(DiscrepancyField field, std::vector<DiscrepancyField>& group) {
    field.entry = FieldEntry::tool;
    for (const double direction : {0.0, 0.5 * std::numbers::pi}) {
      field.direction_rad = direction;
      group.push_back(field);
    }
  }
  /// x and y are covered elsewhere. A fold is sensitive to its direction: twice as many as
  /// directions of entry.
  static void oblique(DiscrepancyField field, std::vector<DiscrepancyField>& group) {
    field.entry = FieldEntry::tool;
    for (int k = 1; k < 2 * kDirections; ++k) {
      if (k == kDirections) continue;
      field.across_rad = 0.5 * std::numbers::pi * k / kDirections;
      field.direction_rad = field.across_rad;
      group.push_back(field);
    }
  }
  /// As above, with a trend.
  static DiscrepancyField trend_of(DiscrepancyField field) {
    field.length = kTrendMm;
    return field;
  }
  void take(std::vector<DiscrepancyField>& group, double prior) {
    for (const DiscrepancyField& field : group) {
      const double share = prior / as_double(group.size());
      if (field.entry == FieldEntry::tool && field.of != Coordinate::place) {
        all_.push_back({{field, trend_of(field)}, share});
      } else {
        all_.push_back({{field}, share});
      }
    }
    group.clear();
  }
  std::vector<DiscrepancyKernel> all_;
};

}  // namespace

const DiscrepancyFamily& chain_discrepancies() {
  static const DiscrepancyFamily kFamily{Kernels().all(), kDiscrepancyStrengths};
  return kFamily;
}

const DiscrepancyFamily& length_discrepancies(bool ordered) {
  // In sigmas: from barely visible to four times the residual of real four-belt frames.
  static constexpr std::array kStrengths = {6.0, 12.0, 24.0, 48.0};
  // From twice the usual distance of two places to a quarter of a frame; over the visits of a row.
  static const auto kernel = [](double place_mm, double visits, double prior) {
    DiscrepancyKernel own{{{Coordinate::place, place_mm, FieldEntry::lengths}}, prior};
    if (visits > 0.0) own.fields.push_back({Coordinate::visit, visits, FieldEntry::lengths});
    return own;
  };
  static const DiscrepancyFamily kOrdered{
      {kernel(150.0, 0.0, 0.2), kernel(300.0, 0.0, 0.2), kernel(600.0, 0.0, 0.2),
       kernel(300.0, 6.0, 0.2), kernel(600.0, 6.0, 0.2)},
      kStrengths};
  static const DiscrepancyFamily kUnordered{
      {kernel(150.0, 0.0, 0.2), kernel(300.0, 0.0, 0.4), kernel(600.0, 0.0, 0.4)}, kStrengths};
  return ordered ? kOrdered : kUnordered;
}

const DiscrepancyFamily& length_discrepancies_of_laws(bool ordered) {
  static const auto with_single = [](DiscrepancyFamily family) {
    constexpr std::array kPlaceMm = {150.0, 300.0, 600.0};
    constexpr Index kLengths = 4;
    constexpr double kHalf = 0.5;
    for (DiscrepancyKernel& own : family.kernels) own.prior *= kHalf;
    for (const double place_mm : kPlaceMm) {
      for (const Index length : each_below(kLengths)) {
        DiscrepancyField field{Coordinate::place, place_mm, FieldEntry::lengths};
        field.alone = length;
        family.kernels.push_back({{field}, kHalf / as_double(kPlaceMm.size() * kLengths)});
      }
    }
    return family;
  };
  static const DiscrepancyFamily kOrdered = with_single(length_discrepancies(true));
  static const DiscrepancyFamily kUnordered = with_single(length_discrepancies(false));
  return ordered ? kOrdered : kUnordered;
}

double DiscrepancyFamily::log_share_of(int discrepancy) const {
  double sum = 0.0;
  for (const double strength : strengths) sum += cauchy_weight(strength);
  return std::log(cauchy_weight(strength_of(discrepancy)) / sum) +
         std::log(kernels[kernel_of(discrepancy)].prior);
}

}  // namespace chaintrue::grid::diagnosis
