// SPDX-License-Identifier: GPL-3.0-or-later
// Columns stored as multiples of shared columns, compared with the full matrix.
#include "grid/diagnosis/regressor_system.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "grid/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kRounding = 1e-13;  // of sums of a dozen numbers of order one

struct Both {
  RegressorColumns shared{12};
  Eigen::MatrixXd dense{12, 0};
};

Both both(std::uint64_t seed) {
  Random random(seed);
  Both result;
  const auto append = [&](const Eigen::VectorXd& column) {
    result.dense.conservativeResize(Eigen::NoChange, result.dense.cols() + 1);
    result.dense.rightCols<1>() = column;
  };
  for (int distinct = 0; distinct < 40; ++distinct) {
    Eigen::VectorXd column(12);
    for (double& value : column) value = random.normal();
    result.shared.add(column, -3.0);
    append(-3.0 * column);
    for (int multiple = 1; multiple <= distinct % 4; ++multiple) {
      result.shared.add_multiple(multiple);
      append(multiple * column);
    }
  }
  return result;
}

TEST(RegressorColumns, EqualTheFullMatrix) {
  const auto [shared, dense] = both(1);
  ASSERT_EQ(shared.cols(), dense.cols());
  const Eigen::VectorXd e = Eigen::VectorXd::LinSpaced(12, -1.0, 2.0);
  EXPECT_LT((shared.transpose_times(e) - dense.transpose() * e).norm(), 100.0 * kRounding);
  const Eigen::MatrixXd map = Eigen::MatrixXd::Random(5, 12);
  EXPECT_LT((shared.transpose_times(Eigen::MatrixXd(map.transpose())) -
             dense.transpose() * map.transpose())
                .norm(),
            1000.0 * kRounding);
  const Eigen::VectorXd squares = (map * dense).colwise().squaredNorm();
  EXPECT_LT((shared.squared_norms(
                 [&](const Eigen::VectorXd& column) -> Eigen::VectorXd { return map * column; }) -
             squares)
                .norm(),
            1e4 * kRounding);
  std::vector<int> all;
  for (int k = 0; k < static_cast<int>(dense.cols()); ++k) {
    EXPECT_LT((shared.col(k) - dense.col(k)).norm(), kRounding) << k;
    all.push_back(k);
  }
  EXPECT_LT((shared.dense(all) - dense).norm(), kRounding);
}

TEST(RegressorColumns, SelectSome) {
  const auto [shared, dense] = both(7);
  const std::vector<Eigen::Index> some = {0, 2, 3, 9, 10, 30};
  const RegressorColumns chosen = shared.subset(some);
  ASSERT_EQ(chosen.cols(), 6);
  for (Eigen::Index k = 0; k < 6; ++k) {
    EXPECT_EQ((chosen.col(k) - dense.col(some[static_cast<std::size_t>(k)])).norm(), 0.0) << k;
  }
}

TEST(RegressorColumns, RefuseWrongSizes) {
  RegressorColumns columns(3);
  EXPECT_THROW(columns.add_multiple(2.0), std::invalid_argument);
  EXPECT_THROW(columns.add(Eigen::VectorXd::Zero(4)), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
