// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/null_distribution.hpp"

#include "grid/parallel.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// `prepare` makes residuals of a block of standard normals.
template <class Prepare>
NullDistribution drawn(const SingleScore& score,
                       Eigen::Index rows,
                       int draws,
                       std::uint64_t seed,
                       const Prepare& prepare) {
  constexpr std::uint64_t kStream = 61;
  constexpr int kBlock = 250;  // draws at a time
  Random random(seed, kStream);
  std::vector<Eigen::MatrixXd> blocks;
  for (int done = 0; done < draws; done += kBlock) {
    Eigen::MatrixXd& e = blocks.emplace_back(rows, std::min(kBlock, draws - done));
    for (double& own : e.reshaped()) own = random.normal();
  }
  NullDistribution result;
  result.largest.resize(as_size(draws));
  for_each_index(blocks.size(), [&](std::size_t k) {
    prepare(blocks[k]);
    const Eigen::VectorXd largest = score.largest(blocks[k]);
    std::copy(largest.begin(), largest.end(), result.largest.begin() + static_cast<std::ptrdiff_t>(k) * kBlock);
    blocks[k].resize(0, 0);
  });
  sort(result.largest);
  return result;
}

}  // namespace

NullDistribution draw_null(const SingleScore& score,
                           Eigen::Index rows,
                           int draws,
                           std::uint64_t seed) {
  return drawn(score, rows, draws, seed, [](Eigen::MatrixXd&) {});
}

NullDistribution draw_null_of_length(const SingleScore& score,
                                     const MarginalisedSystem& marginalised,
                                     int draws,
                                     std::uint64_t seed) {
  const double length = marginalised.e.norm();
  return drawn(score, marginalised.e.size(), draws, seed, [&](Eigen::MatrixXd& e) {
    e = marginalised.root.solve(e);
    for (Eigen::Index k = 0; k < e.cols(); ++k) e.col(k) *= length / e.col(k).norm();
  });
}

}  // namespace chaintrue::grid::diagnosis
