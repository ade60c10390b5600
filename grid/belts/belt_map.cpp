// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belt_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "grid/precondition.hpp"

namespace chaintrue::grid {

using model::BedPoint;
using model::Belt;
using model::BeltFailure;
using model::FramePoint;
using model::MarkPoint;

namespace {

using belts::kAnchorUnknowns;
using belts::kFrameUnknowns;

double span_mm(const model::BeltMachine& machine, Belt belt, FramePoint place) {
  const model::Anchor& anchor = machine.anchors[belt];
  return std::hypot(place.x_mm - anchor.x_mm, place.y_mm - anchor.y_mm);
}

tl::expected<FramePoint, BeltFailure> end_of_spans(const model::BeltMachine& machine,
                                                   double left_mm,
                                                   double right_mm) {
  const auto& a = machine.anchors;
  return model::crossing({a.tl.x_mm, a.tl.y_mm}, left_mm, {a.tr.x_mm, a.tr.y_mm}, right_mm);
}

/// Anchors, logarithm of the scale, displacements.
Eigen::VectorXd unknowns_of(const BeltsFit& fit, const HolesBesideBelts* holes) {
  const bool smooth = holes != nullptr && holes->displacement;
  const Eigen::Index moved = smooth ? holes->displacement->at_mm.size() : 0;
  Eigen::VectorXd unknowns(kFrameUnknowns + moved);
  unknowns.head<kAnchorUnknowns>() = belts::anchors_of(fit.machine);
  unknowns[kAnchorUnknowns] = fit.scale ? std::log(fit.scale->factor) : 0.0;
  if (smooth) unknowns.tail(moved) = holes->displacement->at_mm;
  return unknowns;
}

Eigen::MatrixXd covariance_of(const BeltsFit& fit, const HolesBesideBelts* holes) {
  if (holes != nullptr) return holes->covariance;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kFrameUnknowns, kFrameUnknowns);
  covariance.topLeftCorner<kAnchorUnknowns, kAnchorUnknowns>() = fit.covariance_mm2;
  if (fit.scale) {
    covariance(kAnchorUnknowns, kAnchorUnknowns) =
        std::pow(fit.scale->sigma / fit.scale->factor, 2);
  }
  return covariance;
}

/// The tool comes no nearer to an anchor than arm and extension are long.
interp::Rectangle domain_of(const model::BeltMachine& machine) {
  const FramePoint centre = model::centre_of(machine);
  const auto& a = machine.anchors;
  const double reach = model::reach_mm(machine);
  return {std::min(a.tl.x_mm, a.bl.x_mm) + reach - centre.x_mm,
          std::max(a.tr.x_mm, a.br.x_mm) - reach - centre.x_mm,
          reach - centre.y_mm,
          std::max(a.tl.y_mm, a.tr.y_mm) - reach - centre.y_mm};
}

/// The shift and turn that lay `from` on `to`, by least squares.
model::SheetPlacement laid(const std::vector<MarkPoint>& from, const std::vector<BedPoint>& to) {
  const auto count = static_cast<double>(from.size());
  MarkPoint a;
  BedPoint b;
  for (std::size_t i = 0; i < from.size(); ++i) {
    a = {a.x_mm + from[i].x_mm / count, a.y_mm + from[i].y_mm / count};
    b = {b.x_mm + to[i].x_mm / count, b.y_mm + to[i].y_mm / count};
  }
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double x = from[i].x_mm - a.x_mm;
    const double y = from[i].y_mm - a.y_mm;
    const double u = to[i].x_mm - b.x_mm;
    const double v = to[i].y_mm - b.y_mm;
    along += x * u + y * v;
    across += x * v - y * u;
  }
  model::SheetPlacement sheet{0.0, 0.0, std::atan2(across, along)};
  const BedPoint turned = sheet.to_bed(a);
  sheet.x_mm = b.x_mm - turned.x_mm;
  sheet.y_mm = b.y_mm - turned.y_mm;
  return sheet;
}

}  // namespace

model::BeltMachine machine_in_force(const BeltsFit& fit) {
  belts::AnchorVector stated;
  for (Eigen::Index i = 0; i < kAnchorUnknowns; ++i) {
    const auto& one = fit.coordinates[static_cast<std::size_t>(i)].stated_mm;
    if (!one) throw precondition("anchors in force that nobody stated");
    stated[i] = *one;
  }
  return belts::with_anchors(fit.machine, stated);
}

model::BeltMachine paying_out(model::BeltMachine machine) {
  machine.lengths = model::BeltLengths::belt;
  return machine;
}

BedPoint BeltMap::Placing::on_sheet(FramePoint place) const {
  MarkPoint raw{factor * (place.x_mm - centre.x_mm), factor * (place.y_mm - centre.y_mm)};
  if (displacement) {
    const Eigen::Vector2d beside = displacement->at(raw);
    raw.x_mm += beside.x();
    raw.y_mm += beside.y();
  }
  return sheet.to_bed(raw);
}

FramePoint BeltMap::Placing::in_frame(BedPoint on_sheet) const {
  // Each round takes the error down to the displacement's slope, a few thousandths of it.
  constexpr int kMostRounds = 40;
  constexpr double kConvergedMm = 1e-10;
  const MarkPoint there = sheet.to_mark(on_sheet);
  MarkPoint raw = there;
  for (int round = 0; displacement && round < kMostRounds; ++round) {
    const Eigen::Vector2d beside = displacement->at(raw);
    const MarkPoint next{there.x_mm - beside.x(), there.y_mm - beside.y()};
    const double moved = std::hypot(next.x_mm - raw.x_mm, next.y_mm - raw.y_mm);
    raw = next;
    if (moved < kConvergedMm) break;
  }
  return {centre.x_mm + raw.x_mm / factor, centre.y_mm + raw.y_mm / factor};
}

