// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sets of causes that matter in one marginalised system: one and two at a time all of them,
/// three and four at a time grown from the best, and the leading ones once more given a model
/// discrepancy.
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
  /// After run(). Of these kernels; sets what each was found to weigh.
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
