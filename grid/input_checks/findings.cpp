// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"

namespace chaintrue::grid::input_checks {

std::optional<WholeFinding> whole_finding(std::vector<Candidate> candidates, const Account& plain,
                                          std::size_t also_tried, double odd_trend,
                                          std::string found) {
  const std::size_t tried = std::max<std::size_t>(candidates.size() + also_tried, 1);
  const double needed = plain.log_likelihood + kHundredTimes + std::log(as_double(tried));
  std::erase_if(candidates, [&](const Candidate& candidate) {
    const Account& account = candidate.account;
    return !(account.median_mm < kSoundMm) || !(account.prior_chi_square < odd_trend) ||
           account.log_likelihood < needed;
  });
  if (candidates.empty()) return std::nullopt;
  stable_sort(candidates,
              descending([](const Candidate& one) { return one.account.log_likelihood; }));
  const Candidate& best = candidates.front();
  WholeFinding finding{best.from_row,    best.sentence,          std::move(found),
                       best.is_doubtful, best.account.median_mm, best.kind};
  // Two accounts this near each other are both reported.
  constexpr double kEquallyLikely = 3.0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const Candidate& other = candidates[i];
    if (best.account.log_likelihood - other.account.log_likelihood > kEquallyLikely) break;
    if (other.sentence == best.sentence || other.from_row != best.from_row) continue;
    finding.mistake += fmt::format("; or {}", other.sentence);
    break;
  }
  return finding;
}

std::string_view or_say_inches(Written written) {
  return written == Written::in_table ? ", or use --inches" : "";
}

std::string WholeFinding::sentence() const {
  if (!mended_mm) return fmt::format("{} ({})", mistake, found);
  return fmt::format("{} (as it is, {}; corrected, they agree to {:.1f} mm)", mistake, found,
                     *mended_mm);
}

std::string length_in_words(double mm) {
  constexpr double kOneMetreMm = 1000.0;
  if (!std::isfinite(mm)) return "out of reach";
  return mm < kOneMetreMm ? fmt::format("{:.0f} mm", mm)
                          : fmt::format("{:.1f} m", mm / kOneMetreMm);
}

}  // namespace chaintrue::grid::input_checks
