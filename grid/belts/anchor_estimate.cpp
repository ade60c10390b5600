// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/anchor_estimate.hpp"

#include "model/belts/belt_mechanism.hpp"

namespace chaintrue::grid::belts {

using model::kBelts;

observation::BeltLengthReadings readings_of(const MeasuredBelts& belts, const Counting& counting) {
  std::vector<observation::LengthsAtPlace> places;
  bool ordered = !belts.points.empty();
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    const BeltPoint& point = belts.points[k];
    observation::LengthsAtPlace place;
    place.index = k;
    place.name = std::to_string(k + 1);
    place.lengths_mm.resize(static_cast<Eigen::Index>(kBelts.size()));
    for (const model::Belt belt : kBelts) {
      place.lengths_mm[static_cast<Eigen::Index>(belt)] = point.lengths_mm[belt];
      place.counting.push_back(counting.at(k)[belt]);
      place.visit.pulled.push_back(is_pulled(point, belt));
    }
    place.visit.order = point.order.value_or(0);
    ordered = ordered && point.order.has_value();
    places.push_back(std::move(place));
  }
  // Of the noise nothing is said beforehand.
  return {std::move(places), ordered, {.length_mm = 1.0}, 0.0};
}

estimation::EstimationInput anchor_input(const MeasuredBelts& belts,
                                         const Counting& counting,
                                         const AnchorVector& start) {
  auto readings =
      std::make_shared<const observation::BeltLengthReadings>(readings_of(belts, counting));
  estimation::EstimationInput input;
  model::BeltMachine unknown = belts.machine;
  unknown.anchors_known = false;
  input.mechanism = model::make_belt_mechanism(unknown)->with_values(start);
  input.fixed_weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(readings->units().size()));
  input.observations.push_back(std::move(readings));
  input.noise.knowledge = interp::NoiseKnowledge::unknown;
  input.noise_prior = interp::SmoothingPrior::none;
  input.surface = estimation::SurfaceUse::none;
  input.domain = {0.0, 1.0, 0.0, 1.0};  // of a surface, which there is none
  return input;
}

tl::expected<estimation::Estimate, estimation::EstimationFailure> estimate_anchors(
    const MeasuredBelts& belts, const Counting& counting, const AnchorVector& start) {
  return estimation::estimate(anchor_input(belts, counting, start));
}

}  // namespace chaintrue::grid::belts
