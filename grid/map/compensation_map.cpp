// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/compensation_map.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace chaintrue::grid {

using model::BedPoint;
using model::ChainLengths;

std::string_view explain(MapFailure failure) {
  constexpr std::array<std::string_view, 3> kSentences = {
      "the point is off the bed that was measured",
      "the chains cannot hold the sled there",
      "no point of the bed was found for these chain lengths",
  };
  return kSentences[static_cast<std::size_t>(failure)];
}

namespace {

/// d/dt at t0 of the parabola through (t0, f0), (t1, f1), (t2, f2).
Eigen::VectorXd end_slope(const std::array<double, 3>& t,
                          const Eigen::VectorXd& f0,
                          const Eigen::VectorXd& f1,
                          const Eigen::VectorXd& f2) {
  const Eigen::VectorXd near = (f1 - f0) / (t[1] - t[0]);
  const Eigen::VectorXd far = (f2 - f0) / (t[2] - t[0]);
  return near - (far - near) * (t[1] - t[0]) / (t[2] - t[1]);
}

/// Of the lines that are the rows of `values`, at their first node or, reversed, at their last.
Eigen::VectorXd slopes_at_end(const std::vector<double>& nodes,
                              const Eigen::MatrixXd& values,
                              bool last) {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const auto at = [&](Eigen::Index i) { return last ? count - 1 - i : i; };
  const auto node = [&](Eigen::Index i) { return nodes[static_cast<std::size_t>(at(i))]; };
  if (count == 2) return (values.col(at(1)) - values.col(at(0))) / (node(1) - node(0));
  return end_slope(
      {node(0), node(1), node(2)}, values.col(at(0)), values.col(at(1)), values.col(at(2)));
}

}  // namespace

interp::EdgeSlopes parabola_slopes(const std::vector<double>& x_nodes_mm,
                                   const std::vector<double>& y_nodes_mm,
                                   const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd along_x = values.transpose();
  return {slopes_at_end(x_nodes_mm, along_x, false),
          slopes_at_end(x_nodes_mm, along_x, true),
          slopes_at_end(y_nodes_mm, values, false),
          slopes_at_end(y_nodes_mm, values, true)};
}

/// What answers at a mark; the kinds of surface differ only here.
class CompensationMap::Field {
 public:
  virtual ~Field() = default;
  [[nodiscard]] virtual tl::expected<Lengths, MapFailure> at(BedPoint mark) const = 0;
  [[nodiscard]] virtual Eigen::Matrix2d covariance(BedPoint mark, const Lengths& here) const = 0;
  [[nodiscard]] virtual BedPoint to_mark(BedPoint bed) const = 0;
  [[nodiscard]] virtual BedPoint to_bed(BedPoint mark) const = 0;
};

class CompensationMap::ModelField final : public Field {
 public:
  explicit ModelField(const ModelSurface& surface) : surface_(surface), model_(surface.machine) {}

  [[nodiscard]] tl::expected<Lengths, MapFailure> at(BedPoint mark) const override {
    const auto reading = model_.at(surface_.sheet.to_bed(mark));
    if (!reading) return tl::unexpected(MapFailure::unreachable);
    const auto corrected = surface_.residual.apply(
        mark, reading->lengths, reading->position_jacobian * surface_.sheet.rotation());
    return Lengths{corrected.lengths, corrected.mark_jacobian};
  }

  [[nodiscard]] Eigen::Matrix2d covariance(BedPoint mark, const Lengths& /*here*/) const override {
    const auto reading = model_.at(surface_.sheet.to_bed(mark));
    if (!reading) return Eigen::Matrix2d::Zero();
    const model::ChainReading unread(mark, reading->lengths, {});
    const auto line = unread.linearise(model_, surface_.sheet, surface_.settings);
    const Eigen::MatrixXd rows = design_rows(
        surface_.residual.basis, surface_.columns, mark, reading->lengths, line->setting_jacobian);
    const Eigen::MatrixXd spread =
        rows * surface_.covariance_factor.triangularView<Eigen::Lower>().toDenseMatrix();
    return spread * spread.transpose();
  }

  [[nodiscard]] BedPoint to_mark(BedPoint bed) const override {
    return surface_.sheet.to_mark(bed);
  }
  [[nodiscard]] BedPoint to_bed(BedPoint mark) const override {
    return surface_.sheet.to_bed(mark);
  }

