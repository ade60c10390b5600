// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_field.hpp"

#include <Eigen/Dense>

#include "grid/containers.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/raster.hpp"
#include "interp/spline_pair.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {
namespace {

using model::MarkPoint;
using model::Setting;
using model::Side;

/// One chain's splines of a ResidualSurface.
class SplineSurface final : public interp::Surface {
 public:
  SplineSurface(const interp::BsplineBasis& basis, Eigen::VectorXd coefficients)
      : basis_(basis), coefficients_(std::move(coefficients)) {}
  [[nodiscard]] interp::ValueGradient at(double x, double y) const override {
    return basis_.evaluate(coefficients_, x, y);
  }
  [[nodiscard]] interp::Rectangle domain() const override { return basis_.rectangle(); }

 private:
  interp::BsplineBasis basis_;
  Eigen::VectorXd coefficients_;
};

/// On a calibrated machine.
class ModelField final : public MapField {
 public:
  explicit ModelField(const ModelSurface& surface)
      : MapField(surface.sheet),
        surface_(surface),
        model_(surface.machine),
        factor_(surface.covariance_factor.transpose()),
        left_(surface.residual.basis, surface.residual.coefficients.left),
        right_(surface.residual.basis, surface.residual.coefficients.right) {
    surface_.covariance_factor.resize(0, 0);
  }

 private:
  [[nodiscard]] tl::expected<MapSpread, MapFailure> continued(MarkPoint mark,
                                                              Asked asked) const override {
    const auto reading = model_.at(sheet().to_bed(mark));
    if (!reading) return tl::unexpected(unreachable(model::mechanism_failure(reading.error())));
    MapSpread found{corrected(mark, *reading), {}};
    if (asked == Asked::spread) found.spread_mm = spread(mark, *reading);
    return found;
  }

  [[nodiscard]] model::PerSide<const interp::Surface*> surfaces() const override {
    return {&left_, &right_};
  }

  [[nodiscard]] MapLengths corrected(MarkPoint mark, const model::PointReading& reading) const {
    const auto result = surface_.residual.apply(
        mark, reading.lengths, reading.position_jacobian * surface_.sheet.rotation());
    return {result.lengths, result.mark_jacobian};
  }

  /// G F, with the two sparse rows G of the design.
  [[nodiscard]] Eigen::Matrix2Xd spread(MarkPoint mark, const model::PointReading& reading) const {
    const FitColumns& columns = surface_.columns;
    const Eigen::Matrix<double, 2, 3> by_sheet =
        reading.position_jacobian * surface_.sheet.sensitivity(mark);
    Eigen::MatrixX2d spread = Eigen::MatrixX2d::Zero(factor_.rows(), 2);
    for (std::size_t i = 0; i < surface_.settings.size(); ++i) {
      const auto column = as_index(i);
      const Setting setting = surface_.settings[i];
      const auto in_sheet =
          static_cast<Eigen::Index>(setting) - static_cast<Eigen::Index>(Setting::sheet_x_mm);
      const Eigen::Vector2d slope = in_sheet < 0 ? model_.sensitivity(reading, setting)
                                                 : Eigen::Vector2d(by_sheet.col(in_sheet));
      add(column, slope[0], spread.col(0));
      add(column, slope[1], spread.col(1));
    }
    add(columns.scale(Side::left), reading.lengths.left_mm, spread.col(0));
    add(columns.scale(Side::right), reading.lengths.right_mm, spread.col(1));
    const interp::BasisSupport support = surface_.residual.basis.at(mark.x_mm, mark.y_mm);
    for (std::size_t k = 0; k < support.index.size(); ++k) {
      add(columns.spline(Side::left) + support.index[k], support.value[k], spread.col(0));
      add(columns.spline(Side::right) + support.index[k], support.value[k], spread.col(1));
    }
    return spread.transpose();
  }

  /// F is lower triangular: the column of F' ends at the diagonal.
  void add(Eigen::Index column, double slope, Eigen::Ref<Eigen::VectorXd> sum) const {
    sum.head(column + 1) += slope * factor_.col(column).head(column + 1);
  }

  ModelSurface surface_;
  model::ReadingModel model_;
  Eigen::MatrixXd factor_;  // F'
  SplineSurface left_;
  SplineSurface right_;
};

/// Of a reading at a node.
Eigen::Matrix2d node_covariance(const MapNoise& noise, const MapLengths& here) {
  return observation::covariance_of({noise.length_mm, noise.position_mm}, here.mark_jacobian);
}

/// On a calibrated machine, through readings without noise on a lattice.
class LatticeField final : public MapField {
 public:
  LatticeField(const ModelSurface& surface, const MapNoise& noise)
      : MapField(surface.sheet),
        scale_(surface.residual.scale),
        model_(surface.machine),
        splines_(surface.lattice.value()),
        noise_(noise) {}

