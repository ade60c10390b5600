// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Searches for the intended meaning of a file's numbers: transformations (a sign, a unit, an
/// origin, a turn, a scale, an exchange) of all rows, of those from one on, of those up to one, or
/// of some. Used for marks, distances and drawings.
///
///   r_i = B_i beta + e_i                                            (1) of robust_trend.hpp
///
/// The account of each transformation T and set of rows S is (1) of the rows with T applied to S, less the
/// logarithm of how many such S there are. S is where T makes rows likelier: the sum over the tail, the
/// head, or the rows themselves, about the trends of no rows and of all rows, then about S's own.
///
/// \code
///   std::vector<Candidate> candidates = searched(sigma, rows_of({}), {inches, turned_round}, name_of_row);
///   const auto finding = whole_finding(std::move(candidates), plain, tried, kOdd, "half are ...");
/// \endcode
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/input_checks/findings.hpp"
#include "grid/input_checks/robust_trend.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::input_checks {

/// A suspected meaning of a row's two coordinates or lengths: A x + b of the numbers entered.
struct Affine {
  Matrix2d by = Matrix2d::Identity();
  Vector2d plus = Vector2d::Zero();

  template <class Pair>
  Pair of(const Pair& written) const {
    const Vector2d meant = by * vector_of(written) + plus;
    return {meant.x(), meant.y()};
  }
};
inline Affine times(double x, double y) { return {Vector2d(x, y).asDiagonal()}; }
inline Affine swapped() { return {Matrix2d{{0, 1}, {1, 0}}}; }

/// The affected rows of a file.
using RowSet = Flags;

struct Transformation {
  ProblemKind kind = ProblemKind::axes;
  /// What was expected, and what it looks like: "x_mm and y_mm look like inches: multiply them by 25.4".
  std::string sentence;
  /// All rows, with those of the set corrected.
  std::function<TrendRows(const RowSet&)> mended;
  /// Which rows it may affect: all; a tail; all or any part; only a part.
  enum class Of { all, tail, any, part } of = Of::any;
  /// A wrongly stated machine would look the same.
  bool is_doubtful = false;
  /// Logarithm of the number of possible values of a parameter estimated from the file.
  double penalty = 0.0;
};

/// Transformations that change what a file holds of single rows.
template <class Data>
class Transformations {
 public:
  using RowsOf = std::function<TrendRows(const Data&)>;

  /// `written` must outlive the transformations.
  Transformations(const Data& written, RowsOf rows_of)
      : written_(written), rows_of_(std::move(rows_of)) {}

  Transformation& add(ProblemKind kind, std::string sentence,
                      const std::function<void(Data&, std::size_t row)>& mend) {
    const auto mended = [&written = written_, rows_of = rows_of_, mend](const RowSet& rows) {
      Data meant = written;
      for (const auto i : each_index(rows)) {
        if (rows[i]) mend(meant, i);
      }
      return rows_of(meant);
    };
    list_.push_back({kind, std::move(sentence), mended});
    return list_.back();
  }
  std::vector<Transformation> take() { return std::move(list_); }

 private:
  const Data& written_;
  RowsOf rows_of_;
  std::vector<Transformation> list_;
};

Account account_of(const RobustTrend& trend);

/// An account for each transformation of all rows, and for the likeliest part of them if it is much
/// likelier than no row. `name_of_row` is the row's own number.
std::vector<Candidate> searched(const VectorXd& prior_sigma_mm, const TrendRows& as_written,
                                const std::vector<Transformation>& transformations,
                                const std::function<std::string(std::size_t)>& name_of_row);

}  // namespace chaintrue::grid::input_checks
