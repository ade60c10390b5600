// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

/// Radius of a sled: that far from the border its rim begins to hang over.
constexpr double kSledMm = 230.0;

/// k of each length at two places.
double between_lengths(const DiscrepancyKernel& kernel, const SystemPlace& a,
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

/// One entry for each place, so that two places are compared once, however many units see them.
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
Eigen::MatrixXd between(const DiscrepancyKernel& kernel, const RegressorSystem& to,
                        const KeptRows& rows, const RegressorSystem& from, const KeptRows& columns,
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
      const Eigen::Matrix2d block = kernel.of_lengths()
                                        ? Eigen::Matrix2d(Eigen::Matrix2d::Identity())
                                        : discrepancy_block(kernel, here, there);
      for (const RowsAtPlace& a : to_places[p]) {
        decltype(a.by) left = k * a.by;
        if (!kernel.of_lengths()) left = a.by.lazyProduct(block);
        for (const RowsAtPlace& b : from_places[q]) {
          const decltype(a.by) part = left.lazyProduct(b.by.transpose());
          c.block(a.at, b.at, part.rows(), part.cols()) += part;
          if (symmetric && p != q)
            c.block(b.at, a.at, part.cols(), part.rows()) += part.transpose();
        }
      }
    }
  }
  return c;
}

/// The largest residual of a field's unit variance that is rounding.
constexpr double kFieldRounding = 1e-13;

/// For every place, first component first; only for the border the second component has its own arguments.
std::vector<FieldArgument> arguments_of(const DiscrepancyField& field,
                                        const std::vector<SystemPlace>& places) {
  std::vector<FieldArgument> result;
  const Eigen::Index components = field.of == Coordinate::border ? 2 : 1;
  for (Eigen::Index component = 0; component < components; ++component) {
    for (const SystemPlace& place : places) {
      result.push_back(field_argument(field, place, component));
    }
  }
  return result;
}

}  // namespace

FieldArgument field_argument(const DiscrepancyField& field, const SystemPlace& place,
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

double field_covariance(const DiscrepancyField& field, const FieldArgument& a,
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

Eigen::Matrix2d discrepancy_block(const DiscrepancyKernel& kernel, const SystemPlace& a,
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

Eigen::MatrixXd discrepancy_covariance(const RegressorSystem& to, const RegressorSystem& from,
                                       const KeptRows& kept, const DiscrepancyKernel& kernel) {
  return between(kernel, to, KeptRows::all(to), from, kept, false);
}

Eigen::MatrixXd discrepancy_covariance(const RegressorSystem& system, const KeptRows& kept,
                                       const DiscrepancyKernel& kernel) {
  return between(kernel, system, kept, system, kept, true);
}

Eigen::MatrixXd low_rank(Eigen::Index n, double least, const CovarianceOf& covariance) {
  Eigen::MatrixXd factor(n, std::min<Eigen::Index>(n, 32));  // with room for more
  Eigen::Index rank = 0;
  Eigen::VectorXd left(n);
  for (Eigen::Index i = 0; i < n; ++i) left(i) = covariance(i, i);
  for (; rank < n; ++rank) {
    Eigen::Index pivot = 0;
    const double most = left.maxCoeff(&pivot);
    if (most < least) break;
    Eigen::VectorXd column(n);
    for (Eigen::Index i = 0; i < n; ++i) column(i) = covariance(i, pivot);
    const Eigen::VectorXd own = factor.row(pivot).head(rank);
    linear::add_product(column, -1.0, factor.leftCols(rank), own);
    column /= std::sqrt(most);
    if (rank == factor.cols()) factor.conservativeResize(n, std::min(n, 2 * rank));
    factor.col(rank) = column;
    left -= column.cwiseAbs2();
  }
  return factor.leftCols(rank);
}

FieldFactor field_factor(const RegressorSystem& system, const KeptRows& kept,
                         const DiscrepancyField& field, double least) {
  const std::vector<FieldArgument> arguments = arguments_of(field, system.places);
  const Eigen::MatrixXd factor =
      low_rank(std::ssize(arguments), least, [&](Eigen::Index i, Eigen::Index j) {
        return field_covariance(field, arguments[as_size(i)], arguments[as_size(j)]);
      });
  // Where the second component's arguments begin.
  const Eigen::Index second = factor.rows() - std::ssize(system.places);
  FieldFactor result{Eigen::MatrixXd::Zero(kept.size(), factor.cols()),
                     Eigen::MatrixXd::Zero(kept.size(), factor.cols())};
  for (const KeptRows::Unit& own : kept.units()) {
    const SystemUnit& unit = system.units[own.unit];
    for (const observation::PlaceColumns& place : unit.places) {
      const Eigen::MatrixXd entry =
          KeptRows::of_unit(own, place.by_chain * field_entry(field, system.places[place.place]));
      const auto at = as_index(place.place);
      for (Eigen::Index k = 0; k < entry.rows(); ++k) {
        result.first.row(own.at + k) += entry(k, 0) * factor.row(at);
        result.second.row(own.at + k) += entry(k, 1) * factor.row(second + at);
      }
    }
  }
  return result;
}

std::vector<Eigen::Vector2d> entries_of(const DiscrepancyField& field) {
  if (const auto direction = entry_direction(field)) return {*direction};
  return {Eigen::Vector2d::UnitX(), Eigen::Vector2d::UnitY()};
}

Eigen::MatrixXd discrepancy_factor(const RegressorSystem& system, const KeptRows& kept,
                                   const DiscrepancyKernel& kernel) {
  if (kernel.of_lengths()) {
    const Eigen::MatrixXd k = discrepancy_covariance(system, kept, kernel);
    const double most = k.size() > 0 ? k.diagonal().maxCoeff() : 0.0;
    if (!(most > 0.0)) return Eigen::MatrixXd(k.rows(), 0);
    return low_rank(k.rows(), kFieldRounding * most,
                    [&](Eigen::Index i, Eigen::Index j) { return k(i, j); });
  }
  std::vector<Eigen::MatrixXd> parts;
  Eigen::Index rank = 0;
  for (const DiscrepancyField& field : kernel.fields) {
    const FieldFactor factor = field_factor(system, kept, field, kFieldRounding);
    for (const Eigen::Vector2d& entry : entries_of(field)) {
      parts.push_back(entry.x() * factor.first + entry.y() * factor.second);
      rank += parts.back().cols();
    }
  }
  Eigen::MatrixXd all(kept.size(), rank);
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& part : parts) {
    all.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  return all / std::sqrt(as_double(kernel.fields.size()));
}

}  // namespace chaintrue::grid::diagnosis
