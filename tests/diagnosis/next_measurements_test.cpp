// SPDX-License-Identifier: GPL-3.0-or-later
// Next measurements: the predicted result of a measurement equals the actual one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/expected_discrimination.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "grid/random.hpp"
#include "interp/linear_algebra.hpp"
#include "tests/diagnosis/sessions.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing_support::analysis_of;

using Alternatives = std::vector<Alternative>;
using Rows = std::vector<Eigen::Index>;

MeasuredHoles holes_with(const model::AppliedEffect& hidden, std::uint64_t seed) {
  synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.seed = seed;
  spec.hidden = {hidden};
  return synthetic::simulate_holes(chaintrue::testing_support::nine_holes(), spec)->set;
}

std::string what_of(const NextMeasurement& next) {
  return next.reading ? std::string(name(*next.reading)) : next.words;
}

/// Not affected by any alternative, nor by any setting.
bool is_silent(const Alternatives& alternatives, const Rows& rows) {
  return std::all_of(alternatives.begin(), alternatives.end(), [&](const Alternative& one) {
    return one.mean(rows).isZero(0.0) && one.covariance(rows, rows).isZero(0.0);
  });
}

/// Applies `law` to the sessions of these seeds that end with a set of causes, until it has had
/// `most` that ask its question.
template <class Session, class Law>
void with_named_sets(std::uint64_t first, std::uint64_t last, int most, const Session& session,
                     const Law& law) {
  int sets = 0;
  for (std::uint64_t seed = first; seed <= last && sets < most; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const Measured measured = session(seed);
    const Analysis a = analysis_of(measured);
    if (a.decision.verdict != Verdict::named_set) continue;
    const NextCandidates next = next_candidates(a);
    const auto alternatives = alternatives_about(a, next.session);
    ASSERT_TRUE(alternatives);
    sets += law(measured, a, next, *alternatives, seed) ? 1 : 0;
  }
  EXPECT_GT(sets, 0) << "no session asks the question";
}

// A chain's weight, a yielding beam or a stretching chain: links and tapes do not depend on them.
TEST(NextMeasurements, AnIndependentReadingChangesNothing) {
  const auto session = [](std::uint64_t seed) {
    return holes_with({"chain_sag", "", {{"relative_weight", 0.2}}}, seed);
  };
  with_named_sets(1, 10, 1, session, [](auto&, auto& a, auto& next, auto& alternatives, auto) {
    std::set<std::string> silent;
    for (const Candidate& candidate : next.all) {
      if (!is_silent(alternatives, candidate.rows)) continue;
      silent.insert(what_of(candidate.measurement));
      Rows with_it = next.all.front().rows;
      const ExpectedDiscrimination without = expected_discrimination(alternatives, with_it);
      with_it.insert(with_it.end(), candidate.rows.begin(), candidate.rows.end());
      const ExpectedDiscrimination with = expected_discrimination(alternatives, with_it);
      // One more row of zeros: the same sums in other blocks.
      EXPECT_NEAR(with.confusion, without.confusion, 1e-12) << what_of(candidate.measurement);
      EXPECT_NEAR(with.named_alone, without.named_alone, 1e-12) << what_of(candidate.measurement);
    }
    for (const NextMeasurement& proposed : next_measurements(a)) {
      EXPECT_EQ(silent.count(what_of(proposed)), 0u) << what_of(proposed);
    }
    return silent.count("tape_error_mm_per_m") > 0;
  });
}

