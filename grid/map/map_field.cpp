// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_field.hpp"

#include <Eigen/Dense>

#include "grid/containers.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/raster.hpp"

namespace chaintrue::grid {
namespace {

/// One chain's splines of a ResidualSurface.
class SplineSurface final : public interp::Surface {
 public:
  SplineSurface(const interp::BsplineBasis& basis, VectorXd coefficients)
      : basis_(basis), coefficients_(std::move(coefficients)) {}
  interp::ValueGradient at(double x, double y) const override {
    return basis_.evaluate(coefficients_, x, y);
  }
  interp::Rectangle domain() const override { return basis_.rectangle(); }

 private:
  interp::BsplineBasis basis_;
  VectorXd coefficients_;
};

/// On a calibrated machine with penalised surfaces: G F, with the two sparse rows G of the design.
class DesignSpread {
 public:
  explicit DesignSpread(const ModelSurface& surface)
      : view_(ReadingModel(surface.machine), surface.sheet),
        settings_(surface.settings),
        columns_(surface.columns),
        basis_(surface.residual.basis),
        factor_(surface.covariance_factor.transpose()) {}

  Matrix2Xd operator()(MarkPoint mark, const MapLengths& /*here*/,
                       const model::PointReading* reading) const {
    const Matrix2Xd by_setting = observation::lengths_by_setting(view_, *reading, mark, settings_);
    Eigen::MatrixX2d spread = Eigen::MatrixX2d::Zero(factor_.rows(), 2);
    const interp::BasisSupport support = basis_.at(mark.x_mm, mark.y_mm);
    for (const Side side : kSides) {
      auto own = spread.col(row_of(side));
      for (const Index i : each_below(by_setting.cols())) add(i, by_setting(row_of(side), i), own);
      add(columns_.scale(side), reading->lengths[side], own);
      for (const auto k : each_index(support.index))
        add(columns_.spline(side) + support.index[k], support.value[k], own);
    }
    return spread.transpose();
  }

 private:
  /// F is lower triangular: the column of F' ends at the diagonal.
  void add(Index column, double slope, Eigen::Ref<VectorXd> sum) const {
    sum.head(column + 1) += slope * factor_.col(column).head(column + 1);
  }

  observation::View view_;
  std::vector<Setting> settings_;
  FitColumns columns_;
  interp::BsplineBasis basis_;
  MatrixXd factor_;  // F'
};

/// The spread of surfaces through the nodes of a lattice, two columns a node: each has the readings' noise,
/// with the place's error carried into the chains by the slope, its doubt and the interpolation's
/// estimated error, which grows with the weights beyond the lattice. The bicubic's weights
/// approximate the quintic's.
struct NodeSpread {
  interp::TensorSpline splines;
  MatrixXd doubt_mm;
  double interpolation_sigma_mm;
  /// Least share of the interpolation's error: 1 counts it in full inside the lattice.
  double least_share;
  MapNoise noise;