BeltMap::Placing BeltMap::placing(const Eigen::VectorXd& unknowns) const {
  Placing result;
  result.machine = belts::with_anchors(in_force_, unknowns.head<kAnchorUnknowns>());
  result.factor = std::exp(unknowns[kAnchorUnknowns]);
  result.centre = model::centre_of(in_force_);
  if (displacement_) {
    DisplacementParts parts = *displacement_;
    parts.at_mm = unknowns.tail(parts.at_mm.size());
    result.displacement = std::make_shared<const ToolDisplacement>(std::move(parts));
  }
  lay(result);
  return result;
}

void BeltMap::lay(Placing& placing) const {
  if (by_edges_) {
    placing.sheet = {by_edges_->x(), by_edges_->y(), by_edges_->z()};
    return;
  }
  placing.sheet = {};
  std::vector<MarkPoint> from;
  std::vector<BedPoint> to;
  for (const Reference& reference : references_) {
    const auto place = end_of_spans(placing.machine, reference.left_mm, reference.right_mm);
    if (!place) continue;
    from.push_back(model::identity_placement(placing.on_sheet(*place)));
    to.push_back(reference.commanded);
  }
  if (from.size() >= 2) placing.sheet = laid(from, to);
}

BeltMap::BeltMap(const BeltsFit& fit, const HolesBesideBelts* holes)
    : in_force_(paying_out(holes != nullptr ? holes->machine : machine_in_force(fit))) {
  const FramePoint centre = model::centre_of(in_force_);
  if (holes != nullptr) {
    displacement_ = holes->displacement;
    by_edges_ = holes->sheet;
    for (const BeltHole& hole : holes->holes) {
      const FramePoint meant = model::to_frame(in_force_, hole.commanded);
      references_.push_back({hole.commanded,
                             span_mm(in_force_, Belt::tl, meant),
                             span_mm(in_force_, Belt::tr, meant)});
    }
  } else {
    for (const FittedPlace& place : fit.places) {
      const double left = span_mm(fit.machine, Belt::tl, place.at);
      const double right = span_mm(fit.machine, Belt::tr, place.at);
      // Where the controller took the tool to be.
      const auto believed = end_of_spans(in_force_, left, right);
      if (!believed) continue;
      references_.push_back({{(believed->x_mm - centre.x_mm) / in_force_.scale_x,
                              (believed->y_mm - centre.y_mm) / in_force_.scale_y},
                             left,
                             right});
    }
  }
  const Eigen::VectorXd unknowns = unknowns_of(fit, holes);
  best_ = placing(unknowns);
  const Eigen::MatrixXd covariance = covariance_of(fit, holes);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  for (Eigen::Index i = 0; i < unknowns.size(); ++i) {
    const double variance = eigen.eigenvalues()[i];
    // Below this a direction adds less than rounding to what the others say.
    if (!(variance > 1e-12 * eigen.eigenvalues().maxCoeff())) continue;
    others_.push_back(placing(unknowns + std::sqrt(variance) * eigen.eigenvectors().col(i)));
  }
  std::vector<MarkPoint> measured;
  for (const Reference& reference : references_)
    measured.push_back(model::identity_placement(reference.commanded));
  area_ = std::make_shared<const MeasuredArea>(measured, domain_of(in_force_));
}

tl::expected<model::ChainLengths, BeltFailure> BeltMap::lengths(BedPoint sheet) const {
  const FramePoint place = best_.in_frame(sheet);
  const auto left = model::reading_at(best_.machine, Belt::tl, place);
  if (!left) return tl::unexpected(left.error());
  const auto right = model::reading_at(best_.machine, Belt::tr, place);
  if (!right) return tl::unexpected(right.error());
  return model::ChainLengths{left->length_mm, right->length_mm};
}

tl::expected<BedPoint, BeltFailure> BeltMap::tool(model::ChainLengths lengths) const {
  const auto place = model::place_of_upper(best_.machine, lengths.left_mm, lengths.right_mm);
  if (!place) return tl::unexpected(place.error());
  return best_.on_sheet(*place);
}

model::ChainLengths BeltMap::sigma(BedPoint sheet) const {
  const FramePoint place = best_.in_frame(sheet);
  model::ChainLengths variance;
  for (const Placing& other : others_) {
    const FramePoint there = other.in_frame(sheet);
    variance.left_mm += std::pow(
        span_mm(other.machine, Belt::tl, there) - span_mm(best_.machine, Belt::tl, place), 2);
    variance.right_mm += std::pow(
        span_mm(other.machine, Belt::tr, there) - span_mm(best_.machine, Belt::tr, place), 2);
  }
  const double own =
      best_.displacement ? best_.displacement->own_variance_mm2(best_.sheet.to_mark(sheet)) : 0.0;
  return {std::sqrt(variance.left_mm + own), std::sqrt(variance.right_mm + own)};
}

double BeltMap::tool_sigma_mm(BedPoint sheet) const {
  const FramePoint place = best_.in_frame(sheet);
  const double left = span_mm(best_.machine, Belt::tl, place);
  const double right = span_mm(best_.machine, Belt::tr, place);
  double variance = 0.0;
  for (const Placing& other : others_) {
    const auto there = end_of_spans(other.machine, left, right);
    if (!there) continue;
    const BedPoint tool = other.on_sheet(*there);
    variance += std::pow(tool.x_mm - sheet.x_mm, 2) + std::pow(tool.y_mm - sheet.y_mm, 2);
  }
  const double own =
      best_.displacement ? best_.displacement->own_variance_mm2(best_.sheet.to_mark(sheet)) : 0.0;
  return std::sqrt(variance + 2.0 * own);
}

}  // namespace chaintrue::grid
