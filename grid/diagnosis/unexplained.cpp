// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/findings.hpp"

namespace chaintrue::grid::diagnosis {

std::string_view name(Enters enters) {
  constexpr std::string_view kNames[] = {
      "left", "right", "alike", "opposite", "x", "y", "mixed", "along", "outwards",
      "tl", "tr", "bl", "br"};
  return kNames[static_cast<std::size_t>(enters)];
}

namespace {

/// What most of the weight must say before it is said.
constexpr double kMost = 0.5;

Enters entry_of(const DiscrepancyKernel& kernel) {
  const DiscrepancyField& field = kernel.fields.front();
  const bool one_way = all_of(kernel.fields, [&](const DiscrepancyField& other) {
    return other.direction_rad == field.direction_rad;
  });
  if (!one_way || !field.direction_rad) return Enters::mixed;
  // The nearest of the four directions of a half turn; those between two are mixed.
  const double eighths = *field.direction_rad / (0.25 * std::numbers::pi);
  const long nearest = std::lround(eighths);
  if (std::abs(eighths - static_cast<double>(nearest)) > 0.4) return Enters::mixed;
  if (field.entry == FieldEntry::tool) {
    return nearest % 2 != 0 ? Enters::mixed : nearest % 4 == 0 ? Enters::x : Enters::y;
  }
  constexpr std::array kOfChains = {Enters::left, Enters::equal, Enters::right, Enters::opposite};
  return kOfChains[as_size(nearest % 4)];
}

Coordinate argument_of(const DiscrepancyKernel& kernel) {
  const Coordinate first = kernel.fields.front().of;
  const bool of_one =
      all_of(kernel.fields, [&](const DiscrepancyField& f) { return f.of == first; });
  return of_one ? first : Coordinate::place;
}

/// Length of a field on the bed: of an angle or a pull by how much of it the bed holds.
double length_on_bed_mm(const Analysis& a, const DiscrepancyField& field) {
  if (unit_of(field.of) == "mm" || field.of == Coordinate::visit) return field.length;
  std::vector<double> values;
  std::vector<double> x;
  for (const SystemPlace& place : a.system.places) {
    values.push_back(value_at(place, field.of));
    x.push_back(place.mark.x_mm);
  }
  const auto range = [](const std::vector<double>& all) {
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    return *high - *low;
  };
  return field.length * range(x) / std::max(range(values), 1e-12);
}

/// What the weight of all models with a discrepancy says of it.
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
    const DiscrepancyKernel& kernel = a.system.discrepancies->kernels[a.system.discrepancies->kernel_of(model.discrepancy)];
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

double mean_square_mm2(const Analysis& a, const Eigen::VectorXd& whitened) {
  const std::vector<bool>& outliers = marginalised_system(a).outliers;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t u = 0; u < outliers.size(); ++u) {
    if (outliers[u]) continue;
    sum += error_of_unit(a.system, whitened, u).squaredNorm();
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

Unexplained unexplained(const Analysis& a) {
  Unexplained result;
  result.probability = std::min(a.decision.discrepancy, 1.0);
  if (a.decision.best_discrepancy < 0) return result;
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const Estimate given =
      estimate(a.system, marginalised, a.decision.regressors, a.decision.best_discrepancy);
  const Eigen::VectorXd pattern = given.left - given.left_given_discrepancy;
  result.signal_to_noise =
      length_in_noise(a.system, marginalised.kept, pattern) / std::sqrt(given.noise_square);
  const double own = mean_square_mm2(a, pattern);
  result.rms_mm = std::sqrt(own);
  const Estimate plain = estimate_of(a, {});
  const double all = mean_square_mm2(a, left_of_machine(a.system, plain, plain.left));
  result.share = all > 0.0 ? std::min(own / all, 1.0) : 0.0;
  const Said said = said_of(a);
  const Coordinate of = most_of(said.of, said.weight, Coordinate::place);
  if (chain_of(of) || of == Coordinate::x || of == Coordinate::y) result.follows = name(of);
  result.enters = most_of(said.enters, said.weight, Enters::mixed);
  result.length_mm = said.weight > 0.0 ? std::exp(said.log_length / said.weight) : 0.0;
  return result;
}

}  // namespace chaintrue::grid::diagnosis
