// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belt_map.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid {

using model::BeltFailure;

namespace {

using belts::kFrameUnknowns;

double span_mm(const BeltMachine& machine, Belt belt, FramePoint place) {
  const model::Anchor& anchor = machine.anchors[belt];
  return distance_mm(place, anchor);
}

tl::expected<FramePoint, BeltFailure> end_of_spans(const BeltMachine& machine, double left_mm,
                                                   double right_mm) {
  const auto& a = machine.anchors;
  return model::crossing({a.tl.x_mm, a.tl.y_mm}, left_mm, {a.tr.x_mm, a.tr.y_mm}, right_mm);
}

/// Anchors, logarithm of the scale, displacements.
VectorXd unknowns_of(const BeltsFit& fit, const HolesWithBelts* holes) {
  const bool smooth = holes != nullptr && holes->displacement;
  const Index moved = smooth ? holes->displacement->at_mm.size() : 0;
  VectorXd unknowns(kFrameUnknowns + moved);
  unknowns.head<kAnchorUnknowns>() = anchors_of(fit.machine);
  unknowns[kAnchorUnknowns] = fit.scale ? std::log(fit.scale->factor) : 0.0;
  if (smooth) unknowns.tail(moved) = holes->displacement->at_mm;
  return unknowns;
}

MatrixXd covariance_of(const BeltsFit& fit, const HolesWithBelts* holes) {
  if (holes != nullptr) return holes->covariance;
  MatrixXd covariance = MatrixXd::Zero(kFrameUnknowns, kFrameUnknowns);
  covariance.topLeftCorner<kAnchorUnknowns, kAnchorUnknowns>() = fit.covariance_mm2;
  if (fit.scale) {
    covariance(kAnchorUnknowns, kAnchorUnknowns) =
        std::pow(fit.scale->sigma / fit.scale->factor, 2);
  }
  return covariance;
}

/// The tool comes no nearer to an anchor than arm and extension are long.
interp::Rectangle domain_of(const BeltMachine& machine) {
  const FramePoint centre = centre_of(machine);
  const auto& a = machine.anchors;
  const double reach = reach_mm(machine);
  return {std::min(a.tl.x_mm, a.bl.x_mm) + reach - centre.x_mm,
          std::max(a.tr.x_mm, a.br.x_mm) - reach - centre.x_mm, reach - centre.y_mm,
          std::max(a.tl.y_mm, a.tr.y_mm) - reach - centre.y_mm};
}

/// Places that determine the sheet's placement.
struct Reference {
  BedPoint commanded;
  double left_mm = 0.0;   ///< level span of the top left belt
  double right_mm = 0.0;  ///< of the top right one
};

/// The tool's position by a fit, for any values of its unknowns.
class Placing {
 public:
  Placing(const BeltsFit& fit, const HolesWithBelts* holes, BeltMachine in_force)
      : in_force_(std::move(in_force)) {
    if (holes != nullptr) {
      displacement_ = holes->displacement;
      by_edges_ = holes->sheet;
      refer_to_holes(*holes);
    } else {
      refer_to_places(fit);
    }
  }

  /// `lengths` is what the mechanism's lengths count.
  PlacedMechanism at(const VectorXd& unknowns, model::BeltLengths lengths) const {
    BeltMachine machine = with_anchors(in_force_, unknowns.head<kAnchorUnknowns>());
    const FramePoint centre = centre_of(in_force_);
    SheetInFrame sheet{{}, std::exp(unknowns[kAnchorUnknowns]), {centre.x_mm, centre.y_mm}};
    if (displacement_) {
      DisplacementParts parts = *displacement_;
      parts.at_mm = unknowns.tail(parts.at_mm.size());
      sheet.displacement = std::make_shared<const ToolDisplacement>(std::move(parts));
    }
    lay(machine, sheet);
    machine.lengths = lengths;
    return {make_belt_mechanism(machine), std::move(sheet)};
  }

