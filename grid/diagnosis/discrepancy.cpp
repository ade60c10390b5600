// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy.hpp"

#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

/// Radius of a sled: that far from the border its rim begins to hang over.
constexpr double kSledMm = 230.0;

/// k of each length at two places.
double between_lengths(const DiscrepancyKernel& kernel,
                       const SystemPlace& a,
                       const SystemPlace& b) {
  double sum = 0.0;
  for (const DiscrepancyField& field : kernel.fields)
    sum += field_covariance(field, field_argument(field, a, 0), field_argument(field, b, 0));
  return sum / as_double(kernel.fields.size());
}

/// The kept rows of a unit by what disturbs them at one place: the two chains, or each length.
struct RowsAtPlace {
  Eigen::Index at = 0;  ///< position of the first
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 2, 4> by;
};

/// Of each place, so that two places are compared once, however many units see them.
std::vector<std::vector<RowsAtPlace>> rows_by_place(const RegressorSystem& system,
                                                    const KeptRows& kept,
                                                    const DiscrepancyKernel& kernel) {
  std::vector<std::vector<RowsAtPlace>> result(system.places.size());
  for (const KeptRows::Unit& own : kept.units()) {
    const SystemUnit& unit = system.units[own.unit];
    for (const observation::PlaceColumns& place : unit.places) {
      Eigen::MatrixXd by = kernel.of_lengths() ? unit.by_reading : Eigen::MatrixXd(place.by_chain);
      if (const auto alone = kernel.fields.front().alone) by = Eigen::MatrixXd(by.col(*alone));
      result[place.place].push_back({own.at, KeptRows::of_unit(own, by)});
    }
  }
  return result;
}

/// K of these rows and those, which are the same if `symmetric`.
Eigen::MatrixXd between(const DiscrepancyKernel& kernel,
                        const RegressorSystem& to,
                        const KeptRows& rows,
                        const RegressorSystem& from,
                        const KeptRows& columns,
                        bool symmetric) {
  const auto to_places = rows_by_place(to, rows, kernel);
  const auto from_places = rows_by_place(from, columns, kernel);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(rows.size(), columns.size());
  for (std::size_t p = 0; p < to_places.size(); ++p) {
    for (std::size_t q = 0; q < (symmetric ? p + 1 : from_places.size()); ++q) {
      if (to_places[p].empty() || from_places[q].empty()) continue;
      const SystemPlace& here = to.places[p];
      const SystemPlace& there = from.places[q];
      const double k = kernel.of_lengths() ? between_lengths(kernel, here, there) : 1.0;
      const Eigen::Matrix2d block = kernel.of_lengths() ? Eigen::Matrix2d(Eigen::Matrix2d::Identity())
                                                        : discrepancy_block(kernel, here, there);
      for (const RowsAtPlace& a : to_places[p]) {
        decltype(a.by) left = k * a.by;
        if (!kernel.of_lengths()) left = a.by.lazyProduct(block);
        for (const RowsAtPlace& b : from_places[q]) {
          const decltype(a.by) part = left.lazyProduct(b.by.transpose());
          c.block(a.at, b.at, part.rows(), part.cols()) += part;
          if (symmetric && p != q) c.block(b.at, a.at, part.cols(), part.rows()) += part.transpose();
        }
      }
    }
  }
  return c;
}

}  // namespace

FieldArgument field_argument(const DiscrepancyField& field,
                             const SystemPlace& place,
                             Eigen::Index component) {
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

double field_covariance(const DiscrepancyField& field,
                        const FieldArgument& a,
                        const FieldArgument& b) {
  const double square = std::pow(a.first - b.first, 2) + std::pow(a.second - b.second, 2);
  return a.weight * b.weight * std::exp(-0.5 * square / (field.length * field.length));
}

std::optional<Eigen::Vector2d> entry_direction(const DiscrepancyField& field) {
  if (field.of == Coordinate::border) return Eigen::Vector2d::Ones();
  if (!field.direction_rad) return std::nullopt;
  return Eigen::Vector2d(std::cos(*field.direction_rad), std::sin(*field.direction_rad));
}

Eigen::Matrix2d field_entry(const DiscrepancyField& field, const SystemPlace& place) {
  return field.entry == FieldEntry::chains ? Eigen::Matrix2d(Eigen::Matrix2d::Identity())
                                           : place.state.by_mark;
}

Eigen::Matrix2d discrepancy_block(const DiscrepancyKernel& kernel,
                                  const SystemPlace& a,
                                  const SystemPlace& b) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const DiscrepancyField& field : kernel.fields) {
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
    if (const auto d = entry_direction(field)) covariance = *d * d->transpose();
    if (field.of == Coordinate::border) {
      for (Eigen::Index i = 0; i < 2; ++i) {
        for (Eigen::Index j = 0; j < 2; ++j) {
          covariance(i, j) *=
              field_covariance(field, field_argument(field, a, i), field_argument(field, b, j));
        }
      }
    } else {
      covariance *=
          field_covariance(field, field_argument(field, a, 0), field_argument(field, b, 0));
    }
    sum += field_entry(field, a) * covariance * field_entry(field, b).transpose();
  }
  return sum / as_double(kernel.fields.size());
}

Eigen::MatrixXd discrepancy_covariance(const RegressorSystem& to,
                                       const RegressorSystem& from,
                                       const KeptRows& kept,
                                       const DiscrepancyKernel& kernel) {
  return between(kernel, to, KeptRows::all(to), from, kept, false);
}

Eigen::MatrixXd discrepancy_covariance(const RegressorSystem& system,
                                       const KeptRows& kept,
                                       const DiscrepancyKernel& kernel) {
  return between(kernel, system, kept, system, kept, true);
}

}  // namespace chaintrue::grid::diagnosis
