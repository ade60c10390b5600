// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/interp/oracle/scattered_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace chaintrue::interp {
namespace {

constexpr std::size_t kFewestPoints = 6;

tl::unexpected<ScatteredFailure> refuse(ScatteredFailure::Reason reason, std::string sentence) {
  return tl::unexpected(ScatteredFailure{reason, std::move(sentence)});
}

void check(std::span<const ScatteredPoint> points, const ScatteredOptions& options) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ScatteredPoint& p = points[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) ||
        !std::isfinite(p.sigma) || !(p.sigma > 0.0)) {
      throw std::invalid_argument(
          fmt::format("point {} is ({}, {}, {}) with sigma {}", i, p.x, p.y, p.z, p.sigma));
    }
    if (options.rectangle && !options.rectangle->contains(p.x, p.y)) {
      throw std::invalid_argument(
          fmt::format("point {} at ({}, {}) lies outside the rectangle", i, p.x, p.y));
    }
  }
}

Rectangle bounding_box(std::span<const ScatteredPoint> points) {
  Rectangle box{points[0].x, points[0].x, points[0].y, points[0].y};
  for (const ScatteredPoint& p : points) {
    box.x_min = std::min(box.x_min, p.x);
    box.x_max = std::max(box.x_max, p.x);
    box.y_min = std::min(box.y_min, p.y);
    box.y_max = std::max(box.y_max, p.y);
  }
  return box;
}

// The cloud's smaller principal extent over its larger.
double narrowness(std::span<const ScatteredPoint> points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const ScatteredPoint& p : points) {
    mean += Eigen::Vector2d(p.x, p.y) / static_cast<double>(points.size());
  }
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const ScatteredPoint& p : points) {
    const Eigen::Vector2d d = Eigen::Vector2d(p.x, p.y) - mean;
    spread += d * d.transpose();
  }
  const Eigen::Vector2d extent =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues();
  return extent(1) > 0.0 ? std::sqrt(std::max(0.0, extent(0)) / extent(1)) : 0.0;
}

// One cell for eight points, at least 32 and at most 40 cells: fewer cannot follow the data, and
// beyond that the penalty determines the result (measured: the error does not change from 8 x 4 to
// 24 x 12). Given values are kept.
void choose_intervals(const Rectangle& box, std::size_t points, ScatteredOptions& options) {
  const double cells = std::clamp(static_cast<double>(points) / 8.0, 32.0, 40.0);
  const double ratio = std::clamp(box.width() / box.height(), 0.125, 8.0);
  if (options.intervals_x == 0)
    options.intervals_x = std::max(2, static_cast<int>(std::lround(std::sqrt(cells * ratio))));
  if (options.intervals_y == 0)
    options.intervals_y = std::max(2, static_cast<int>(std::lround(std::sqrt(cells / ratio))));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double root_mean_square(double square, std::size_t count) {
  return count > 0 ? std::sqrt(square / static_cast<double>(count)) : 0.0;
}

}  // namespace

class ScatteredFitter {
 public:
  ScatteredFitter(std::span<const ScatteredPoint> points, const ScatteredOptions& options)
      : points_(points),
        options_(options),
        basis_(*options.rectangle, options.intervals_x, options.intervals_y),
        weight_(points.size(), 1.0) {
    for (const ScatteredPoint& p : points) {
      rows_.push_back(split(basis_.at(p.x, p.y)));
      mean_ += p.z / static_cast<double>(points.size());
    }
    penalty_ = basis_.thin_plate_penalty();
  }

  tl::expected<ScatteredSurface, ScatteredFailure> run() {
    // In each round the weights follow from the errors of the round before; they converge to a
    // twentieth in four rounds, and without contradicted points the first round is the last.
    constexpr int kMostRounds = 5;
    tl::expected<PenalisedFit, FitFailure> fit = solve();
    bool judged = false;
    for (int round = 1; fit && options_.robust && round < kMostRounds; ++round) {
      leave_out_each(*fit);
      judged = !reweigh();
      if (judged) {
        break;
      }
      fit = solve();
    }
    if (!fit) {
      return refuse(fit.error().reason == FitFailure::Reason::rank_deficient
                        ? ScatteredFailure::Reason::rank_deficient
                        : ScatteredFailure::Reason::not_converged,
                    fit.error().sentence());
    }
    if (!judged) {
      leave_out_each(*fit);
    }
    ScatteredSurface surface(basis_, std::move(*fit));
    judge(surface);
    const LeftOutErrors& e = surface.left_out_;
    // Interpolating smooth data leaves no residual and a small error; only an error that is far
    // above both the residual and a plane's shows that the surface oscillates between its points.
    if (e.rms > e.plane_rms && e.rms > 3.0 * e.residual_rms) {
      return refuse(
          ScatteredFailure::Reason::untrustworthy,
          fmt::format("the surface passes the points within {:.3g} but misses a point left "
                      "out by {:.3g}, a plane by {:.3g}: it swings between the points",
                      e.residual_rms,
                      e.rms,
                      e.plane_rms));
    }
    // The basis sums to one: the mean subtracted before the fit is added to every coefficient.
    surface.fit_.coefficients.array() += mean_;
    return surface;
  }

