// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/null_distribution.hpp"

#include "grid/parallel.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid::diagnosis {

NullDistribution draw_null(const SingleScore& score, const MarginalisedSystem& marginalised,
                           NoiseSize noise, int draws, std::uint64_t seed) {
  constexpr std::uint64_t kStream = 61;
  constexpr int kBlock = 250;  // draws at a time
  Random random(seed, kStream);
  std::vector<MatrixXd> blocks;
  for (int done = 0; done < draws; done += kBlock) {
    MatrixXd& e = blocks.emplace_back(marginalised.e.size(), std::min(kBlock, draws - done));
    for (double& own : e.reshaped()) own = random.normal();
  }
  const double length = marginalised.e.norm();
  NullDistribution result;
  result.largest.resize(as_size(draws));
  for_each_index(blocks.size(), [&](std::size_t k) {
    MatrixXd& e = blocks[k];
    if (noise == NoiseSize::unknown) {
      e = marginalised.root.solve(e);
      for (const Index draw : each_below(e.cols())) e.col(draw) *= length / e.col(draw).norm();
    }
    const VectorXd largest = score.largest(e);
    std::copy(largest.begin(), largest.end(),
              result.largest.begin() + static_cast<std::ptrdiff_t>(k) * kBlock);
    e.resize(0, 0);
  });
  sort(result.largest);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
