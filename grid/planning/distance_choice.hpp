// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chooses the distances to measure between given holes, and to the sheet's edges. Private to
/// grid/planning.
///
/// Notation
///   x   the unknowns of a plan: the machine's eight, then the sheet's placement
///   S   their covariance
///   A   the distances' derivative by x
///   V   the readings' covariance, (2) of tape_distances.hpp
///   C   the criterion, L' L
///
/// Measuring distance k alone lowers trace(C S) by
///
///   |b_k|^2 / K_kk,  b = L S A',  K = A S A' + V                                            (1)
///
/// and changes b and K of the others to b - b_k K_k' / K_kk and K - K_k K_k' / K_kk, less the
/// tape's part.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/planning/holes_plan.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

/// The machine's, then the sheet's shift in x, in y and its rotation.
inline constexpr Index kPlanUnknowns = estimation::kMachineUnknowns + 3;

/// A candidate position of a hole, and the derivative of the hole's position on the sheet by the
/// unknowns.
struct PlannedPlace {
  MarkPoint place;
  Eigen::Matrix<double, 2, kPlanUnknowns> by_unknown;
};

/// The set to plan, without holes and distances.
inline MeasuredHoles empty_set(const Machine& machine, const HolesPlanRequest& request) {
  MeasuredHoles set;
  set.name = "plan";
  set.machine = machine;
  set.tape.sigma_mm = request.tape_sigma_mm;
  set.hole_sigma_mm = request.hole_sigma_mm;
  return set;
}

/// How single choices are exchanged for others.
struct Exchange {
  int sweeps;         ///< over all of them, at most
  double worthwhile;  ///< share by which an exchange has to lower the value
  WorkStep step{};
  Progress progress{};
};

/// Exchanges single ones of those chosen as long as this lowers a value: `least` of those chosen,
/// `value_with(i)` with another one at i. \returns the least value. Source: A. Atkinson, A. Donev and
/// R. Tobias, Optimum Experimental Designs, with SAS (2007), section 12.3.
template <class One, class ValueWith>
double exchange(Exchange how, const std::vector<One>& others, std::vector<One>& chosen,
                double least, const ValueWith& value_with) {
  bool moved = true;
  for (how.step.pass = 1; how.step.pass <= how.sweeps && moved; ++how.step.pass) {
    moved = false;
    for (const auto i : each_index(chosen)) {
      how.step.share = as_double(i) / as_double(chosen.size());
      tell(how.progress, how.step);
      for (const One& other : others) {
        if (contains(chosen, other)) continue;
        const One before = std::exchange(chosen[i], other);
        const double value = value_with(i);
        if (value < least * (1.0 - how.worthwhile)) {
          least = value;
          moved = true;
        } else {
          chosen[i] = before;
        }
      }
    }
  }
  return least;
}

/// Immutable, thread safe.
class DistanceChooser {
 public:
  using Holes = std::vector<const PlannedPlace*>;

  /// `prior` is S before any measurement; `root` is L.
  DistanceChooser(const Machine& machine, const HolesPlanRequest& request, MatrixXd prior,
                  MatrixXd root)
      : request_(request),
        frame_(empty_set(machine, request)),
        prior_(std::move(prior)),
        root_(std::move(root)) {}

  struct Choice {
    std::vector<HoleDistance> distances;
    double variance_mm2 = 0.0;  ///< trace(C S)
  };

  /// trace(C S) after the distances that are added one by one, each time the one that lowers it most.
  double variance_mm2(const Holes& holes) const {
    Indices chosen;
    return add_best(measurable(holes, in_reach(holes)), chosen);
  }

  /// Those distances, single ones exchanged as long as an exchange is an improvement.
  Choice choose(const Holes& holes) const {
    const Measurable all = measurable(holes, in_reach(holes));
    Indices chosen;
    Choice choice{{}, add_best(all, chosen)};
    choice.variance_mm2 =
        exchange({5, 1e-6, {"which distances are measured", 2, 2}, request_.progress},
                 numbers_below(all.distances.size()), chosen, choice.variance_mm2,
                 [&](std::size_t) { return variance_mm2(all, chosen); });
    for (const std::size_t k : chosen) choice.distances.push_back(all.distances[k]);
    return choice;
  }

  /// S after these measurements.
  MatrixXd covariance(const Holes& holes, const std::vector<HoleDistance>& distances) const {
    const Measurable measured = measurable(holes, distances);
    MatrixXd k = measured.known;
    k.diagonal().array() += request_.tape_sigma_mm * request_.tape_sigma_mm;
    const MatrixXd cross = linear::product(prior_, linear::transposed(measured.by_unknown));
    return prior_ - linear::product(cross, linear::Cholesky(std::move(k)).solve(cross.transpose()));
  }

