// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy.hpp"

#include <cmath>

#include "grid/containers.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Radius of a sled: that far from the border its rim begins to hang over.
constexpr double kSledMm = 230.0;

/// A unit and the places of its system.
struct PlacedUnit {
  const SystemUnit& unit;
  const std::vector<SystemPlace>& places;
};

PlacedUnit placed(const RegressorSystem& system, std::size_t unit) {
  return {system.units[unit], system.places};
}

/// k of each length at two places.
double between_lengths(const DiscrepancyKernel& kernel,
                       const SystemPlace& a,
                       const SystemPlace& b) {
  double sum = 0.0;
  for (const DiscrepancyField& field : kernel.fields)
    sum += field_covariance(field, field_argument(field, a, 0), field_argument(field, b, 0));
  return sum / as_double(kernel.fields.size());
}

Eigen::Matrix2d between_units(const DiscrepancyKernel& kernel,
                              const PlacedUnit& a,
                              const PlacedUnit& b) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  if (kernel.of_lengths()) {
    const double k = between_lengths(
        kernel, a.places[a.unit.places.front().place], b.places[b.unit.places.front().place]);
    auto block = sum.topLeftCorner(a.unit.rows, b.unit.rows);
    if (const auto alone = kernel.fields.front().alone) {
      block = k * a.unit.by_reading.col(*alone) * b.unit.by_reading.col(*alone).transpose();
    } else {
      block = (k * a.unit.by_reading).lazyProduct(b.unit.by_reading.transpose());
    }
    return sum;
  }
  for (const observation::PlaceColumns& i : a.unit.places) {
    for (const observation::PlaceColumns& j : b.unit.places) {
      sum.topLeftCorner(a.unit.rows, b.unit.rows) +=
          i.by_chain * discrepancy_block(kernel, a.places[i.place], b.places[j.place]) *
          j.by_chain.transpose();
    }
  }
  return sum;
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
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(to.e.size(), kept.size());
  for (const KeptRows::Unit& kept_unit : kept.units()) {
    const PlacedUnit other = placed(from, kept_unit.unit);
    for (std::size_t u = 0; u < to.units.size(); ++u) {
      const SystemUnit& own = to.units[u];
      const Eigen::Matrix2d block = between_units(kernel, placed(to, u), other);
      const auto columns = block.topLeftCorner(own.rows, other.unit.rows);
      auto to_fill = c.block(own.first_row, kept_unit.at, own.rows, kept_unit.rows);
      if (kept_unit.across) {
        to_fill = columns * kept_unit.across->transpose();
      } else {
        to_fill = columns;
      }
    }
  }
  return c;
}

Eigen::MatrixXd discrepancy_covariance(const RegressorSystem& system,
                                       const KeptRows& kept,
                                       const DiscrepancyKernel& kernel) {
  const std::vector<KeptRows::Unit>& units = kept.units();
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(kept.size(), kept.size());
  for (std::size_t a = 0; a < units.size(); ++a) {
    const PlacedUnit own = placed(system, units[a].unit);
    for (std::size_t b = 0; b <= a; ++b) {
      const PlacedUnit other = placed(system, units[b].unit);
      const Eigen::Matrix2d whole = between_units(kernel, own, other);
      const auto put = [&](const auto& block) {
        c.block(units[a].at, units[b].at, units[a].rows, units[b].rows) = block;
        c.block(units[b].at, units[a].at, units[b].rows, units[a].rows) = block.transpose();
      };
      const auto all = whole.topLeftCorner(own.unit.rows, other.unit.rows);
      if (!units[a].across && !units[b].across) {
        put(all);
      } else {
        const Eigen::MatrixXd part = KeptRows::of_unit(units[a], all);
        put(Eigen::MatrixXd(KeptRows::of_unit(units[b], part.transpose()).transpose()));
      }
    }
  }
  return c;
}

}  // namespace chaintrue::grid::diagnosis