 private:
  ModelSurface surface_;
  model::ReadingModel model_;
};

/// Readings without noise on a lattice.
class CompensationMap::LatticeField final : public Field {
 public:
  LatticeField(const ModelSurface& surface, const MapNoise& noise)
      : sheet_(surface.sheet),
        scale_(surface.residual.scale),
        model_(surface.machine),
        splines_(surface.lattice.value()),
        noise_(noise) {}

  [[nodiscard]] tl::expected<Lengths, MapFailure> at(BedPoint mark) const override {
    const auto reading = model_.at(sheet_.to_bed(mark));
    if (!reading) return tl::unexpected(MapFailure::unreachable);
    const auto spline = splines_.at(mark);
    const Eigen::Vector2d factor(1.0 + scale_.left, 1.0 + scale_.right);
    Lengths here;
    here.lengths = {factor[0] * reading->lengths.left_mm + spline.left.value,
                    factor[1] * reading->lengths.right_mm + spline.right.value};
    here.mark_jacobian << spline.left.dx, spline.left.dy, spline.right.dx, spline.right.dy;
    here.mark_jacobian += factor.asDiagonal() * reading->position_jacobian * sheet_.rotation();
    return here;
  }

  [[nodiscard]] Eigen::Matrix2d covariance(BedPoint mark, const Lengths& here) const override {
    const Eigen::Matrix2d node = noise_.length_mm * noise_.length_mm * Eigen::Matrix2d::Identity() +
                                 noise_.position_mm * noise_.position_mm * here.mark_jacobian *
                                     here.mark_jacobian.transpose();
    return splines_.covariance(mark, noise_.factor_found * noise_.factor_found * node);
  }

  [[nodiscard]] BedPoint to_mark(BedPoint bed) const override { return sheet_.to_mark(bed); }
  [[nodiscard]] BedPoint to_bed(BedPoint mark) const override { return sheet_.to_bed(mark); }

 private:
  model::SheetPlacement sheet_;
  model::PerSide<double> scale_;
  model::ReadingModel model_;
  LatticeSplines splines_;
  MapNoise noise_;
};

class CompensationMap::DirectField final : public Field {
 public:
  DirectField(const DirectSurface& surface, const MapNoise& noise)
      : axes_(std::make_shared<const interp::TensorAxes>(
            surface.x_nodes_mm, surface.y_nodes_mm, surface.ends)),
        left_(axes_,
              surface.lengths_mm.left,
              parabola_slopes(surface.x_nodes_mm, surface.y_nodes_mm, surface.lengths_mm.left)),
        right_(axes_,
               surface.lengths_mm.right,
               parabola_slopes(surface.x_nodes_mm, surface.y_nodes_mm, surface.lengths_mm.right)),
        noise_(noise),
        interpolation_sigma_mm_(surface.interpolation_sigma_mm) {}

  [[nodiscard]] tl::expected<Lengths, MapFailure> at(BedPoint mark) const override {
    const auto left = left_.at(mark.x_mm, mark.y_mm);
    const auto right = right_.at(mark.x_mm, mark.y_mm);
    Lengths here;
    here.lengths = {left.value, right.value};
    here.mark_jacobian << left.dx, left.dy, right.dx, right.dy;
    return here;
  }

  /// Each node errs by the readings' noise, the place's error as its slope carries it into the
  /// chains; what lies between the nodes by the estimate of the interpolation's own error.
  [[nodiscard]] Eigen::Matrix2d covariance(BedPoint mark, const Lengths& here) const override {
    const double squares = left_.cardinal_weights(mark.x_mm, mark.y_mm).squaredNorm();
    const Eigen::Matrix2d node = noise_.length_mm * noise_.length_mm * Eigen::Matrix2d::Identity() +
                                 noise_.position_mm * noise_.position_mm * here.mark_jacobian *
                                     here.mark_jacobian.transpose();
    return squares * node +
           interpolation_sigma_mm_ * interpolation_sigma_mm_ * Eigen::Matrix2d::Identity();
  }

  [[nodiscard]] BedPoint to_mark(BedPoint bed) const override { return bed; }
  [[nodiscard]] BedPoint to_bed(BedPoint mark) const override { return mark; }

