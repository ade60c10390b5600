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

#include <optional>
#include <string>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/observation.hpp"
#include "grid/observation/taped_ends.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::observation {

struct LengthsAtPlace {
  std::size_t index = 0;  ///< into the file's points
  std::string name;       ///< "3"
  VectorXd lengths_mm;
  Flags counting;  ///< of each length; empty: all
  model::MechanismVisit visit;
  /// Where the tool was, in the mechanism's frame; empty: unknown.
  std::optional<ToolPosition> known = std::nullopt;
  /// Counting lengths that are not used to find the position; empty: none.
  Flags rejected = {};
  /// For an unknown position: q to linearise about. The residuals are those there; to first order
  /// they do not depend on a nearby q. Empty: q of (1).
  std::optional<ToolPosition> about = std::nullopt;

  bool counts(Index length) const { return counting.empty() || counting.at(as_size(length)); }
  Index counted() const {
    Index count = 0;
    for (const Index i : each_below(lengths_mm.size())) count += counts(i) ? 1 : 0;
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
  std::vector<ToolPosition> positions;
  VectorXd residual_mm;   ///< all lengths place by place, then the distances
  MatrixXd by_position;   ///< times 2 a place
  MatrixXd by_parameter;  ///< times p, or 0
  VectorXd weight;        ///< relative to that of a length; 0: does not count
};

class BeltLengthReadings final : public Observation {
 public:
  /// Sorts the places: by visit where the order is known, else by lengths. Distances name places by
  /// LengthsAtPlace::index. \throws std::invalid_argument for a sigma that is not positive, and for a
  /// distance to a place that is known or has a position to linearise about.
  BeltLengthReadings(std::vector<LengthsAtPlace> places, bool ordered, BeltNoise noise,
                     double noise_dof, std::vector<TapedDistance> distances = {});

  /// Places that are found together (indices into places()) and the distances that join them; a
  /// single place has no distances.
  struct Block {
    Indices places;
    Indices distances;
  };

  const Kind& kind() const override { return belt_lengths; }
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override;
  std::string name_of(std::size_t unit) const override;
  std::shared_ptr<const Observation> about_others(
      const std::vector<UnitReading>& rejected) const override;

  /// Every place with two counted lengths, and every distance that ends at no place, once.
  const std::vector<Block>& blocks() const { return blocks_; }
  const std::vector<TapedDistance>& distances() const { return distances_; }
  [[nodiscard]] tl::expected<BlockLine, Unreachable> block_line(const View& view,
                                                                const Block& block,
                                                                bool with_parameters) const;

  /// In the order of places().
  const std::vector<LengthsAtPlace>& readings() const { return readings_; }
  /// The unit's place; for a block of several its first.
  std::size_t place_of(std::size_t unit) const { return place_of_unit_.at(unit); }

 private:
  /// Rows about a view: f, A and C of one block's units together.
  struct BlockRows {
    VectorXd predicted;
    MatrixXd by_parameter;
    MatrixXd covariance;
    MatrixXd by_reading;
  };
  [[nodiscard]] tl::expected<BlockRows, Unreachable> rows_of(const View& view, const Block& block,
                                                             bool with_parameters) const;

  void join_places();
  void number_rows(const Block& block, std::vector<double>& measured);
  [[nodiscard]] tl::expected<void, Unreachable> find_positions(const View& view, const Block& block,
                                                               BlockLine& line) const;
  [[nodiscard]] tl::expected<BlockLine, Unreachable> line_at(const View& view, const Block& block,
                                                             std::vector<ToolPosition> positions,
                                                             bool with_parameters) const;

  std::vector<LengthsAtPlace> readings_;
  std::vector<TapedDistance> distances_;
  std::vector<Block> blocks_;
  Indices first_unit_;  ///< of each block
  Indices place_of_unit_;
  BeltNoise noise_;
};

}  // namespace chaintrue::grid::observation