 private:
  [[nodiscard]] tl::expected<MapSpread, MapFailure> continued(MarkPoint mark,
                                                              Asked asked) const override {
    const auto reading = model_.at(sheet().to_bed(mark));
    if (!reading) return tl::unexpected(unreachable(model::mechanism_failure(reading.error())));
    const auto spline = splines_.at(mark);
    const Eigen::Vector2d factor(1.0 + scale_.left, 1.0 + scale_.right);
    MapSpread found;
    MapLengths& here = found.here;
    here.lengths = {factor[0] * reading->lengths.left_mm + spline.left.value,
                    factor[1] * reading->lengths.right_mm + spline.right.value};
    here.mark_jacobian << spline.left.dx, spline.left.dy, spline.right.dx, spline.right.dy;
    here.mark_jacobian += factor.asDiagonal() * reading->position_jacobian * sheet().rotation();
    if (asked == Asked::spread) {
      found.spread_mm = splines_.spread(
          mark, noise_.factor_found * noise_.factor_found * node_covariance(noise_, here));
    }
    return found;
  }

  [[nodiscard]] model::PerSide<const interp::Surface*> surfaces() const override {
    return splines_.surfaces();
  }

  model::PerSide<double> scale_;
  model::ReadingModel model_;
  LatticeSplines splines_;
  MapNoise noise_;
};

/// Splines through the lengths themselves.
class DirectField final : public MapField {
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
        both_(left_, right_),
        noise_(noise),
        interpolation_sigma_mm_(surface.interpolation_sigma_mm) {}

 private:
  /// Each node has the readings' noise, with the place's error carried into the chains by the
  /// slope; between the nodes the interpolation's estimated error is added.
  [[nodiscard]] tl::expected<MapSpread, MapFailure> continued(MarkPoint mark,
                                                              Asked asked) const override {
    const interp::PairGradient z = both_.at(mark.x_mm, mark.y_mm);
    MapSpread found;
    found.here.lengths = {z.value[0], z.value[1]};
    found.here.mark_jacobian << z.dx[0], z.dy[0], z.dx[1], z.dy[1];
    if (asked == Asked::lengths) return found;
    const Eigen::MatrixXd weights = left_.cardinal_weights(mark.x_mm, mark.y_mm);
    const Eigen::MatrixXd own = Eigen::MatrixXd::Constant(
        weights.rows(),
        weights.cols(),
        interpolation_sigma_mm_ * interpolation_sigma_mm_ / weights.squaredNorm());
    found.spread_mm = spread_of_nodes(weights, node_covariance(noise_, found.here), own);
    return found;
  }

  [[nodiscard]] model::PerSide<const interp::Surface*> surfaces() const override {
    return {&left_, &right_};
  }

  std::shared_ptr<const interp::TensorAxes> axes_;
  interp::TensorSpline left_;
  interp::TensorSpline right_;
  interp::SplinePair both_;
  MapNoise noise_;
  double interpolation_sigma_mm_;
};

std::shared_ptr<MapField> field_of(const MapContents& contents) {
  if (const auto* direct = std::get_if<DirectSurface>(&contents.surface))
    return std::make_shared<DirectField>(*direct, contents.noise);
  const auto& surface = std::get<ModelSurface>(contents.surface);
  if (surface.lattice) return std::make_shared<LatticeField>(surface, contents.noise);
  return std::make_shared<ModelField>(surface);
}

/// The search for the inverse may step outside the domain, so `refuse` has a policy too.
interp::OutsidePolicy policy_of(Outside way) {
  if (way == Outside::fade) return interp::OutsidePolicy::fade;
  return way == Outside::clamp ? interp::OutsidePolicy::clamp : interp::OutsidePolicy::linear;
}

}  // namespace

std::shared_ptr<const MapField> MapField::make(const MapContents& contents) {
  std::shared_ptr<MapField> field = field_of(contents);
  const OutsideRule& rule = contents.outside;
  if (rule.way == Outside::continued) return field;
  field->beyond_.emplace(Beyond{
      hull_of(contents.hull), {policy_of(rule.way), contents.edge_mm, rule.fade_width_mm}});
  return field;
}

namespace {

/// For the lines that are the rows of `values`, at their first node or, reversed, at their last.
Eigen::VectorXd slopes_at_end(const std::vector<double>& nodes,
                              const Eigen::MatrixXd& values,
                              bool last) {
  const auto at = [&](Eigen::Index i) { return last ? std::ssize(nodes) - 1 - i : i; };
  const auto node = [&](Eigen::Index i) { return nodes[as_size(at(i))]; };
  const auto slope_to = [&](Eigen::Index i) -> Eigen::VectorXd {
    return (values.col(at(i)) - values.col(at(0))) / (node(i) - node(0));
  };
  const Eigen::VectorXd near = slope_to(1);
  if (nodes.size() == 2) return near;
  return near - (slope_to(2) - near) * (node(1) - node(0)) / (node(2) - node(1));
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

}  // namespace chaintrue::grid
