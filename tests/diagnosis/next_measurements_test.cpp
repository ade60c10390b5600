// SPDX-License-Identifier: GPL-3.0-or-later
// What to measure next: what is foretold is what the readings would bring.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "grid/diagnosis/next_candidates.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "grid/diagnosis/outlook.hpp"
#include "grid/synthetic/random.hpp"
#include "tests/diagnosis/sessions.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Rows = std::vector<Eigen::Index>;

Analysis analysis_of(const Measured& measured) {
  return analyse(make_session(measured).value(), testing_support::verdict_alone()).value();
}

MeasuredHoles holes_with(const model::AppliedEffect& hidden, std::uint64_t seed) {
  synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.seed = seed;
  spec.hidden = {hidden};
  return synthetic::simulate_holes(chaintrue::testing_support::nine_holes(), spec)->set;
}

/// What no alternative moves, and no setting.
bool is_silent(const std::vector<Alternative>& alternatives, const Rows& rows) {
  return std::all_of(alternatives.begin(), alternatives.end(), [&](const Alternative& one) {
    return one.mean(rows).isZero(0.0) && one.spread(rows, Eigen::all).isZero(0.0);
  });
}

// A chain's weight, a beam that gives or a chain that gives: no link and no tape has a part in it.
TEST(NextMeasurements, AReadingThatNoContestedCauseTouchesChangesNothing) {
  int sets = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const Analysis a = analysis_of(holes_with({"chain_sag", "", {{"relative_weight", 0.2}}}, seed));
    if (a.decision.verdict != Verdict::named_set) continue;
    const NextCandidates next = next_candidates(a);
    const auto alternatives = alternatives_about(a, next.session);
    ASSERT_TRUE(alternatives);
    std::set<std::string> silent;
    for (const Candidate& candidate : next.all) {
      if (!is_silent(*alternatives, candidate.rows)) continue;
      silent.insert(candidate.measurement.what);
      Rows with_it = next.all.front().rows;
      const Outlook without = outlook(*alternatives, with_it);
      with_it.insert(with_it.end(), candidate.rows.begin(), candidate.rows.end());
      const Outlook with = outlook(*alternatives, with_it);
      // A row of zeros more: the same sums in other blocks.
      EXPECT_NEAR(with.confusion, without.confusion, 1e-12) << candidate.measurement.what;
      EXPECT_NEAR(with.named_alone, without.named_alone, 1e-12) << candidate.measurement.what;
    }
    for (const NextMeasurement& proposed : next_measurements(a)) {
      EXPECT_EQ(silent.count(proposed.what), 0u) << proposed.what;
    }
    if (silent.count("tape_error_mm_per_m") > 0) ++sets;
  }
  EXPECT_GT(sets, 0) << "no session asks the question";
}

/// Posterior probability of each group from readings at `rows`, by the whole densities.
std::vector<double> posterior(const std::vector<Alternative>& alternatives,
                              const Rows& rows,
                              const Eigen::VectorXd& read) {
  std::vector<double> logs;
  for (const Alternative& one : alternatives) {
    const Eigen::MatrixXd spread = one.spread(rows, Eigen::all);
    Eigen::MatrixXd covariance = spread * spread.transpose();
    covariance.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    const Eigen::VectorXd off = read - one.mean(rows);
    double log = std::log(one.probability) - 0.5 * off.dot(llt.solve(off));
    for (Eigen::Index i = 0; i < off.size(); ++i) log -= std::log(llt.matrixLLT()(i, i));
    logs.push_back(log);
  }
  const double highest = *std::max_element(logs.begin(), logs.end());
  std::vector<double> groups(alternatives.back().group + 1, 0.0);
  double sum = 0.0;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const double weight = std::exp(logs[k] - highest);
    groups[alternatives[k].group] += weight;
    sum += weight;
  }
  for (double& group : groups) group /= sum;
  return groups;
}

/// How often the right group is then named alone, by drawing the readings.
double drawn_named_alone(const std::vector<Alternative>& alternatives,
                         const Rows& rows,
                         std::uint64_t seed) {
  synthetic::Random random(seed, 1);
  constexpr int kDraws = 2000;
  double named = 0.0;
  for (const Alternative& truth : alternatives) {
    const Eigen::MatrixXd spread = truth.spread(rows, Eigen::all);
    int right = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      Eigen::VectorXd read = truth.mean(rows);
      for (Eigen::Index i = 0; i < read.size(); ++i) read(i) += random.normal();
      for (Eigen::Index j = 0; j < spread.cols(); ++j) read += spread.col(j) * random.normal();
      right += posterior(alternatives, rows, read)[truth.group] >= kNamedAlone ? 1 : 0;
    }
    named += truth.probability * right / kDraws;
  }
  return named;
}

// Both chains long or the tape long is one class to distances. A reading of the one says nothing of
// the other, whichever of them fits a little better.
TEST(NextMeasurements, OfAClassEachCauseIsForetoldByItself) {
  int sets = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const Analysis a = analysis_of(holes_with({"tape_scale", "both", {{"scale", 0.0007}}}, seed));
    if (a.decision.verdict != Verdict::named_set) continue;
    ++sets;
    const NextCandidates next = next_candidates(a);
    const auto alternatives = alternatives_about(a, next.session);
    ASSERT_TRUE(alternatives);
    Rows all;
    for (const Candidate& candidate : next.all) {
      const std::string& what = candidate.measurement.what;
      if (what != "tape_error_mm_per_m" && what != "link_pitch_mm") continue;
      all.push_back(candidate.rows.front());
      // Foretold with Gaussian log odds and rivals by themselves; 2000 draws are good to 0.01.
      EXPECT_NEAR(outlook(*alternatives, candidate.rows).named_alone,
                  drawn_named_alone(*alternatives, candidate.rows, seed),
                  0.1)
          << what;
    }
    ASSERT_EQ(all.size(), 4u);
    EXPECT_NEAR(outlook(*alternatives, all).named_alone,
                drawn_named_alone(*alternatives, all, seed),
                0.1);  // as above
  }
  EXPECT_GT(sets, 0) << "no session asks the question";
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
