// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lengths of a mechanism that has more of them than a position has coordinates, such as four
/// belts, with the tool at a known or unknown place.
///
///   l    lengths that count, m of them, one sigma each
///   f    predicted by the mechanism at q                                m
///   J    d(f)/d(q)                                                            m x 2
///
/// A place that is known is a unit of m rows, y = l with covariance sigma^2 I + sigma_q^2 J J', as a
/// mark of two chains. Of one that is not known q is the position with the least |l - f|, and
/// columns Q span what is orthogonal to J:
///
///   y = 0,   predicted = -Q' (l - f),   A = Q' df/dtheta,   covariance sigma^2 I_(m-2)       (1)
///
/// Two lengths determine the position; m - 2 rows remain as checks. A is the derivative without dQ,
/// which is multiplied by the residuals at q and is neglected: the least squares are the same, and
/// passes converge as fast. With fewer than three counted lengths a place has no rows and is not a
/// unit. A single reading may be an outlier: its effect on the rows is its column of Q'.
///
/// Places that taped distances join are a block: positions, lengths and distances of a block are
/// found, and projected out, together. Its rows are in units of two, the distances scaled to the
/// lengths' sigma. A distance that ends at no place is a separate unit; one that ends where fewer
/// than two lengths count carries no information and is left out.
///
/// Source: G. Golub and V. Pereyra, The differentiation of pseudo-inverses and nonlinear least squares
/// problems whose variables separate, SIAM J. Numer. Anal. 10 (1973) 413; L. Kaufman, BIT 15 (1975)
/// 49, for A without dQ.
///
/// \code
///   const BeltLengthReadings readings(places, false, {.length_mm = 0.5}, 15.0);
///   const auto line = readings.linearise(View(mechanism), columns_of(readings));
/// \endcode
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <optional>
#include <string>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/observation.hpp"
#include "grid/observation/taped_ends.hpp"
#include "grid/precondition.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::observation {

struct LengthsAtPlace {
  std::size_t index = 0;  ///< into the file's points
  std::string name;       ///< "3"
  Eigen::VectorXd lengths_mm;
  std::vector<bool> counting;  ///< of each length; empty: all
  model::MechanismVisit visit;
  /// Where the tool was, in the mechanism's frame; empty: unknown.
  std::optional<model::ToolPosition> known = std::nullopt;
  /// Counting lengths that are not used to find the position; empty: none.
  std::vector<bool> rejected = {};
  /// For an unknown position: q to linearise about. The residuals are those there; to first order
  /// they do not depend on a nearby q. Empty: q of (1).
  std::optional<model::ToolPosition> about = std::nullopt;

  [[nodiscard]] bool counts(Eigen::Index length) const {
    return counting.empty() || counting.at(as_size(length));
  }
  [[nodiscard]] Eigen::Index counted() const {
    Eigen::Index count = 0;
    for (Eigen::Index i = 0; i < lengths_mm.size(); ++i) count += counts(i) ? 1 : 0;
    return count;
  }
};

/// One sigma of a length, and of a known position on each axis.
struct BeltNoise {
  double length_mm = 1.0;
  double position_mm = 0.0;
};

/// Lengths and distances whose positions are found together, about a view.
struct BlockLine {
  std::vector<model::ToolPosition> positions;
  Eigen::VectorXd residual_mm;   ///< all lengths place by place, then the distances
  Eigen::MatrixXd by_position;   ///< times 2 a place
  Eigen::MatrixXd by_parameter;  ///< times p, or 0
  Eigen::VectorXd weight;        ///< relative to that of a length; 0: does not count
};

class BeltLengthReadings final : public Observation {
 public:
  /// Sorts the places: by visit where the order is known, else by lengths. Distances name places by
  /// LengthsAtPlace::index. \throws std::invalid_argument for a sigma that is not positive, and for a
  /// distance to a place that is known or has a position to linearise about.
  BeltLengthReadings(std::vector<LengthsAtPlace> places,
                     bool ordered,
                     BeltNoise noise,
                     double noise_dof,
                     std::vector<TapedDistance> distances = {});

  /// Places that are found together (indices into places()) and the distances that join them; a
  /// single place has no distances.
  struct Block {
    std::vector<std::size_t> places;
    std::vector<std::size_t> distances;
  };

