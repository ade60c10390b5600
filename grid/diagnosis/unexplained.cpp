// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/random.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

std::string_view name(Enters enters) {
  return word_of(enters, {"left", "right", "alike", "opposite", "x", "y", "mixed", "along",
                          "outwards", "tl", "tr", "bl", "br"});
}

namespace {

/// Share of the weight that must agree before it is reported.
constexpr double kMost = 0.5;

Enters entry_of(const DiscrepancyKernel& kernel) {
  const DiscrepancyField& field = kernel.fields.front();
  const bool one_way =
      all_of(kernel.fields, having(&DiscrepancyField::direction_rad, field.direction_rad));
  if (!one_way || !field.direction_rad) return Enters::mixed;
  // The nearest of the four directions of a half turn; those between two are mixed.
  const double eighths = *field.direction_rad / (0.25 * std::numbers::pi);
  const long nearest = std::lround(eighths);
  if (std::abs(eighths - as_double(nearest)) > 0.4) return Enters::mixed;
  using enum Enters;
  constexpr std::array kOfTool = {x, mixed, y, mixed};
  constexpr std::array kOfChains = {left, equal, right, opposite};
  return (field.entry == FieldEntry::tool ? kOfTool : kOfChains)[as_size(nearest % 4)];
}

Coordinate argument_of(const DiscrepancyKernel& kernel) {
  const Coordinate first = kernel.fields.front().of;
  const bool of_one = all_of(kernel.fields, having(&DiscrepancyField::of, first));
  return of_one ? first : Coordinate::place;
}

/// Length of a field on the bed; for an angle or a pull converted by its range over the bed.
double length_on_bed_mm(const Analysis& a, const DiscrepancyField& field) {
  if (unit_of(field.of) == "mm" || field.of == Coordinate::visit) return field.length;
  std::vector<double> values;
  std::vector<double> x;
  for (const SystemPlace& place : a.system.places) {
    values.push_back(value_at(place, field.of));
    x.push_back(place.mark.x_mm);
  }
  const auto range = [](const std::vector<double>& all) {
    const auto [low, high] = minmax_element(all);
    return *high - *low;
  };
  return field.length * range(x) / std::max(range(values), 1e-12);
}

/// The discrepancy's properties, averaged by weight over all models with one.
struct Said {
  std::map<Coordinate, double> of;
  std::map<Enters, double> enters;
  double log_length = 0.0;
  double weight = 0.0;
};

Said said_of(const Analysis& a) {
  Said said;
  for (const CandidateModel& model : a.comparison.models) {
    if (model.discrepancy < 0) continue;
    const DiscrepancyKernel& kernel =
        a.system.discrepancies->kernels[a.system.discrepancies->kernel_of(model.discrepancy)];
    const double p = a.comparison.probability(model);
    said.of[argument_of(kernel)] += p;
    said.enters[entry_of(kernel)] += p;
    said.log_length += p * std::log(length_on_bed_mm(a, kernel.fields.front()));
    said.weight += p;
  }
  return said;
}

template <class Key>
Key most_of(const std::map<Key, double>& weights, double whole, Key otherwise) {
  for (const auto& [key, weight] : weights) {
    if (weight > kMost * whole) return key;
  }
  return otherwise;
}

/// The decision's discrepancy in all rows, and its length in units of noise.
struct Pattern {
  VectorXd rows;
  double signal_to_noise = 0.0;
};
/// \pre The decision has a best discrepancy.
Pattern pattern_of(const Analysis& a) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const Estimate given =
      estimate(a.system, marginalised, a.decision.regressors, a.decision.best_discrepancy);
  Pattern pattern{given.left - given.left_given_discrepancy};
  pattern.signal_to_noise =
      length_in_noise(a.system, marginalised.kept, pattern.rows) / std::sqrt(given.noise_square);
  return pattern;
}

}  // namespace

Unexplained unexplained(const Analysis& a) {
  Unexplained result;
  result.probability = std::min(a.decision.discrepancy, 1.0);
  if (a.decision.best_discrepancy < 0) return result;
  const Pattern pattern = pattern_of(a);
  result.signal_to_noise = pattern.signal_to_noise;
  const KeptRows& kept = marginalised_system(a).kept;
  result.rms_mm = rms_of_units_mm(a.system, kept, pattern.rows);
  const Estimate plain = estimate_of(a, {});
  const double all_mm =
      rms_of_units_mm(a.system, kept, left_of_machine(a.system, plain, plain.left));
  result.share = all_mm > 0.0 ? std::min(std::pow(result.rms_mm / all_mm, 2), 1.0) : 0.0;
  const Said said = said_of(a);
  const Coordinate of = most_of(said.of, said.weight, Coordinate::place);
  if (chain_of(of) || of == Coordinate::x || of == Coordinate::y) result.follows = name(of);
  result.enters = most_of(said.enters, said.weight, Enters::mixed);
  result.length_mm = said.weight > 0.0 ? std::exp(said.log_length / said.weight) : 0.0;
  return result;
}

