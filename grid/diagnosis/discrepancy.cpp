// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy.hpp"

#include <cmath>
#include <numbers>

namespace chaintrue::grid::diagnosis {
namespace {

/// Density of a half-Cauchy over the logarithm of the strength, but for a constant.
double cauchy_weight(double strength) {
  return strength / (1.0 + std::pow(strength / kDiscrepancyScale, 2));
}

double strength_number(std::size_t index) { return kDiscrepancyStrengths[index]; }

/// Directions of entry, an eighth of half a turn apart: any ratio is within 11 degrees of one, and
/// loses at most 4 % of its square to the other component.
constexpr int kDirections = 8;

/// Length of a trend over the bed: two thirds of its height, a third of its width.
constexpr double kTrendMm = 800.0;

/// Radius of a sled: that far from the border its rim begins to hang over.
constexpr double kSledMm = 230.0;

class Kernels {
 public:
  Kernels() {
    // One field over the bed, at any ratio of the chains: dents and waves of a fifth of the bed's
    // height up to the whole.
    std::vector<DiscrepancyField> group;
    for (const double mm : {140.0, 250.0, 450.0}) at_any_ratio({FieldOf::place, mm}, group);
    take(group, 0.35);
    // Each chain by itself.
    for (const double mm : {250.0, 450.0, 800.0}) group.push_back({FieldOf::place, mm});
    take(group, 0.15);
    // The tool moved along x and along y by functions of x alone and of y alone, as edges, boards
    // and folds do it. These have a trend over the whole bed, which must not pass for a scale.
    all_.push_back({{{FieldOf::x, 180.0, FieldEntry::tool},
                     {FieldOf::y, 180.0, FieldEntry::tool},
                     {FieldOf::x, kTrendMm, FieldEntry::tool},
                     {FieldOf::y, kTrendMm, FieldEntry::tool}},
                    0.10});
    // The tool moved where the sled hangs over the border, alike on all sides.
    all_.push_back({{{FieldOf::border, 180.0, FieldEntry::tool}}, 0.05});
    // The tool moved along one axis of the sheet.
    for (const FieldOf of : {FieldOf::place, FieldOf::x, FieldOf::y}) {
      for (const double mm : {250.0, 450.0}) along_an_axis({of, mm}, group);
    }
    // The tool moved the way it goes across something: a board's wave, a fold.
    oblique({FieldOf::across, 200.0}, group);
    take(group, 0.20);
    // A function of one coordinate: a strip of the banner, a beam, a chain, its angle, its pull.
    for (const FieldOf of : {FieldOf::x, FieldOf::y, FieldOf::length_left, FieldOf::length_right}) {
      for (const double mm : {150.0, 400.0}) at_any_ratio({of, mm}, group);
    }
    for (const FieldOf of : {FieldOf::angle_left, FieldOf::angle_right}) {
      for (const double rad : {0.1, 0.25}) at_any_ratio({of, rad}, group);
    }
    for (const FieldOf of : {FieldOf::tension_left, FieldOf::tension_right}) {
      at_any_ratio({of, 15.0}, group);
    }
    take(group, 0.15);
  }
  [[nodiscard]] const std::vector<DiscrepancyKernel>& all() const { return all_; }