/// Posterior probability of each group from readings at `rows`, with the full densities.
std::vector<double> posterior(const Alternatives& alternatives, const Rows& rows,
                              const Eigen::VectorXd& read) {
  std::vector<double> logs;
  for (const Alternative& one : alternatives) {
    Eigen::MatrixXd covariance = one.covariance(rows, rows);
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

/// How often the correct group is then named alone, by simulated readings.
double drawn_named_alone(const Alternatives& alternatives, const Rows& rows, std::uint64_t seed) {
  Random random(seed, 1);
  constexpr int kDraws = 2000;
  double named = 0.0;
  for (const Alternative& truth : alternatives) {
    const Eigen::MatrixXd spread = linear::covariance_root(truth.covariance(rows, rows));
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

// Both chains long, or the tape long, is one class for distances. A reading that depends on one
// carries no information about the other, whichever of them fits slightly better.
TEST(NextMeasurements, PredictEachCauseOfAClassSeparately) {
  const auto session = [](std::uint64_t seed) {
    return holes_with({"tape_scale", "both", {{"scale", 0.0007}}}, seed);
  };
  with_named_sets(1, 4, 1, session, [](auto&, auto&, auto& next, auto& alternatives, auto seed) {
    Rows all;
    for (const Candidate& candidate : next.all) {
      const std::string what = what_of(candidate.measurement);
      if (what != "tape_error_mm_per_m" && what != "link_pitch_mm") continue;
      all.push_back(candidate.rows.front());
      // Predicted with Gaussian log odds of one rival and a bound of the others, which errs by up to
      // 0.112 on these sets; 2000 draws are accurate to 0.01.
      EXPECT_NEAR(expected_discrimination(alternatives, candidate.rows).named_alone,
                  drawn_named_alone(alternatives, candidate.rows, seed), 0.12)
          << what;
    }
    EXPECT_EQ(all.size(), 4u);
    EXPECT_NEAR(expected_discrimination(alternatives, all).named_alone,
                drawn_named_alone(alternatives, all, seed),
                0.1);  // as above
    return true;
  });
}

/// The measurements, and a candidate with the reading predicted by an alternative.
class WithCandidate {
 public:
  WithCandidate(const Measured& measured, const Analysis& a, const NextCandidates& next)
      : measured_(measured), next_(next), system_(linearise(next.session, a.state).value()) {
    for (const ObservationPart& part : next.session.parts) {
      const Eigen::VectorXd own = part.observation->predicted(a.state.view(part)).value();
      predicted_.conservativeResize(part.first_row + own.size());
      predicted_.tail(own.size()) = own;
    }
  }

  Measured read(const Candidate& candidate, const Alternative& truth) const {
    const NextMeasurement& what = candidate.measurement;
    const Eigen::VectorXd read = readings(candidate.rows, truth);
    // The mix has one file of each kind.
    Measured more;
    for (MeasuredFile file : measured_.files()) {
      if (auto* grid = std::get_if<MeasuredGrid>(&file.measured)) {
        if (what.kind == MeasurementKind::reading) {
          grid->readings.push_back({*what.reading, what.side, read(0), what.sigma});
        } else if (what.kind != MeasurementKind::distance) {
          const auto visit = static_cast<int>(grid->points.size());
          grid->points.push_back(
              {*what.mark, model::ChainLengths{read(0), read(1)}, std::nullopt, visit});
        }
      } else if (what.kind == MeasurementKind::distance) {
        add_distances(what, read, std::get<MeasuredHoles>(file.measured));
      }
      more.add(std::move(file));
    }
    return more;
  }

 private:
  Eigen::VectorXd readings(const Rows& rows, const Alternative& truth) const {
    const int number = system_.unit_of_row[static_cast<std::size_t>(rows.front())];
    if (number < 0) {
      const auto own =
          std::find_if(system_.certain.begin(), system_.certain.end(),
                       [&](const SystemUnit& unit) { return unit.first_row == rows.front(); });
      return predicted_(rows) + own->sigma() * truth.mean(rows);
    }
    Eigen::VectorXd off(static_cast<Eigen::Index>(rows.size()));
    for (Eigen::Index i = 0; i < off.size();) {
      const int unit =
          system_.unit_of_row[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])];
      const SystemUnit& own = system_.units[static_cast<std::size_t>(unit)];
      off.segment(i, own.rows) = own.unwhitened(truth.mean).head(own.rows);
      i += own.rows;
    }
    return predicted_(rows) + off;
  }

  static std::size_t hole_of(const MeasuredHoles& set, const std::string& name) {
    const auto found = std::find_if(set.holes.begin(), set.holes.end(),
                                    [&](const Hole& hole) { return hole.name == name; });
    return static_cast<std::size_t>(found - set.holes.begin());
  }

  static void add_distances(const NextMeasurement& what, const Eigen::VectorXd& read,
                            MeasuredHoles& set) {
    if (what.mark) set.holes.push_back({"new", model::identity_placement(*what.mark)});
    const std::size_t from = hole_of(set, what.mark ? "new" : what.from);
    for (std::size_t k = 0; k < what.to.size(); ++k) {
      HoleDistance distance{.from = from, .to = hole_of(set, what.to[k])};
      distance.distance_mm = read(static_cast<Eigen::Index>(k));
      set.distances.push_back(distance);
    }
  }

  const Measured& measured_;
  const NextCandidates& next_;
  RegressorSystem system_;
  Eigen::VectorXd predicted_;
};

/// The remaining confusion between the groups of single causes that `alternatives` of another
/// analysis contains: the sum over pairs of the square roots of their probabilities.
double confusion_left(const Measured& measured, const Analysis& before,
                      const Alternatives& alternatives) {
  const Analysis a = analysis_of(measured);
  std::vector<double> groups(alternatives.back().group + 1, 0.0);
  double sum = 0.0;
  for (const CandidateModel& model : a.comparison.models) {
    if (model.regressors.size() != 1) continue;
    const CauseId& cause = regressor(a, model.regressors.front()).cause;
    for (const Alternative& one : alternatives) {
      if (!(regressor(before, one.regressors.front()).cause == cause)) continue;
      groups[one.group] += a.comparison.probability(model);
      sum += a.comparison.probability(model);
    }
  }
  double confusion = 0.0;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) confusion += std::sqrt(groups[k] * groups[l]) / sum;
  }
  return confusion;
}