 private:
  tl::expected<PenalisedFit, FitFailure> solve() {
    PenalisedProblem problem(basis_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double scale = weight_[i] / (points_[i].sigma * points_[i].sigma);
      const Row& row = rows_[i];
      const double z = points_[i].z - mean_;
      const Eigen::Matrix4d outer = row.x * row.x.transpose();
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b <= a; ++b) {
          problem.gram.block<4, 4>(row.first[static_cast<std::size_t>(a)],
                                   row.first[static_cast<std::size_t>(b)]) +=
              (scale * row.y(a) * row.y(b)) * outer;
        }
        problem.moment.segment<4>(row.first[static_cast<std::size_t>(a)]) +=
            (scale * row.y(a) * z) * row.x;
      }
      problem.response_square += scale * z * z;
    }
    problem.gram.triangularView<Eigen::StrictlyUpper>() = problem.gram.transpose();
    problem.rows = static_cast<Eigen::Index>(points_.size());
    problem.penalties.push_back({0, penalty_, basis_.thin_plate_rank()});
    problem.noise = options_.noise;
    return fit_penalised(problem);
  }

  // A point's row of the design in factored form: four runs of four columns.
  struct Row {
    std::array<Eigen::Index, 4> first;
    Eigen::Vector4d x;
    Eigen::Vector4d y;
  };
  static Row split(const BasisSupport& support) {
    Row row{{support.index[0], support.index[4], support.index[8], support.index[12]}, {}, {}};
    // The functions of one axis sum to one.
    for (std::size_t j = 0; j < 4; ++j) {
      row.y(static_cast<int>(j)) = support.value[4 * j] + support.value[4 * j + 1] +
                                   support.value[4 * j + 2] + support.value[4 * j + 3];
      row.x(static_cast<int>(j)) =
          support.value[j] + support.value[j + 4] + support.value[j + 8] + support.value[j + 12];
    }
    return row;
  }

  // e_i, its sigma from the fitted noise, and r_i.
  struct LeftOut {
    double error;
    double sigma;
    double residual;
  };
  [[nodiscard]] LeftOut left_out(const PenalisedFit& fit, std::size_t i) const {
    const Row& row = rows_[i];
    double residual = points_[i].z - mean_;
    double spread = 0.0;  // b' C b
    for (int a = 0; a < 4; ++a) {
      residual -=
          row.y(a) * row.x.dot(fit.coefficients.segment<4>(row.first[static_cast<std::size_t>(a)]));
      for (int b = 0; b <= a; ++b) {
        const double part =
            row.x.dot(fit.covariance.block<4, 4>(row.first[static_cast<std::size_t>(a)],
                                                 row.first[static_cast<std::size_t>(b)]) *
                      row.x);
        spread += (a == b ? 1.0 : 2.0) * row.y(a) * row.y(b) * part;
      }
    }
    const double variance = fit.sigma2 * points_[i].sigma * points_[i].sigma;
    // A point that alone determines the surface at its position cannot be tested by the others.
    const double rest = std::max(1e-9, 1.0 - weight_[i] * spread / variance);
    return {residual / rest, std::sqrt(variance + spread / rest), residual};
  }

  void leave_out_each(const PenalisedFit& fit) {
    left_out_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      left_out_.push_back(left_out(fit, i));
    }
  }

  // The standardized errors; where the noise is unknown their scale is the median's, which a third
  // of bad points does not move.
  [[nodiscard]] std::vector<double> standardized() const {
    std::vector<double> t;
    for (const LeftOut& e : left_out_) {
      t.push_back(e.error / e.sigma);
    }
    if (options_.noise.knowledge == NoiseKnowledge::unknown) {
      std::vector<double> size;
      for (const double value : t) size.push_back(std::abs(value));
      // 0.6745 is the median of |t| for a normal t. A tiny median means data without noise.
      const double scale = std::max(median(size) / 0.6745, 1e-3);
      for (double& value : t) value /= scale;
    }
    return t;
  }

  // Hampel-type weights: full below the limit, then falling as the square. True where one moved.
  bool reweigh() {
    constexpr double kConverged = 0.05;
    const std::vector<double> t = standardized();
    bool moved = false;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double ratio = options_.contradicted_from / std::max(std::abs(t[i]), 1e-300);
      const double weight = ratio >= 1.0 ? 1.0 : ratio * ratio;
      moved = moved || std::abs(weight - weight_[i]) > kConverged;
      weight_[i] = weight;
    }
    return moved;
  }

  void judge(ScatteredSurface& surface) const {
    const std::vector<double> t = standardized();
    LeftOutErrors& errors = surface.left_out_;
    errors.error.resize(static_cast<Eigen::Index>(points_.size()));
    double square = 0.0;
    double residual_square = 0.0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double e = left_out_[i].error;
      errors.error(static_cast<Eigen::Index>(i)) = e;
      if (std::abs(t[i]) > options_.contradicted_from) {
        surface.flags_.push_back({i, PointDoubt::contradicted, t[i], weight_[i]});
        if (options_.robust) {
          continue;
        }
      }
      const double r = left_out_[i].residual;
      square += e * e;
      residual_square += r * r;
      errors.largest = std::max(errors.largest, std::abs(e));
      ++counted;
    }
    errors.rms = root_mean_square(square, counted);
    errors.residual_rms = root_mean_square(residual_square, counted);
    errors.plane_rms = plane_left_out();
    flag_repeats(surface);
  }

  [[nodiscard]] double plane_left_out() const {
    const Rectangle& box = basis_.rectangle();
    const auto row = [&](std::size_t i) {
      return Eigen::Vector3d(
          1.0, (points_[i].x - box.x_min) / box.width(), (points_[i].y - box.y_min) / box.height());
    };
    Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double w = weight_[i] / (points_[i].sigma * points_[i].sigma);
      gram += w * row(i) * row(i).transpose();
      moment += w * row(i) * (points_[i].z - mean_);
    }
    const Eigen::LDLT<Eigen::Matrix3d> factor(gram);
    const Eigen::Vector3d plane = factor.solve(moment);
    double square = 0.0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (weight_[i] < 1.0) {
        continue;
      }
      const double w = 1.0 / (points_[i].sigma * points_[i].sigma);
      const double leverage = w * row(i).dot(factor.solve(row(i)));
      const double e = (points_[i].z - mean_ - plane.dot(row(i))) / std::max(1e-9, 1.0 - leverage);
      square += e * e;
      ++counted;
    }
    return root_mean_square(square, counted);
  }

  void flag_repeats(ScatteredSurface& surface) const {
    std::vector<std::size_t> order(points_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return points_[a].x < points_[b].x;
    });
    for (std::size_t a = 0; a < order.size(); ++a) {
      const ScatteredPoint& p = points_[order[a]];
      for (std::size_t b = a + 1; b < order.size(); ++b) {
        const ScatteredPoint& q = points_[order[b]];
        if (q.x - p.x > options_.same_place_within) {
          break;
        }
        if (std::hypot(q.x - p.x, q.y - p.y) > options_.same_place_within) {
          continue;
        }
        const double sigma = std::sqrt(surface.fit_.sigma2) * std::hypot(p.sigma, q.sigma);
        const double t = (q.z - p.z) / sigma;
        if (std::abs(t) > options_.contradicted_from) {
          for (const std::size_t index : {order[a], order[b]}) {
            surface.flags_.push_back(
                {index, PointDoubt::repeats_disagree, index == order[a] ? -t : t, weight_[index]});
          }
        }
      }
    }
  }

  std::span<const ScatteredPoint> points_;
  ScatteredOptions options_;
  BsplineBasis basis_;
  std::vector<double> weight_;
  std::vector<Row> rows_;
  std::vector<LeftOut> left_out_;
  Eigen::MatrixXd penalty_;
  double mean_ = 0.0;
};