 private:
  /// All distances that a tape can measure, before any measurement.
  struct Measurable {
    std::vector<HoleDistance> distances;
    MatrixXd by_unknown;  ///< A
    MatrixXd known;       ///< K without the tape's part
    MatrixXd pull;        ///< b
  };
  Measurable measurable(const Holes& holes, std::vector<HoleDistance> distances) const {
    MeasuredHoles set = frame_;
    set.distances = std::move(distances);
    const observation::DistanceGeometry geometry =
        observation::distance_geometry(set, mapped(holes, &PlannedPlace::place));
    const observation::DistanceNoise noise = observation::distance_noise(set, geometry);
    MatrixXd marks_by_unknown(2 * std::ssize(holes), kPlanUnknowns);
    for (const auto i : each_index(holes)) {
      marks_by_unknown.middleRows<2>(2 * as_index(i)) = holes[i]->by_unknown;
    }
    Measurable all;
    all.by_unknown = geometry.by_mark * marks_by_unknown;
    const MatrixXd cross = prior_ * all.by_unknown.transpose();
    all.known = all.by_unknown * cross + noise.holes_mm2 + noise.size_mm2 + noise.tape_zero_mm2;
    all.pull = root_ * cross;
    all.distances = std::move(set.distances);
    return all;
  }

  /// \param chosen their numbers
  double add_best(Measurable all, Indices& chosen) const {
    // Choices of equal worth, such as mirror images, differ by rounding, which grows to 1e-9 over many
    // updates; the first one is kept.
    constexpr double kBetterChoice = 1.0 + 1e-6;
    const double tape2 = request_.tape_sigma_mm * request_.tape_sigma_mm;
    const auto wanted = std::min(as_size(distances_of(request_)), all.distances.size());
    double variance_mm2 = linear::carried(root_, prior_).trace();
    while (chosen.size() < wanted) {
      Index best = -1;
      double best_gain = 0.0;
      for (const Index k : each_below(std::ssize(all.distances))) {
        if (contains(chosen, as_size(k))) continue;
        const double gain = all.pull.col(k).squaredNorm() / (tape2 + all.known(k, k));
        if (best >= 0 && gain <= best_gain * kBetterChoice) continue;
        best_gain = gain;
        best = k;
      }
      chosen.push_back(as_size(best));
      variance_mm2 -= best_gain;
      const VectorXd with = all.known.col(best) / (tape2 + all.known(best, best));
      all.pull -= VectorXd(all.pull.col(best)) * with.transpose();
      all.known -= VectorXd(all.known.col(best)) * with.transpose();
    }
    return variance_mm2;
  }

  std::vector<HoleDistance> in_reach(const Holes& holes) const {
    std::vector<HoleDistance> distances;
    for (const auto a : each_index(holes)) {
      for (std::size_t b = a + 1; b < holes.size(); ++b) {
        const double way_mm = distance_mm(holes[a]->place, holes[b]->place);
        if (way_mm <= request_.longest_mm) distances.push_back({.from = a, .to = b});
      }
    }
    if (!request_.edges) return distances;
    // A tape is held square to an edge by eye, to a degree: 0.15 mm at this length.
    constexpr double kLongestToEdgeMm = 1000.0;
    const Bed& bed = frame_.machine->bed;
    const double longest_mm = std::min(request_.longest_mm, kLongestToEdgeMm);
    for (const auto a : each_index(holes)) {
      // The nearer of two edges: it is as informative.
      const MarkPoint at = holes[a]->place;
      const SheetEdge edges[] = {at.x_mm > 0.0 ? SheetEdge::right : SheetEdge::left,
                                 at.y_mm < 0.0 ? SheetEdge::bottom : SheetEdge::top};
      const double way_mm[] = {0.5 * bed.width_mm - std::abs(at.x_mm),
                               0.5 * bed.height_mm - std::abs(at.y_mm)};
      for (std::size_t i = 0; i < 2; ++i) {
        if (way_mm[i] <= longest_mm) distances.push_back({.from = a, .edge = edges[i]});
      }
    }
    return distances;
  }

  /// trace(C S) after measuring those with these numbers.
  double variance_mm2(const Measurable& all, const Indices& chosen) const {
    MatrixXd k = all.known(chosen, chosen);
    k.diagonal().array() += request_.tape_sigma_mm * request_.tape_sigma_mm;
    const MatrixXd pull = all.pull(Eigen::all, chosen);
    const MatrixXd half = linear::Cholesky(std::move(k)).half_solve(pull.transpose());
    return linear::carried(root_, prior_).trace() - half.squaredNorm();
  }

  HolesPlanRequest request_;
  MeasuredHoles frame_;  ///< the machine, the sheet and the sigmas, without holes
  MatrixXd prior_;
  MatrixXd root_;
};

}  // namespace chaintrue::grid