namespace {

constexpr double kSmoothMm = 450.0;  // length over which a discrepancy is looked for
constexpr int kLeftOverDraws = 999;
constexpr int kDegree = 4;
/// Share of the residual that a coordinate must explain, beyond what its terms explain by chance.
constexpr double kFollowsShare = 0.2;
/// Share of the variance unexplained by the place that must follow the visits before they are
/// named.
constexpr double kTimeOverPlace = 0.3;

/// Noise after a fit, one column per draw: residuals come out of a fit, so the noise that they are
/// compared with must too. The nuisances' share is put back, as left_of_machine() does.
///
///   y = B diag(s) u + z,  u and z standard normal;   r = y - X (X'X + P)^-1 X' y
///
/// X, the columns of settings, nuisances (B, with their sigmas s) and named causes; P, their prior
/// precision.
MatrixXd left_of_noise(const Analysis& a, int draws, std::uint64_t stream) {
  const Unknowns unknowns =
      unknowns_of(a.system, marginalised_system(a), a.estimate.free_regressors());
  // X in units of each unknown's prior sigma.
  const MatrixXd design = linear::scaled_columns(unknowns.design, unknowns.sigma);
  const Index n = design.rows();
  const Index shared = a.system.nuisances;
  const Index first = a.system.by_setting.cols() - shared;
  const auto by_nuisance = design.middleCols(first, shared);
  Random random(a.options.seed, stream);
  MatrixXd z(n, draws);
  VectorXd u(shared);
  for (const Index draw : each_below(draws)) {
    for (const Index i : each_below(n)) z(i, draw) = random.normal();
    for (const Index q : each_below(shared)) u(q) = random.normal();
    linear::add_product(z.col(draw), 1.0, by_nuisance, u);
  }
  // What is left, then minus the unknowns.
  const MatrixXd fitted = LowRankNoise(design).half_solve(z);
  MatrixXd left = fitted.topRows(n);
  linear::add_product(left, -1.0, by_nuisance, fitted.middleRows(n + first, shared));
  return left;
}

/// With V of the noise in the readings: are neighbours more alike, e'V^-1 K V^-1 e / e'V^-1 e, than in fitted noise?
double p_of_structure(const Analysis& a) {
  const KeptRows& kept = marginalised_system(a).kept;
  MatrixXd e(kept.size(), kLeftOverDraws + 1);
  e.col(0) = kept(left_of_machine(a.system, a.estimate, a.estimate.left));
  constexpr std::uint64_t kStream = 63;
  e.rightCols(kLeftOverDraws) = left_of_noise(a, kLeftOverDraws, kStream);
  const MatrixXd factor =
      kept(discrepancy_factor(a.system, {{{Coordinate::place, kSmoothMm}}, 1.0}));
  const MatrixXd weighed = nuisance_noise(a.system, kept).solve(e);
  const ArrayXd in_common = linear::inner(factor, weighed).colwise().squaredNorm();
  const ArrayXd all = (e.array() * weighed.array()).colwise().sum();
  const ArrayXd share = in_common / all.max(1e-300);
  const auto above = (share.tail(kLeftOverDraws) >= share(0)).count();
  return (as_double(above) + 1.0) / (kLeftOverDraws + 1.0);
}

/// Share of the squared residual that a quartic along the coordinate explains in either chain,
/// minus the share of noise that as many terms explain.
double share_along(const Analysis& a, Coordinate coordinate) {
  const Indices units = units_of_error(a);
  const auto n = std::ssize(units);
  if (n == 0) return 0.0;
  ArrayXd t(n);
  MatrixXd values(n, 2);
  for (const Index i : each_below(n)) {
    const SystemUnit& unit = a.system.units[units[as_size(i)]];
    t(i) = value_at(a.system.places[unit.places.front().place], coordinate);
    values.row(i) = unit.unwhitened(a.estimate.left).transpose();
  }
  const double low = t.minCoeff();
  const double range = t.maxCoeff() - low;
  if (!(range > 0.0)) return 0.0;
  MatrixXd basis = MatrixXd::Ones(n, kDegree + 1);
  const ArrayXd x = 2.0 * (t - low) / range - 1.0;
  basis.col(1) = x;
  for (int k = 2; k <= kDegree; ++k)
    basis.col(k) = 2.0 * x * basis.col(k - 1).array() - basis.col(k - 2).array();
  MatrixXd rest = values;
  linear::add_product(rest, -1.0, basis, linear::least_squares(basis, values));
  const double of_noise = as_double(n - kDegree - 1) / as_double(n);
  return 1.0 - rest.squaredNorm() / (of_noise * std::max(values.squaredNorm(), 1e-300));
}

}  // namespace

LeftOver left_over(const Analysis& a) {
  LeftOver result;
  result.p_value = p_of_structure(a);
  if (a.decision.best_discrepancy >= 0) result.signal_to_noise = pattern_of(a).signal_to_noise;
  // A distance joins two places and is a function of neither.
  if (result.p_value >= kFalseAlarm || !a.session.reads_chains()) return result;
  using enum Coordinate;
  // If coordinates explain the same, the first is named.
  for (const Coordinate coordinate : {angle_left, angle_right, length_left, length_right,
                                      tension_left, tension_right, x, y, visit}) {
    const bool of_order = coordinate == visit;
    if (of_order && !a.session.ordered()) continue;
    const double share = share_along(a, coordinate);
    // Where the bed was visited in order, time and place run together: place is the simpler guess.
    const double needed =
        of_order ? result.share + kTimeOverPlace * (1.0 - result.share) : result.share;
    if (share > needed) {
      result.share = share;
      result.follows = of_order ? "order" : name(coordinate);
    }
  }
  if (result.share < kFollowsShare) result.follows.clear();
  return result;
}

}  // namespace chaintrue::grid::diagnosis
