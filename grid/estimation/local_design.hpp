// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The design of many readings in sparse form: few unknowns densely, the surface only through the
/// splines at each place. Private to grid/estimation.
///
///   X = D M,   M = diag(I, B, B)                                                              (1)
///   X' w X = M' (D' w D) M,   X_u C X_u' = D_u (M C M') D_u'                                  (2)
///
/// D holds the columns of all unknowns but the penalised ones, and phi(place) for each chain; B turns these
/// into splines (observed_subspace.hpp). A row of D has some 50 entries where one of X has 350: (2)
/// costs n 50^2 + q^3 in place of n q^2, for n rows and q unknowns.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/estimation/linearised_system.hpp"
#include "grid/estimation/observed_subspace.hpp"
#include "grid/estimation/unknowns.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "interp/reml.hpp"

namespace chaintrue::grid::estimation {

/// Units and response are those of the dense design; they must outlive this.
class LocalDesign {
 public:
  /// `marks` are the places of all units, in the surface's frame.
  LocalDesign(const MatrixXd& design, const std::vector<SystemUnit>& units,
              const Unknowns& unknowns, const ObservedSubspace& observed,
              const interp::BsplineBasis& basis, const std::vector<MarkPoint>& marks)
      : units_(units), rows_(as_size(design.rows())) {
    const Index penalised = observed.penalised.cols();
    const Index first_bend = unknowns.first_penalised_of(Side::left);
    const Index plain = unknowns.total() - 2 * penalised;
    const auto splines = [&](Side side) { return plain + row_of(side) * basis.size(); };
    to_unknowns_ = MatrixXd::Zero(plain + 2 * basis.size(), unknowns.total());
    ColumnSet columns;
    for (const Index k : each_below(unknowns.total())) {
      if (k >= first_bend && k < first_bend + 2 * penalised) continue;
      to_unknowns_(std::ssize(columns), k) = 1.0;
      columns.push_back(k);
    }
    for (const Side side : kSides) {
      to_unknowns_.block(splines(side), unknowns.first_penalised_of(side), basis.size(),
                         penalised) = observed.penalised;
    }
    for (const Index k : each_below(plain)) {
      const auto column = design.col(columns[as_size(k)]);
      for (const Index row : each_below(design.rows())) {
        if (column[row] != 0.0) rows_[as_size(row)].emplace_back(k, column[row]);
      }
    }
    for (const SystemUnit& unit : units) {
      for (const observation::PlaceColumns& place : unit.places) {
        const interp::BasisSupport at = basis.at(marks[place.place].x_mm, marks[place.place].y_mm);
        for (const Index i : each_below(unit.rows)) {
          auto& row = rows_[as_size(unit.first_row + i)];
          for (const Side side : kSides) {
            const double by_chain = place.by_chain(i, row_of(side));
            for (std::size_t k = 0; by_chain != 0.0 && k < at.index.size(); ++k)
              row.emplace_back(splines(side) + at.index[k], by_chain * at.value[k]);
          }
        }
      }
    }
  }

  /// Worth its cost of q^3 with more rows than this per unknown.
  static constexpr Index kRowsForEachUnknown = 4;

  /// Adds the rows of positive weight by [X y]' w [X y]; a weight for each unit.
  void add_rows(const VectorXd& response, const VectorXd& weights,
                interp::PenalisedProblem& problem) const {
    const auto [size, unknowns] = std::pair(to_unknowns_.rows(), to_unknowns_.cols());
    MatrixXd gram = MatrixXd::Zero(size + 1, size + 1);
    Index count = 0;
    for (const auto u : each_index(units_)) {
      const double weight = weights[as_index(u)];
      if (weight == 0.0) continue;
      count += units_[u].rows;
      for (const Index i : each_below(units_[u].rows)) {
        const Index at = units_[u].first_row + i;
        std::vector<Entry> row = rows_[as_size(at)];
        row.emplace_back(size, response[at]);
        // Columns rise along a row except where two places meet: entries above the diagonal are added
        // below it.
        for (const auto a : each_index(row)) {
          const double value = weight * row[a].second;
          for (std::size_t b = 0; b <= a; ++b) {
            const auto [low, high] = std::minmax(row[a].first, row[b].first);
            const bool twice = a != b && low == high;
            gram(high, low) += (twice ? 2.0 : 1.0) * value * row[b].second;
          }
        }
      }
    }
    gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
    MatrixXd to_all = MatrixXd::Zero(size + 1, unknowns + 1);
    to_all.topLeftCorner(size, unknowns) = to_unknowns_;
    to_all(size, unknowns) = 1.0;
    problem.add_products(count, linear::carried(linear::transposed(to_all), gram));
  }

  /// X_u C X_u' of every unit.
  std::vector<MatrixXd> spreads(const MatrixXd& covariance) const {
    const MatrixXd local = linear::carried(to_unknowns_, covariance);
    std::vector<MatrixXd> result;
    result.reserve(units_.size());
    for (const SystemUnit& unit : units_) {
      MatrixXd spread(unit.rows, unit.rows);
      for (const Index i : each_below(unit.rows)) {
        for (Index j = 0; j <= i; ++j) {
          double sum = 0.0;
          for (const auto& [a, left] : rows_[as_size(unit.first_row + j)]) {
            double part = 0.0;
            for (const auto& [b, right] : rows_[as_size(unit.first_row + i)])
              part += local(b, a) * right;
            sum += left * part;
          }
          spread(i, j) = spread(j, i) = sum;
        }
      }
      result.push_back(std::move(spread));
    }
    return result;
  }

 private:
  using Entry = std::pair<Index, double>;  ///< column of D, value

  const std::vector<SystemUnit>& units_;
  std::vector<std::vector<Entry>> rows_;  ///< of D
  MatrixXd to_unknowns_;                  ///< M
};

}  // namespace chaintrue::grid::estimation
