// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Searches the relevant sets of causes in one marginalised system: all of one and two, three and
/// four grown from the best, and the leading ones again given a model discrepancy.
#pragma once

#include <memory>
#include <vector>

#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {

class SetSearch {
 public:
  /// `number` is the marginalised system's in its comparison; all references must outlive the
  /// search.
  SetSearch(const RegressorSystem& system,
            MarginalisedSystem& marginalised,
            std::size_t number,
            const ComparisonOptions& options);
  ~SetSearch();
  SetSearch(SetSearch&&) noexcept;
  SetSearch& operator=(SetSearch&&) noexcept;

  [[nodiscard]] std::vector<CandidateModel> run();
  /// Call after run(). For these kernels; sets their weights.
  [[nodiscard]] std::vector<CandidateModel> run_given_discrepancies(
      const std::vector<std::size_t>& kernels, std::vector<double>& kernel_weight);
  /// Largest weight so far.
  [[nodiscard]] double best() const;
  [[nodiscard]] const std::vector<bool>& outliers() const;

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

}  // namespace chaintrue::grid::diagnosis