  std::vector<MarkPoint> measured() const {
    return mapped(references_, [](const Reference& reference) {
      return identity_placement(reference.commanded);
    });
  }

 private:
  void refer_to_holes(const HolesWithBelts& holes) {
    for (const BeltHole& hole : holes.holes) {
      const FramePoint meant = to_frame(in_force_, hole.commanded);
      references_.push_back({hole.commanded, span_mm(in_force_, Belt::tl, meant),
                             span_mm(in_force_, Belt::tr, meant)});
    }
  }

  void refer_to_places(const BeltsFit& fit) {
    const FramePoint centre = centre_of(in_force_);
    for (const FittedPlace& place : fit.places) {
      const double left = span_mm(fit.machine, Belt::tl, place.at);
      const double right = span_mm(fit.machine, Belt::tr, place.at);
      // Where the controller assumed the tool to be.
      const auto believed = end_of_spans(in_force_, left, right);
      if (!believed) continue;
      references_.push_back({{(believed->x_mm - centre.x_mm) / in_force_.scale_x,
                              (believed->y_mm - centre.y_mm) / in_force_.scale_y},
                             left,
                             right});
    }
  }

  void lay(const BeltMachine& machine, SheetInFrame& placed) const {
    if (by_edges_) {
      placed.laid = {by_edges_->x(), by_edges_->y(), by_edges_->z()};
      return;
    }
    std::vector<MarkPoint> from;
    std::vector<BedPoint> to;
    for (const Reference& reference : references_) {
      const auto place = end_of_spans(machine, reference.left_mm, reference.right_mm);
      if (!place) continue;
      from.push_back(identity_placement(placed.on_sheet({place->x_mm, place->y_mm})));
      to.push_back(reference.commanded);
    }
    if (from.size() >= 2) placed.laid = laid_on(from, to);
  }

  BeltMachine in_force_;
  std::vector<Reference> references_;
  std::optional<DisplacementParts> displacement_;
  std::optional<Vector3d> by_edges_;
};

MechanismMap map_of(const BeltsFit& fit, const HolesWithBelts* holes, const BeltMachine& in_force) {
  using model::BeltLengths;
  const Placing placing(fit, holes, in_force);
  const VectorXd unknowns = unknowns_of(fit, holes);
  // Level spans: a belt's slant carries no information about an error.
  MechanismSpread spread =
      spread_about(unknowns, covariance_of(fit, holes),
                   [&](const VectorXd& values) { return placing.at(values, BeltLengths::span); });
  return {placing.at(unknowns, BeltLengths::belt), std::move(spread),
          MeasuredArea(placing.measured(), domain_of(in_force))};
}

/// The machine as stated before the fit.
BeltMachine machine_in_force(const BeltsFit& fit) {
  AnchorVector stated;
  for (const Index i : each_below(kAnchorUnknowns)) {
    const auto& one = fit.coordinates[as_size(i)].stated_mm;
    if (!one) throw precondition("anchors in force that nobody gave");
    stated[i] = *one;
  }
  return with_anchors(fit.machine, stated);
}

BeltMachine commanded_by(const BeltsFit& fit, const HolesWithBelts* holes) {
  return paying_out(holes != nullptr ? holes->machine : machine_in_force(fit));
}

}  // namespace

BeltMachine paying_out(BeltMachine machine) {
  machine.lengths = model::BeltLengths::belt;
  return machine;
}

BeltMap::BeltMap(const BeltsFit& fit, const HolesWithBelts* holes)
    : MechanismMap(map_of(fit, holes, commanded_by(fit, holes))),
      in_force_(commanded_by(fit, holes)),
      knows_scale_(fit.scale.has_value()) {}

tl::expected<LengthsAnswer, MapFailure> BeltMap::query(BedPoint point) const {
  auto answer = MechanismMap::query(point);
  if (answer && !knows_scale_) answer->tool_sigma_mm.reset();
  return answer;
}

}  // namespace chaintrue::grid