  Matrix2Xd operator()(MarkPoint mark, const MapLengths& here,
                       const model::PointReading* /*reading*/) const {
    const MatrixXd weights = splines.cardinal_weights(mark.x_mm, mark.y_mm);
    const double between = interpolation_sigma_mm * interpolation_sigma_mm *
                           std::max(least_share, 1.0 / weights.squaredNorm());
    const Matrix2d node =
        noise.factor_found * noise.factor_found *
        observation::covariance_of({noise.length_mm, noise.position_mm}, here.mark_jacobian);
    Matrix2Xd spread(2, 2 * weights.size());
    for (const Index i : each_below(weights.size())) {
      const double own_mm2 = std::pow(doubt_mm.reshaped()[i], 2) + between;
      const Matrix2d covariance = node + own_mm2 * Matrix2d::Identity();
      // Zero where the covariance is.
      spread.middleCols<2>(2 * i) =
          weights.reshaped()[i] * Matrix2d(Eigen::LLT<Matrix2d>(covariance).matrixL());
    }
    return spread;
  }
};

/// The search for the inverse may step outside the domain, so `refuse` has a policy too.
interp::OutsidePolicy policy_of(Outside way) {
  if (way == Outside::fade) return interp::OutsidePolicy::fade;
  return way == Outside::clamp ? interp::OutsidePolicy::clamp : interp::OutsidePolicy::linear;
}

}  // namespace

MapField::MapField(const MapContents& contents) {
  if (const auto* direct = std::get_if<DirectSurface>(&contents.surface)) {
    const std::vector<double>&x = direct->x_nodes_mm, &y = direct->y_nodes_mm;
    const auto axes = std::make_shared<const interp::TensorAxes>(x, y, direct->ends);
    const auto spline = [&](const MatrixXd& lengths_mm) {
      return std::make_shared<const interp::TensorSpline>(axes, lengths_mm,
                                                          parabola_slopes(x, y, lengths_mm));
    };
    const auto left = spline(direct->lengths_mm.left);
    const auto right = spline(direct->lengths_mm.right);
    surfaces_ = {left, right};
    pair_.emplace(*left, *right);
    const MatrixXd no_doubt = MatrixXd::Zero(std::ssize(x), std::ssize(y));
    spread_at_ = NodeSpread{*left, no_doubt, direct->interpolation_sigma_mm, 0.0, contents.noise};
  } else {
    const auto& surface = std::get<ModelSurface>(contents.surface);
    sheet_ = surface.sheet;
    machine_.emplace(surface.machine);
    scale_ = surface.residual.scale;
    if (surface.lattice) {
      const auto& [x, y, values_mm, doubt_mm, sigma_mm] = *surface.lattice;
      const auto quintic =
          std::make_shared<const interp::TensorAxes>(x, y, interp::TensorEnds{}, 5);
      for (const Side side : kSides)
        surfaces_[side] = std::make_shared<const interp::TensorSpline>(quintic, values_mm[side]);
      spread_at_ = NodeSpread{{x, y, doubt_mm}, doubt_mm, sigma_mm, 1.0, contents.noise};
    } else {
      for (const Side side : kSides) {
        surfaces_[side] = std::make_shared<const SplineSurface>(
            surface.residual.basis, surface.residual.coefficients[side]);
      }
      spread_at_ = DesignSpread(surface);
    }
  }
  const OutsideRule& rule = contents.outside;
  if (rule.way == Outside::continued) return;
  beyond_.emplace(
      Beyond{hull_of(contents.hull), {policy_of(rule.way), contents.edge_mm, rule.fade_width_mm}});
}

tl::expected<MapSpread, MapFailure> MapField::at(MarkPoint mark, Asked asked) const {
  MapSpread answer;
  MapLengths& here = answer.here;
  here.mark_jacobian.setZero();
  std::optional<model::PointReading> reading;
  if (machine_) {
    auto found = machine_->at(sheet_.to_bed(mark));
    if (!found) return tl::unexpected(unreachable(model::mechanism_failure(found.error())));
    reading = *std::move(found);
    here.lengths = reading->lengths;
    here.mark_jacobian = reading->position_jacobian * sheet_.rotation();
  }
  if (pair_) {
    const interp::PairGradient own = pair_->at(mark.x_mm, mark.y_mm);
    here.lengths = {own.value[0], own.value[1]};
    here.mark_jacobian << own.dx[0], own.dy[0], own.dx[1], own.dy[1];
  } else {
    for (const Side side : kSides) {
      const interp::ValueGradient own = surfaces_[side]->at(mark.x_mm, mark.y_mm);
      auto slope = here.mark_jacobian.row(row_of(side));
      here.lengths[side] = here.lengths[side] * (1.0 + scale_[side]) + own.value;
      slope = slope * (1.0 + scale_[side]) + RowVector2d(own.dx, own.dy);
    }
  }
  if (asked == Asked::spread)
    answer.spread_mm = spread_at_(mark, here, reading ? &*reading : nullptr);
  if (!beyond_) return answer;
  const Vector2d change = add_change(mark, here);
  if (asked == Asked::lengths) return answer;
  answer.spread_mm.conservativeResize(Eigen::NoChange, answer.spread_mm.cols() + 1);
  answer.spread_mm.rightCols<1>() = change;
  return answer;
}

Vector2d MapField::add_change(MarkPoint mark, MapLengths& here) const {
  Vector2d change = Vector2d::Zero();
  if (beyond_->hull.contains(mark.x_mm, mark.y_mm)) return change;
  for (const Side side : kSides) {
    const Index row = row_of(side);
    const interp::ValueGradient own = surfaces_[side]->at(mark.x_mm, mark.y_mm);
    const interp::ValueGradient reply =
        interp::evaluate(*surfaces_[side], beyond_->hull, beyond_->policy, {mark.x_mm, mark.y_mm});
    change[row] = reply.value - own.value;
    here.lengths[side] += change[row];
    here.mark_jacobian.row(row) += RowVector2d(reply.dx - own.dx, reply.dy - own.dy);
  }
  return change;
}

namespace {

/// For the lines that are the rows of `values`, at their first node and at their last: a column each.
MatrixXd end_slopes(const std::vector<double>& nodes, const MatrixXd& values) {
  MatrixXd slopes(values.rows(), 2);
  for (const Index end : {0, 1}) {
    const auto at = [&](Index i) { return end == 1 ? std::ssize(nodes) - 1 - i : i; };
    const auto node = [&](Index i) { return nodes[as_size(at(i))]; };
    const auto slope_to = [&](Index i) -> VectorXd {
      return (values.col(at(i)) - values.col(at(0))) / (node(i) - node(0));
    };
    const VectorXd near = slope_to(1);
    slopes.col(end) = near;
    if (nodes.size() == 2) continue;
    slopes.col(end) -= (slope_to(2) - near) * (node(1) - node(0)) / (node(2) - node(1));
  }
  return slopes;
}

}  // namespace

interp::EdgeSlopes parabola_slopes(const std::vector<double>& x_nodes_mm,
                                   const std::vector<double>& y_nodes_mm, const MatrixXd& values) {
  return {end_slopes(x_nodes_mm, values.transpose()).transpose(), end_slopes(y_nodes_mm, values)};
}

}  // namespace chaintrue::grid