Measured mixed(std::uint64_t seed) {
  const model::AppliedEffect hidden{"beam_flex", "", {{"flexibility_mm_per_n", 0.005}}};
  Measured measured(testing_support::session_of({hidden}, seed, 5, 3));
  synthetic::HolesSpec spec;
  spec.seed = seed + 1000;
  spec.hidden = {hidden};
  measured.add(synthetic::simulate_holes(chaintrue::testing_support::nine_holes(), spec)->set);
  return measured;
}

/// For each kind the candidates with the largest and the smallest expected discrimination; the best
/// of all first.
std::vector<std::size_t> ends_of_kinds(const NextCandidates& next,
                                       const Alternatives& alternatives) {
  std::map<MeasurementKind, std::map<double, std::size_t>> by_kind;
  for (std::size_t c = 0; c < next.all.size(); ++c) {
    by_kind[next.all[c].measurement.kind].emplace(
        expected_discrimination(alternatives, next.all[c].rows).confusion, c);
  }
  std::map<double, std::size_t> ends;
  for (const auto& [kind, candidates] : by_kind) {
    ends.insert(*candidates.begin());
    ends.insert(*candidates.rbegin());
  }
  std::vector<std::size_t> result;
  for (const auto& [confusion, c] : ends) result.push_back(c);
  return result;
}

// For points and distances together, the first of the list lowers the confusion more than the best
// of any other kind, when the reading predicted by each alternative is added to the files and
// everything is estimated again.
TEST(NextMeasurements, ChooseTheMostDecisiveOfAMix) {
  with_named_sets(
      2, 3, 2, mixed, [](auto& measured, auto& a, auto& next, auto& alternatives, auto) {
        if (a.decision.regressors.size() != 1) return false;
        const WithCandidate with(measured, a, next);
        const std::vector<std::size_t> tried = ends_of_kinds(next, alternatives);
        const NextMeasurement chosen = next_measurements(a).front();
        EXPECT_EQ(what_of(chosen), what_of(next.all[tried.front()].measurement));
        std::vector<double> left;
        for (const std::size_t c : tried) {
          left.push_back(0.0);
          for (const Alternative& truth : alternatives) {
            left.back() +=
                truth.probability * confusion_left(with.read(next.all[c], truth), a, alternatives);
          }
          // The reading at its expected value represents the mean over all possible readings.
          const double prediction =
              expected_discrimination(alternatives, next.all[c].rows).confusion;
          EXPECT_NEAR(left.back(), prediction, 0.2 * prediction)
              << what_of(next.all[c].measurement);
        }
        // Equal if two are equally good.
        EXPECT_LE(left.front(), 1.02 * *std::min_element(left.begin(), left.end()))
            << what_of(chosen);
        return true;
      });
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