 private:
  std::shared_ptr<const interp::TensorAxes> axes_;
  interp::TensorSpline left_;
  interp::TensorSpline right_;
  MapNoise noise_;
  double interpolation_sigma_mm_;
};

CompensationMap::CompensationMap(MapContents contents)
    : contents_(std::move(contents)), area_(contents_.hull, contents_.edge_mm, contents_.domain) {
  if (const auto* surface = std::get_if<ModelSurface>(&contents_.surface)) {
    if (surface->lattice) {
      field_ = std::make_shared<const LatticeField>(*surface, contents_.noise);
    } else {
      field_ = std::make_shared<const ModelField>(*surface);
    }
  } else {
    field_ = std::make_shared<const DirectField>(std::get<DirectSurface>(contents_.surface),
                                                 contents_.noise);
  }
}

const model::Machine* CompensationMap::machine() const {
  const auto* surface = std::get_if<ModelSurface>(&contents_.surface);
  return surface == nullptr ? nullptr : &surface->machine;
}

BedPoint CompensationMap::to_mark(BedPoint bed) const { return field_->to_mark(bed); }

BedPoint CompensationMap::to_bed(BedPoint mark) const { return field_->to_bed(mark); }

BedPoint CompensationMap::mark_of(BedPoint point, Frame frame) const {
  return frame == Frame::bed ? field_->to_mark(point) : point;
}

MapStatus CompensationMap::status(BedPoint point, Frame frame) const {
  return area_.status(mark_of(point, frame));
}

tl::expected<CompensationMap::Lengths, MapFailure> CompensationMap::lengths(BedPoint point,
                                                                            Frame frame) const {
  const BedPoint mark = mark_of(point, frame);
  if (!contents_.domain.contains(mark.x_mm, mark.y_mm))
    return tl::unexpected(MapFailure::outside_map);
  return field_->at(mark);
}

tl::expected<MapAnswer, MapFailure> CompensationMap::query(BedPoint point, Frame frame) const {
  const BedPoint mark = mark_of(point, frame);
  const auto here = lengths(mark);
  if (!here) return tl::unexpected(here.error());
  MapAnswer answer;
  answer.lengths = here->lengths;
  answer.mark_jacobian = here->mark_jacobian;
  answer.covariance = field_->covariance(mark, *here);
  answer.sigma = {std::sqrt(answer.covariance(0, 0)), std::sqrt(answer.covariance(1, 1))};
  const Eigen::Matrix2d to_tool = here->mark_jacobian.inverse();
  answer.tool_sigma_mm = std::sqrt((to_tool * answer.covariance * to_tool.transpose()).trace());
  answer.status = area_.status(mark);
  return answer;
}

tl::expected<BedPoint, MapFailure> CompensationMap::inverse(ChainLengths wanted,
                                                            Frame frame) const {
  constexpr int kSteps = 30;
  constexpr double kSettledMm = 1e-9;
  const interp::Rectangle& domain = contents_.domain;
  BedPoint mark{0.5 * (domain.x_min + domain.x_max), 0.5 * (domain.y_min + domain.y_max)};
  for (int step = 0; step < kSteps; ++step) {
    const auto here = field_->at(mark);
    if (!here) return tl::unexpected(here.error());
    const Eigen::Vector2d missing(wanted.left_mm - here->lengths.left_mm,
                                  wanted.right_mm - here->lengths.right_mm);
    const Eigen::Vector2d move = here->mark_jacobian.inverse() * missing;
    if (!move.allFinite()) return tl::unexpected(MapFailure::not_converged);
    // A step may leave the domain on the way, but not run off to where the chains cannot hold the
    // sled.
    mark.x_mm = std::clamp(mark.x_mm + move.x(), domain.x_min - 50.0, domain.x_max + 50.0);
    mark.y_mm = std::clamp(mark.y_mm + move.y(), domain.y_min - 50.0, domain.y_max + 50.0);
    if (move.norm() < kSettledMm) {
      if (!domain.contains(mark.x_mm, mark.y_mm)) return tl::unexpected(MapFailure::outside_map);
      return frame == Frame::bed ? field_->to_bed(mark) : mark;
    }
  }
  return tl::unexpected(MapFailure::not_converged);
}

}  // namespace chaintrue::grid
