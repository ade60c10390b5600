// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/transformation_search.hpp"

#include <fmt/format.h>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace chaintrue::grid::input_checks {
namespace {

/// Before a trend is known.
constexpr double kCoarseMm = 20.0;
/// A row that is missing.
constexpr double kMissingMm = 1000.0;
/// Fewer rows are treated one by one.
constexpr std::size_t kFewestRows = 3;
/// A smaller share of scattered rows is reported one by one.
constexpr double kLeastShare = 0.2;

struct Part {
  RowSet rows;
  std::optional<std::size_t> from_row;
  std::string words;
  double penalty = 0.0;
};

/// Gain in log-likelihood of each row by the correction, about a trend.
std::vector<double> gains(const TrendRows& plain, const TrendRows& mended, const MatrixXd& trend,
                          double scale_mm) {
  const Index components = plain.off_mm.cols();
  const auto density = [&](const TrendRows& rows, Index i) {
    const double off_mm = (rows.off_mm.row(i) - rows.basis.row(i) * trend).norm();
    return log_density_of(std::isfinite(off_mm) ? off_mm : kMissingMm, scale_mm, components);
  };
  return mapped(each_below(plain.off_mm.rows()),
                [&](Index i) { return density(mended, i) - density(plain, i); });
}

/// Where the sum over the rows from one on is the largest.
std::size_t tail_of(const std::vector<double>& gain) {
  std::size_t from = gain.size();
  double sum = 0.0, most = 0.0;
  for (std::size_t i = gain.size(); i-- > 0;) {
    sum += gain[i];
    if (sum <= most) continue;
    most = sum;
    from = i;
  }
  return from;
}

double log_choices(std::size_t of, std::size_t taken) {
  const auto gamma = [](std::size_t n) { return std::lgamma(as_double(n) + 1.0); };
  return gamma(of) - gamma(taken) - gamma(of - taken);
}

class Search {
 public:
  Search(const VectorXd& sigma_mm, const TrendRows& plain,
         const std::function<std::string(std::size_t)>& name_of_row)
      : sigma_mm_(sigma_mm),
        plain_(plain),
        plain_trend_(robust_trend(plain, sigma_mm)),
        name_of_row_(name_of_row) {}

  void take(const Transformation& own, std::vector<Candidate>& candidates) const {
    const TrendRows all = own.mended(RowSet(count(), true));
    const RobustTrend whole = trend_of(all);
    if (own.of == Transformation::Of::all || own.of == Transformation::Of::any)
      add(own, whole, {{}, std::nullopt, "", 0.0}, candidates);
    if (own.of == Transformation::Of::all || count() < 2 * kFewestRows) return;
    std::vector<RowSet> seen;
    const MatrixXd none = MatrixXd::Zero(plain_.basis.cols(), plain_.off_mm.cols());
    for (const MatrixXd& about : {none, plain_trend_.coefficients, whole.coefficients}) {
      for (Part part : parts_of(own, gains(plain_, all, about, kCoarseMm)))
        refine(own, all, std::move(part), seen, candidates);
    }
  }

 private:
  std::size_t count() const { return as_size(plain_.off_mm.rows()); }
  RobustTrend trend_of(const TrendRows& rows) const { return robust_trend(rows, sigma_mm_); }

  void add(const Transformation& own, const RobustTrend& trend, const Part& part,
           std::vector<Candidate>& candidates) const {
    Candidate candidate{own.kind, part.words + own.sentence, account_of(trend)};
    candidate.account.log_likelihood -= part.penalty + own.penalty;
    // For the same rows another transformation may change the same numbers.
    const bool is_told = any_of(candidates, [&](const Candidate& other) {
      return other.kind == candidate.kind && other.from_row == part.from_row &&
             other.account.log_likelihood == candidate.account.log_likelihood;
    });
    if (is_told) return;
    candidate.from_row = part.from_row;
    candidate.is_doubtful = own.is_doubtful;
    candidates.push_back(std::move(candidate));
  }

  /// Tail, head and single rows, if their total gain suffices for a finding.
  std::vector<Part> parts_of(const Transformation& own, const std::vector<double>& gain) const {
    std::vector<Part> parts;
    const std::size_t n = count();
    const auto offer = [&](auto has, std::optional<std::size_t> from, std::string words,
                           double penalty) {
      RowSet rows = mapped(each_below(n), has);
      double sum = 0.0;
      for (const auto i : each_index(rows)) sum += rows[i] ? gain[i] : 0.0;
      if (sum > kHundredTimes) parts.push_back({std::move(rows), from, std::move(words), penalty});
    };
    const double cuts = std::log(as_double(n));
    const std::size_t from = tail_of(gain);
    if (is_part(n - from))
      offer([&](std::size_t i) { return i >= from; }, from, "from here on ", cuts);
    if (own.of == Transformation::Of::tail) return parts;
    const std::size_t before = n - tail_of({gain.rbegin(), gain.rend()});
    if (is_part(before))
      offer([&](std::size_t i) { return i < before; }, 0,
            fmt::format("from here to row {} ", name_of_row_(before - 1)), cuts);
    const auto gains_by_it = [&](std::size_t i) { return gain[i] > 0.0; };
    Words names;
    for (const std::size_t i : each_below(n)) {
      if (gains_by_it(i)) names.push_back(name_of_row_(i));
    }
    const std::size_t taken = names.size();
    if (!is_part(taken) || as_double(taken) < kLeastShare * as_double(n)) return parts;
    constexpr std::size_t kMostNamed = 12;
    if (taken > kMostNamed) names.resize(kMostNamed);
    offer(gains_by_it, std::nullopt,
          fmt::format("in {} of {} rows ({}{}) ", taken, n, fmt::join(names, ", "),
                      taken > kMostNamed ? ", ..." : ""),
          cuts + log_choices(n, taken));
    return parts;
  }

  bool is_part(std::size_t taken) const { return taken >= kFewestRows && taken < count(); }

  /// The part's account; also that of the rows selected by its own trend, if they differ.
  void refine(const Transformation& own, const TrendRows& all, Part part, std::vector<RowSet>& seen,
              std::vector<Candidate>& candidates) const {
    constexpr int kMostRounds = 3;
    for (int round = 0; round < kMostRounds; ++round) {
      if (contains(seen, part.rows)) return;
      seen.push_back(part.rows);
      const RobustTrend trend = trend_of(own.mended(part.rows));
      add(own, trend, part, candidates);
      std::vector<Part> next =
          parts_of(own, gains(plain_, all, trend.coefficients, trend.scale_mm));
      auto* alike = find_where(next, [&](const Part& other) {
        return other.from_row.has_value() == part.from_row.has_value() &&
               (other.from_row == 0U) == (part.from_row == 0U);
      });
      if (alike == nullptr) return;
      part = std::move(*alike);
    }
  }

  const VectorXd& sigma_mm_;
  const TrendRows& plain_;
  RobustTrend plain_trend_;
  const std::function<std::string(std::size_t)>& name_of_row_;
};

}  // namespace

Account account_of(const RobustTrend& trend) {
  return {trend.log_likelihood, trend.median_residual_mm(), trend.prior_chi_square};
}

std::vector<Candidate> searched(const VectorXd& prior_sigma_mm, const TrendRows& as_written,
                                const std::vector<Transformation>& transformations,
                                const std::function<std::string(std::size_t)>& name_of_row) {
  std::vector<Candidate> candidates;
  const Search search(prior_sigma_mm, as_written, name_of_row);
  for (const Transformation& own : transformations) search.take(own, candidates);
  return candidates;
}

}  // namespace chaintrue::grid::input_checks