  [[nodiscard]] const Kind& kind() const override { return belt_lengths; }
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override {
    const Eigen::Index parameters = columns.parameters ? view.mechanism->values().size() : 0;
    Linearisation result = blank(parameters + (columns.sheet ? 3 : 0));
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const std::size_t end = b + 1 < blocks_.size() ? first_unit_[b + 1] : units_.size();
      if (first_unit_[b] == end) continue;
      auto own = rows_of(view, blocks_[b], columns.parameters);
      if (!own) return tl::unexpected(own.error());
      const Eigen::Index first = units_[first_unit_[b]].first_row;
      result.predicted.segment(first, own->predicted.size()) = own->predicted;
      result.by_setting.block(first, 0, own->predicted.size(), parameters) = own->by_parameter;
      for (std::size_t u = first_unit_[b]; u < end; ++u) {
        const Eigen::Index at = units_[u].first_row - first;
        result.units.push_back(
            {own->covariance.block(at, at, units_[u].rows, units_[u].rows), {}, own->by_reading});
      }
    }
    return result;
  }
  [[nodiscard]] std::string name_of(std::size_t unit) const override {
    const std::size_t place = place_of_unit_.at(unit);
    if (place < places_.size()) return "point " + places_[place].name;
    return fmt::format("distance {}", units_.at(unit).index + 1);
  }
  [[nodiscard]] std::shared_ptr<const Observation> about_others(
      const std::vector<UnitReading>& rejected) const override {
    auto other = std::make_shared<BeltLengthReadings>(*this);
    for (LengthsAtPlace& place : other->readings_) place.rejected.clear();
    for (const UnitReading& one : rejected) {
      LengthsAtPlace& place = other->readings_.at(place_of_unit_.at(one.unit));
      if (place.rejected.empty()) place.rejected.assign(as_size(place.lengths_mm.size()), false);
      place.rejected.at(as_size(one.reading)) = true;
    }
    return other;
  }

  /// Every place with two counted lengths, and every distance that ends at no place, once.
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  [[nodiscard]] const std::vector<TapedDistance>& distances() const { return distances_; }
  [[nodiscard]] tl::expected<BlockLine, Unreachable> block_line(const View& view,
                                                                const Block& block,
                                                                bool with_parameters) const;

  /// In the order of places().
  [[nodiscard]] const std::vector<LengthsAtPlace>& readings() const { return readings_; }
  /// The unit's place; for a block of several its first.
  [[nodiscard]] std::size_t place_of(std::size_t unit) const { return place_of_unit_.at(unit); }

 private:
  /// Rows about a view: f, A and C of one block's units together.
  struct BlockRows {
    Eigen::VectorXd predicted;
    Eigen::MatrixXd by_parameter;
    Eigen::MatrixXd covariance;
    Eigen::MatrixXd by_reading;
  };
  [[nodiscard]] tl::expected<BlockRows, Unreachable> rows_of(const View& view,
                                                             const Block& block,
                                                             bool with_parameters) const {
    const auto line = block_line(view, block, with_parameters);
    if (!line) return tl::unexpected(line.error());
    const LengthsAtPlace* first =
        block.places.empty() ? nullptr : &readings_[block.places.front()];
    const bool is_known = first != nullptr && first->known;
    const bool is_alone = block.places.size() == 1 && block.distances.empty();
    if (is_alone && !is_known && line->weight.size() == 4 && line->weight.minCoeff() == 1.0)
      return rows_of_four(*line);
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < line->weight.size(); ++i) {
      if (line->weight[i] > 0.0) rows.push_back(i);
    }
    const auto count = std::ssize(rows);
    const double variance = noise_.length_mm * noise_.length_mm;
    const Eigen::VectorXd root = line->weight(rows).cwiseSqrt();
    const Eigen::MatrixXd by_position = root.asDiagonal() * line->by_position(rows, Eigen::all);
    const Eigen::MatrixXd by_parameter = root.asDiagonal() * line->by_parameter(rows, Eigen::all);
    if (is_known) {
      return BlockRows{first->lengths_mm(rows) - line->residual_mm(rows),
                       by_parameter,
                       variance * Eigen::MatrixXd::Identity(count, count) +
                           noise_.position_mm * noise_.position_mm * linear::outer(by_position),
                       {}};
    }
    const Eigen::Index left = count - by_position.cols();
    const Eigen::MatrixXd checks =  // Q
        first == nullptr ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(count, count))
                         : Eigen::MatrixXd(linear::qr(by_position).q.rightCols(left));
    BlockRows result{-linear::product(linear::transposed(checks),
                                      Eigen::VectorXd(root.cwiseProduct(line->residual_mm(rows)))),
                     linear::product(linear::transposed(checks), by_parameter),
                     variance * Eigen::MatrixXd::Identity(left, left),
                     {}};
    if (is_alone) {
      result.by_reading = Eigen::MatrixXd::Zero(left, line->weight.size());
      result.by_reading(Eigen::all, rows) = checks.transpose();
    }
    return result;
  }

  /// rows_of() for four counted lengths at one place, the usual case, with matrices of fixed size.
  [[nodiscard]] BlockRows rows_of_four(const BlockLine& line) const {
    const Eigen::Matrix<double, 4, 2> by_position = line.by_position;
    const Eigen::Matrix4d q =
        Eigen::HouseholderQR<Eigen::Matrix<double, 4, 2>>(by_position).householderQ();
    const Eigen::Matrix<double, 2, 4> checks = q.rightCols<2>().transpose();
    const double variance = noise_.length_mm * noise_.length_mm;
    return {-checks * line.residual_mm,
            checks * line.by_parameter,
            variance * Eigen::Matrix2d::Identity(),
            checks};
  }

  void join_places();
  void number_rows(const Block& block, std::vector<double>& measured);
  [[nodiscard]] tl::expected<void, Unreachable> find_positions(const View& view,
                                                               const Block& block,
                                                               BlockLine& line) const;
  [[nodiscard]] tl::expected<BlockLine, Unreachable> line_at(
      const View& view,
      const Block& block,
      std::vector<model::ToolPosition> positions,
      bool with_parameters) const;

  std::vector<LengthsAtPlace> readings_;
  std::vector<TapedDistance> distances_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> first_unit_;  ///< of each block
  std::vector<std::size_t> block_of_;    ///< of each place; blocks_.size(): of none
  std::vector<std::size_t> place_of_unit_;
  BeltNoise noise_;
};

}  // namespace chaintrue::grid::observation
