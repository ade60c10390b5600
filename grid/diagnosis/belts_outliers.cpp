// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_outliers.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {

using model::Belt;
using model::kBelts;

namespace {

/// A direction shorter than this has been set aside already.
constexpr double kNothingLeftOfBelts = 1e-9;
/// A search goes on so far beyond the best set, since two bad readings can mask each other.
constexpr std::size_t kBeyondTheBest = 8;

int count_of(const model::PerBelt<bool>& bad) { return bad.tl + bad.tr + bad.bl + bad.br; }

/// One hypothesis and what is left of each place's two checks.
class BeltOutlierSearch {
 public:
  BeltOutlierSearch(const BeltsSystem& system, const std::vector<int>& set)
      : system_(system), count_(system.checks.size()), left_(count_, Eigen::Matrix2d::Identity()) {
    const RegressorSystem& own = system.system;
    e_ = own.e;
    std::vector<int> free;
    for (const int k : set) {
      if (own.regressors[static_cast<std::size_t>(k)].fixed) {
        e_ -= own.g.col(k);
      } else {
        free.push_back(k);
      }
    }
    const Eigen::Index settings = own.by_setting.cols();
    x_.resize(e_.size(), settings + static_cast<Eigen::Index>(free.size()));
    x_ << own.by_setting, own.g.dense(free);
    Eigen::VectorXd prior = x_.colwise().squaredNorm() / std::pow(kWideSignalToNoise, 2);
    prior.head(settings) = own.sigma.cwiseAbs2().cwiseInverse();
    normal_ = x_.transpose() * x_;
    normal_ += Eigen::MatrixXd(prior.asDiagonal());
    gradient_ = x_.transpose() * e_;
    square_ = e_.squaredNorm();
    log_prior_ = log_prior(own.regressors, set, false) + 0.5 * prior.array().log().sum();
    solve();
    const auto rows = static_cast<Eigen::Index>(2 * count_);
    found_ = {std::vector<model::PerBelt<bool>>(count_), weight(rows)};
  }

  BadReadings run() {
    BadReadings now = found_;
    auto rows = static_cast<Eigen::Index>(2 * count_);
    const auto most =
        static_cast<std::size_t>(std::ceil(kMostOutlierShare * 4.0 * static_cast<double>(count_)));
    std::size_t at_best = 0;
    for (std::size_t step = 1; step <= most && step <= at_best + kBeyondTheBest; ++step) {
      const Eigen::Index settings = system_.system.by_setting.cols();
      if (rows - 1 <= settings + 2) break;
      const Worst worst = worst_reading();
      if (!(worst.drop > 0.0)) break;
      now.bad[worst.place][worst.belt] = true;
      set_aside(worst);
      --rows;
      price_ += log_price_of_outlier(1);
      now.log_weight = weight(rows);
      if (now.log_weight > found_.log_weight) {
        found_ = now;
        at_best = step;
      }
    }
    return found_;
  }

 private:
  struct Worst {
    std::size_t place = 0;
    Belt belt = Belt::tl;
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    double drop = 0.0;
  };

  void solve() {
    factor_.compute(normal_);
    beta_ = factor_.solve(gradient_);
    quadratic_ = std::max(square_ - gradient_.dot(beta_), 0.0);
  }

  [[nodiscard]] double log_det_of_normal() const {
    return 2.0 * Eigen::MatrixXd(factor_.matrixL()).diagonal().array().log().sum();
  }

  [[nodiscard]] double weight(Eigen::Index rows) const {
    return NoiseDensity(system_.system.noise_dof, rows).log_density(quadratic_) -
           0.5 * log_det_of_normal() + log_prior_ + price_;
  }