ValueGradient ScatteredSurface::at(double x, double y) const {
  return basis_.evaluate(fit_.coefficients, x, y);
}

double ScatteredSurface::sigma(double x, double y) const {
  const BasisSupport row = basis_.at(x, y);
  double variance = 0.0;
  for (std::size_t a = 0; a < 16; ++a) {
    for (std::size_t b = 0; b < 16; ++b) {
      variance +=
          row.value[a] * row.value[b] * fit_.corrected_covariance(row.index[a], row.index[b]);
    }
  }
  return std::sqrt(std::max(0.0, variance));
}

tl::expected<ScatteredSurface, ScatteredFailure> fit_scattered(
    std::span<const ScatteredPoint> points, const ScatteredOptions& options) {
  check(points, options);
  if (points.size() < kFewestPoints) {
    return refuse(
        ScatteredFailure::Reason::too_few_points,
        fmt::format(
            "{} points are too few for a surface: {} are the least", points.size(), kFewestPoints));
  }
  if (narrowness(points) < 1e-3) {
    return refuse(ScatteredFailure::Reason::on_a_line,
                  "all points lie on one line: they say nothing about the surface beside it");
  }
  ScatteredOptions filled = options;
  if (!filled.rectangle) {
    filled.rectangle = bounding_box(points);
  }
  choose_intervals(*filled.rectangle, points.size(), filled);
  return ScatteredFitter(points, filled).run();
}

}  // namespace chaintrue::interp