 private:
  static void at_any_ratio(DiscrepancyField field, std::vector<DiscrepancyField>& group) {
    for (int k = 0; k < kDirections; ++k) {
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
  /// Along x and y others have it. A fold seen a step beside its direction bends elsewhere too:
  /// twice as many as of entry.
  static void oblique(DiscrepancyField field, std::vector<DiscrepancyField>& group) {
    field.entry = FieldEntry::tool;
    for (int k = 1; k < 2 * kDirections; ++k) {
      if (k == kDirections) continue;
      field.across_rad = 0.5 * std::numbers::pi * k / kDirections;
      field.direction_rad = field.across_rad;
      group.push_back(field);
    }
  }
  /// The same with a trend.
  static DiscrepancyField trend_of(DiscrepancyField field) {
    field.length = kTrendMm;
    return field;
  }
  void take(std::vector<DiscrepancyField>& group, double prior) {
    for (const DiscrepancyField& field : group) {
      const double share = prior / static_cast<double>(group.size());
      if (field.entry == FieldEntry::tool && field.of != FieldOf::place) {
        all_.push_back({{field, trend_of(field)}, share});
      } else {
        all_.push_back({{field}, share});
      }
    }
    group.clear();
  }
  std::vector<DiscrepancyKernel> all_;
};

/// A unit with the places of its system.
struct PlacedUnit {
  const SystemUnit& unit;
  const std::vector<DiscrepancyPlace>& places;
};

std::vector<DiscrepancyPlace> places_of(const RegressorSystem& system) {
  std::vector<DiscrepancyPlace> places;
  for (const SystemPlace& place : system.places) places.push_back(discrepancy_place(place));
  return places;
}

Eigen::Matrix2d between_units(const DiscrepancyKernel& kernel,
                              const PlacedUnit& a,
                              const PlacedUnit& b) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
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

std::string_view name(FieldOf of) {
  constexpr std::string_view kNames[] = {"x",
                                         "y",
                                         "length_left",
                                         "length_right",
                                         "angle_left",
                                         "angle_right",
                                         "tension_left",
                                         "tension_right",
                                         "",
                                         "",
                                         ""};
  return kNames[static_cast<std::size_t>(of)];
}

const std::vector<DiscrepancyKernel>& discrepancy_kernels() {
  static const Kernels kKernels;
  return kKernels.all();
}

int discrepancy_count() {
  return static_cast<int>(discrepancy_kernels().size() * std::size(kDiscrepancyStrengths));
}

std::size_t kernel_of(int discrepancy) {
  return static_cast<std::size_t>(discrepancy) / std::size(kDiscrepancyStrengths);
}

double strength_of(int discrepancy) {
  return strength_number(static_cast<std::size_t>(discrepancy) % std::size(kDiscrepancyStrengths));
}

double log_share_of_discrepancy(int discrepancy) {
  double sum = 0.0;
  for (const double strength : kDiscrepancyStrengths) sum += cauchy_weight(strength);
  return std::log(cauchy_weight(strength_of(discrepancy)) / sum) +
         std::log(discrepancy_kernels()[kernel_of(discrepancy)].prior);
}

DiscrepancyPlace discrepancy_place(const SystemPlace& place) {
  const model::Pose& pose = place.state.reading.pose;
  return {{place.mark.x_mm,
           place.mark.y_mm,
           pose.lengths.left_mm,
           pose.lengths.right_mm,
           pose.chains.left.angle_rad,
           pose.chains.right.angle_rad,
           pose.chains.left.tension_at_sprocket_n,
           pose.chains.right.tension_at_sprocket_n},
          place.state.by_mark,
          place.bed};
}

FieldArgument field_argument(const DiscrepancyField& field,
                             const DiscrepancyPlace& place,
                             Eigen::Index component) {
  const double x = place.at[static_cast<std::size_t>(FieldOf::x)];
  const double y = place.at[static_cast<std::size_t>(FieldOf::y)];
  switch (field.of) {
    case FieldOf::place:
      return {x, y};
    case FieldOf::across:
      return {x * std::cos(field.across_rad) + y * std::sin(field.across_rad)};
    case FieldOf::border: {
      const double from_middle = component == 0 ? x : y;
      const double half = 0.5 * (component == 0 ? place.bed.width_mm : place.bed.height_mm);
      const double beyond = std::abs(from_middle) - half;
      return {beyond, 0.0, std::copysign(std::exp(beyond / kSledMm), from_middle)};
    }
    default:
      return {place.at[static_cast<std::size_t>(field.of)]};
  }
}

double field_covariance(const DiscrepancyField& field,
                        const FieldArgument& a,
                        const FieldArgument& b) {
  const double square = std::pow(a.first - b.first, 2) + std::pow(a.second - b.second, 2);
  return a.weight * b.weight * std::exp(-0.5 * square / (field.length * field.length));
}

std::optional<Eigen::Vector2d> entry_direction(const DiscrepancyField& field) {
  if (field.of == FieldOf::border) return Eigen::Vector2d::Ones();
  if (!field.direction_rad) return std::nullopt;
  return Eigen::Vector2d(std::cos(*field.direction_rad), std::sin(*field.direction_rad));
}

Eigen::Matrix2d field_entry(const DiscrepancyField& field, const DiscrepancyPlace& place) {
  return field.entry == FieldEntry::chains ? Eigen::Matrix2d(Eigen::Matrix2d::Identity())
                                           : place.by_mark;
}

Eigen::Matrix2d discrepancy_block(const DiscrepancyKernel& kernel,
                                  const DiscrepancyPlace& a,
                                  const DiscrepancyPlace& b) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const DiscrepancyField& field : kernel.fields) {
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
    if (const auto d = entry_direction(field)) covariance = *d * d->transpose();
    if (field.of == FieldOf::border) {
      for (Eigen::Index i = 0; i < 2; ++i) {
        for (Eigen::Index j = 0; j < 2; ++j) {
          covariance(i, j) *= field_covariance(
              field, field_argument(field, a, i), field_argument(field, b, j));
        }
      }
    } else {
      covariance *=
          field_covariance(field, field_argument(field, a, 0), field_argument(field, b, 0));
    }
    sum += field_entry(field, a) * covariance * field_entry(field, b).transpose();
  }
  return sum / static_cast<double>(kernel.fields.size());
}

Eigen::MatrixXd discrepancy_covariance(const RegressorSystem& to,
                                       const RegressorSystem& from,
                                       const std::vector<Eigen::Index>& kept,
                                       const DiscrepancyKernel& kernel) {
  const std::vector<DiscrepancyPlace> there = places_of(to);
  const std::vector<DiscrepancyPlace> here = places_of(from);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(to.e.size(), static_cast<Eigen::Index>(kept.size()));
  for (const auto& [column, number] : units_in(from, kept)) {
    const SystemUnit& seen = from.units[number];
    for (const SystemUnit& own : to.units) {
      c.block(own.first_row, column, own.rows, seen.rows) =
          between_units(kernel, {own, there}, {seen, here}).topLeftCorner(own.rows, seen.rows);
    }
  }
  return c;
}

Eigen::MatrixXd discrepancy_covariance(const RegressorSystem& system,
                                       const std::vector<Eigen::Index>& kept,
                                       const DiscrepancyKernel& kernel) {
  const std::vector<DiscrepancyPlace> places = places_of(system);
  const auto units = units_in(system, kept);
  const auto n = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t a = 0; a < units.size(); ++a) {
    const SystemUnit& own = system.units[units[a].second];
    for (std::size_t b = 0; b <= a; ++b) {
      const SystemUnit& other = system.units[units[b].second];
      const Eigen::Matrix2d block = between_units(kernel, {own, places}, {other, places});
      const Eigen::Index row = units[a].first;
      const Eigen::Index column = units[b].first;
      c.block(row, column, own.rows, other.rows) = block.topLeftCorner(own.rows, other.rows);
      c.block(column, row, other.rows, own.rows) =
          block.transpose().topLeftCorner(other.rows, own.rows);
    }
  }
  return c;
}

}  // namespace chaintrue::grid::diagnosis
