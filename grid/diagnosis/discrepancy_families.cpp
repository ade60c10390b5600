// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <numbers>

#include "grid/diagnosis/discrepancy.hpp"
#include "grid/eigen.hpp"

namespace chaintrue::grid::diagnosis {
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
      for (Index length = 0; length < kLengths; ++length) {
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
