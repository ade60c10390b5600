// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_average.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace chaintrue::interp::reml {
namespace {

// A point of the posterior of theta and its weight.
struct ThetaNode {
  Eigen::VectorXd theta;
  double weight;
};

// Steps one or two components of theta outward from the optimum while the posterior is above e^-4
// of its peak.
class PosteriorGrid {
 public:
  PosteriorGrid(const Marginal& marginal, const SearchResult& found, Eigen::VectorXd sigma)
      : marginal_(marginal), found_(found), centre_(found.theta), sigma_(std::move(sigma)) {}

  std::vector<ThetaNode> over(Eigen::Index i) {
    peak_ = -std::numeric_limits<double>::infinity();
    nodes_.clear();
    walk(i, centre_);
    return normalized();
  }

  // `i` is stepped anew, from its best value so far, at each value of `outer`.
  std::vector<ThetaNode> over(Eigen::Index i, Eigen::Index outer) {
    peak_ = -std::numeric_limits<double>::infinity();
    nodes_.clear();
    const double step = step_of(outer);
    for (const double direction : {-1.0, 1.0}) {
      Eigen::VectorXd from = centre_;
      for (int j = direction < 0.0 ? 0 : 1; j < kLongest; ++j) {
        from(outer) = centre_(outer) + direction * step * j;
        if (from(outer) < found_.low(outer) || from(outer) > found_.high(outer)) {
          break;
        }
        const Best best = walk(i, from);
        if (!(best.log_weight > peak_ - kNegligible)) {
          break;
        }
        from(i) = best.at;
      }
    }
    return normalized();
  }

 private:
  static constexpr double kNegligible = 4.0;
  static constexpr int kLongest = 60;
  struct Best {
    double at;
    double log_weight;
  };

  // The average always includes the prior, so that the posterior is proper; the fit includes it on
  // request.
  [[nodiscard]] double missing_prior(const Eigen::VectorXd& theta) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; marginal_.prior() == SmoothingPrior::none && i < theta.size(); ++i) {
      sum += marginal_.flat_slope(i) * theta(i);
    }
    return sum;
  }

  [[nodiscard]] double step_of(Eigen::Index i) const { return std::clamp(sigma_(i), 0.2, 1.0); }

  Best walk(Eigen::Index i, const Eigen::VectorXd& from) {
    const double step = step_of(i);
    Best best{from(i), -std::numeric_limits<double>::infinity()};
    for (const double direction : {-1.0, 1.0}) {
      for (int j = direction < 0.0 ? 0 : 1; j < kLongest; ++j) {
        Eigen::VectorXd theta = from;
        theta(i) += direction * step * j;
        if (theta(i) < found_.low(i) || theta(i) > found_.high(i)) {
          break;
        }
        const auto state = marginal_.evaluate(theta, Order::value);
        if (!state) {
          break;
        }
        const double w = -0.5 * (state->value + missing_prior(theta));
        if (w > best.log_weight) {
          best = {theta(i), w};
        }
        peak_ = std::max(peak_, w);
        if (w < best.log_weight - kNegligible) {
          break;
        }
        nodes_.push_back({std::move(theta), w});
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<ThetaNode> normalized() const {
    std::vector<ThetaNode> kept;
    double sum = 0.0;
    for (const ThetaNode& node : nodes_) {
      if (node.weight > peak_ - kNegligible) {
        kept.push_back({node.theta, std::exp(node.weight - peak_)});
        sum += kept.back().weight;
      }
    }
    for (ThetaNode& node : kept) {
      node.weight /= sum;
    }
    return kept;
  }

  const Marginal& marginal_;
  const SearchResult& found_;
  Eigen::VectorXd centre_;
  Eigen::VectorXd sigma_;
  double peak_ = 0.0;
  std::vector<ThetaNode> nodes_;
};

}  // namespace

Averaged averaged_covariance(const Marginal& marginal,
                             const SearchResult& found,
                             const Eigen::VectorXd& sigma) {
  WorkingCovariance sum;
  const Eigen::Index k = marginal.penalties();
  Eigen::VectorXd inverse_lambda = Eigen::VectorXd::Zero(k);
  const Eigen::VectorXd fit = marginal.add_inverse(
      found.theta, 1.0 - static_cast<double>(marginal.sigma2_free() && k == 0 ? 1 : k), sum);
  std::vector<Eigen::VectorXd> shifts;
  const auto add = [&](const std::vector<ThetaNode>& nodes) {
    for (const ThetaNode& node : nodes) {
      const Eigen::VectorXd b = marginal.add_inverse(node.theta, node.weight, sum);
      shifts.emplace_back(std::sqrt(node.weight) * (b - fit));
    }
  };
  PosteriorGrid grid(marginal, found, sigma);
  for (Eigen::Index i = 0; i < k; ++i) {
    const std::vector<ThetaNode> nodes = marginal.sigma2_free() ? grid.over(i, k) : grid.over(i);
    add(nodes);
    for (const ThetaNode& node : nodes) {
      inverse_lambda(i) += node.weight * std::exp(-node.theta(i));
    }
  }
  if (marginal.sigma2_free() && k == 0) {
    add(grid.over(k));
  }
  Eigen::MatrixXd shift_columns(fit.size(), static_cast<Eigen::Index>(shifts.size()));
  for (std::size_t j = 0; j < shifts.size(); ++j) {
    shift_columns.col(static_cast<Eigen::Index>(j)) = shifts[j];
  }
  // Weights below zero on the plain part may leave a negative rounding error where nothing was
  // added.
  sum.diagonal = sum.diagonal.cwiseMax(0.0);
  return {marginal.structure().covariance_to_columns(sum, shift_columns),
          std::move(inverse_lambda)};
}

}  // namespace chaintrue::interp::reml
