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
    // The tool moved where the sled hangs over the border, equally on all sides.
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
  /// Along x and y others have it. A fold along a direction next to its own bends elsewhere too:
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

/// A unit with the places of its system, or with its own lengths.
struct PlacedUnit {
  const SystemUnit& unit;
  const std::vector<DiscrepancyPlace>& places;
  const LengthEntry* entry = nullptr;
};

PlacedUnit placed(const RegressorSystem& system,
                  const std::vector<DiscrepancyPlace>& places,
                  std::size_t unit) {
  return {system.units[unit], places, system.entries.empty() ? nullptr : &system.entries[unit]};
}

/// k of each length at two places.
double between_lengths(const DiscrepancyKernel& kernel, const LengthEntry& a, const LengthEntry& b) {
  double sum = 0.0;
  for (const DiscrepancyField& field : kernel.fields) {
    const bool of_place = field.of == FieldOf::place;
    const FieldArgument at = of_place ? FieldArgument{a.x_mm, a.y_mm} : FieldArgument{a.visit};
    const FieldArgument there = of_place ? FieldArgument{b.x_mm, b.y_mm} : FieldArgument{b.visit};
    sum += field_covariance(field, at, there);
  }
  return sum / static_cast<double>(kernel.fields.size());
}

std::vector<DiscrepancyPlace> places_of(const RegressorSystem& system) {
  std::vector<DiscrepancyPlace> places;
  for (const SystemPlace& place : system.places) places.push_back(discrepancy_place(place));
  return places;
}

Eigen::Matrix2d between_units(const DiscrepancyKernel& kernel,
                              const PlacedUnit& a,
                              const PlacedUnit& b) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  if (a.entry != nullptr && b.entry != nullptr) {
    const double k = between_lengths(kernel, *a.entry, *b.entry);
    auto block = sum.topLeftCorner(a.unit.rows, b.unit.rows);
    if (const auto alone = kernel.fields.front().alone) {
      block = k * a.entry->by_length.col(*alone) * b.entry->by_length.col(*alone).transpose();
    } else {
      block = k * a.entry->by_length * b.entry->by_length.transpose();
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
                                         "",
                                         "visit"};
  return kNames[static_cast<std::size_t>(of)];
}

const DiscrepancyFamily& chain_discrepancies() {
  static const DiscrepancyFamily kFamily{Kernels().all(), kDiscrepancyStrengths};
  return kFamily;
}

const DiscrepancyFamily& length_discrepancies(bool ordered) {
  // In sigmas: from what hardly shows to what real frames of four belts leave, four times over.
  static constexpr std::array kStrengths = {6.0, 12.0, 24.0, 48.0};
  // From twice the usual distance of two places to a quarter of a frame; over the visits of a row.
  static const auto kernel = [](double place_mm, double visits, double prior) {
    DiscrepancyKernel own{{{FieldOf::place, place_mm, FieldEntry::lengths}}, prior};
    if (visits > 0.0) own.fields.push_back({FieldOf::visit, visits, FieldEntry::lengths});
    return own;
  };
  static const DiscrepancyFamily kOrdered{{kernel(150.0, 0.0, 0.2),
                                           kernel(300.0, 0.0, 0.2),
                                           kernel(600.0, 0.0, 0.2),
                                           kernel(300.0, 6.0, 0.2),
                                           kernel(600.0, 6.0, 0.2)},
                                          kStrengths};
  static const DiscrepancyFamily kUnordered{
      {kernel(150.0, 0.0, 0.2), kernel(300.0, 0.0, 0.4), kernel(600.0, 0.0, 0.4)}, kStrengths};
  return ordered ? kOrdered : kUnordered;
}

const DiscrepancyFamily& length_discrepancies_of_laws(bool ordered) {
  static const auto with_single = [](DiscrepancyFamily family) {
    constexpr std::array kPlaceMm = {150.0, 300.0, 600.0};
    constexpr Eigen::Index kLengths = 4;
    constexpr double kHalf = 0.5;
    for (DiscrepancyKernel& own : family.kernels) own.prior *= kHalf;
    for (const double place_mm : kPlaceMm) {
      for (Eigen::Index length = 0; length < kLengths; ++length) {
        DiscrepancyField field{FieldOf::place, place_mm, FieldEntry::lengths};
        field.alone = length;
        family.kernels.push_back({{field}, kHalf / static_cast<double>(kPlaceMm.size() * kLengths)});
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
                                       const KeptRows& kept,
                                       const DiscrepancyKernel& kernel) {
  const std::vector<DiscrepancyPlace> there = places_of(to);
  const std::vector<DiscrepancyPlace> here = places_of(from);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(to.e.size(), kept.size());
  for (const KeptRows::Unit& kept_unit : kept.units()) {
    const PlacedUnit other = placed(from, here, kept_unit.unit);
    for (std::size_t u = 0; u < to.units.size(); ++u) {
      const SystemUnit& own = to.units[u];
      const Eigen::Matrix2d block = between_units(kernel, placed(to, there, u), other);
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
  const std::vector<DiscrepancyPlace> places = places_of(system);
  const std::vector<KeptRows::Unit>& units = kept.units();
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(kept.size(), kept.size());
  for (std::size_t a = 0; a < units.size(); ++a) {
    const PlacedUnit own = placed(system, places, units[a].unit);
    for (std::size_t b = 0; b <= a; ++b) {
      const PlacedUnit other = placed(system, places, units[b].unit);
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