  [[nodiscard]] Worst worst_reading() const {
    Worst worst;
    for (std::size_t k = 0; k < count_; ++k) {
      if (left_[k].squaredNorm() < kNothingLeftOfBelts) continue;
      const auto row = static_cast<Eigen::Index>(2 * k);
      const auto x = x_.middleRows<2>(row);
      const Eigen::Vector2d r = e_.segment<2>(row) - x * beta_;
      const Eigen::Matrix2d taken = x * factor_.solve(x.transpose());
      for (const Belt belt : kBelts) {
        Eigen::Vector2d v =
            left_[k] * system_.checks[k].row(static_cast<Eigen::Index>(belt)).transpose();
        if (v.norm() < kNothingLeftOfBelts) continue;
        v.normalize();
        const double share = 1.0 - v.dot(taken * v);
        const double drop = share > kNothingLeftOfBelts ? std::pow(v.dot(r), 2) / share : 0.0;
        if (drop > worst.drop) worst = {k, belt, v, drop};
      }
    }
    return worst;
  }

  void set_aside(const Worst& worst) {
    const auto row = static_cast<Eigen::Index>(2 * worst.place);
    const Eigen::VectorXd x = x_.middleRows<2>(row).transpose() * worst.direction;
    const double y = worst.direction.dot(e_.segment<2>(row));
    normal_ -= x * x.transpose();
    gradient_ -= y * x;
    square_ -= y * y;
    left_[worst.place] -= worst.direction * worst.direction.transpose();
    // What is set aside is out of the rows as well, so that residuals stay those of the rest.
    x_.middleRows<2>(row) = (left_[worst.place] * x_.middleRows<2>(row)).eval();
    e_.segment<2>(row) = (left_[worst.place] * e_.segment<2>(row)).eval();
    solve();
  }

  const BeltsSystem& system_;
  std::size_t count_;
  std::vector<Eigen::Matrix2d> left_;
  Eigen::VectorXd e_;
  Eigen::MatrixXd x_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd beta_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double square_ = 0.0;
  double quadratic_ = 0.0;
  double log_prior_ = 0.0;
  double price_ = 0.0;
  BadReadings found_;
};

}  // namespace

std::vector<BadReadings> bad_readings(const BeltsSystem& system,
                                      const std::vector<std::vector<int>>& hypotheses) {
  std::vector<BadReadings> found;
  for (const auto& set : hypotheses) {
    BadReadings one = BeltOutlierSearch(system, set).run();
    const auto same = std::find_if(
        found.begin(), found.end(), [&](const BadReadings& f) { return f.bad == one.bad; });
    if (same == found.end()) {
      found.push_back(std::move(one));
    } else {
      same->log_weight = std::max(same->log_weight, one.log_weight);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.log_weight > b.log_weight;
  });
  std::size_t kept = 0;
  while (kept < found.size() && kept < kMostFoundSets &&
         found[kept].log_weight >= found.front().log_weight - kNegligibleOutliers) {
    ++kept;
  }
  found.resize(kept);
  return found;
}

Suspects suspects_of(const std::vector<BadReadings>& sets) {
  Suspects suspects(sets.empty() ? 0 : sets.front().bad.size());
  for (const BadReadings& set : sets) {
    for (std::size_t k = 0; k < set.bad.size(); ++k) {
      if (suspects[k] || count_of(set.bad[k]) != 1) continue;
      for (const Belt belt : kBelts) {
        if (set.bad[k][belt]) suspects[k] = belt;
      }
    }
  }
  return suspects;
}

std::vector<bool> units_of(const BadReadings& set, const Suspects& suspects) {
  std::vector<bool> units(2 * set.bad.size(), false);
  for (std::size_t k = 0; k < set.bad.size(); ++k) {
    const int bad = count_of(set.bad[k]);
    if (bad == 0) continue;
    const bool alone = bad == 1 && suspects[k] && set.bad[k][*suspects[k]];
    units[2 * k] = true;
    units[2 * k + 1] = !alone;
  }
  return units;
}

std::vector<model::PerBelt<bool>> readings_of(const std::vector<bool>& units,
                                              const Suspects& suspects) {
  std::vector<model::PerBelt<bool>> bad(units.size() / 2);
  for (std::size_t k = 0; k < bad.size(); ++k) {
    if (units[2 * k + 1]) {
      bad[k] = {true, true, true, true};
    } else if (units[2 * k] && suspects[k]) {
      bad[k][*suspects[k]] = true;
    }
  }
  return bad;
}

}  // namespace chaintrue::grid::diagnosis
