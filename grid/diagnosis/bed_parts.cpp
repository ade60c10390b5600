// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/bed_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "grid/diagnosis/downdating.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "grid/parallel.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kCutDirections = 16;
constexpr double kShareLeftOut = 0.25;
/// Places are on a line if their scatter across the best line is less than this share of that along it.
constexpr double kOnALine = 1e-3;
/// Enough models for 99 % of the probability with 60 marks of a real scan, whose pattern dozens of
/// neighbouring discrepancies share.
constexpr FollowedModels kFollowed{
    .within = 16.0, .most = 1000, .discrepancy_share = 0.002, .most_discrepancies = 30};
/// The cost of a discrepancy grows with the cube of the rows. With more rows than this, the
/// likeliest discrepancies represent the rest.
constexpr Index kRowsForAllDiscrepancies = 500;
constexpr std::size_t kDiscrepanciesOfMany = 6;

FollowedModels followed_of(const RegressorSystem& system) {
  FollowedModels result = kFollowed;
  if (system.e.size() > kRowsForAllDiscrepancies) result.most_discrepancies = kDiscrepanciesOfMany;
  return result;
}

struct UnitPlace {
  std::size_t unit = 0;
  Vector2d at;
};

std::vector<UnitPlace> places_of_units(const RegressorSystem& system) {
  std::vector<UnitPlace> result;
  for (const auto u : each_index(system.units)) {
    const auto& places = system.units[u].places;
    if (places.empty()) continue;
    Vector2d sum = Vector2d::Zero();
    for (const PlaceColumns& own : places) sum += vector_of(system.places[own.place].mark);
    result.push_back({u, sum / as_double(places.size())});
  }
  return result;
}

bool lie_on_a_line(const std::vector<UnitPlace>& places) {
  Vector2d mean = Vector2d::Zero();
  for (const UnitPlace& own : places) mean += own.at / as_double(places.size());
  Matrix2d scatter = Matrix2d::Zero();
  for (const UnitPlace& own : places) scatter += (own.at - mean) * (own.at - mean).transpose();
  const VectorXd squares = linear::SymmetricEigen(scatter).eigenvalues();
  return squares(0) <= kOnALine * kOnALine * squares(1);
}

/// `probability` of each model of the comparison.
PartPosterior summary(const RegressorSystem& system, const ModelComparison& comparison,
                      const VectorXd& probability, BedPart part) {
  PartPosterior result{std::move(part)};
  for (const auto k : each_index(comparison.models)) {
    const RegressorSet& regressors = comparison.models[k].regressors;
    const double p = probability(as_index(k));
    if (!regressors.empty()) result.caused += p;
    for (const int regressor : regressors) {
      const CauseId& cause = system.regressor(regressor).cause;
      auto* known = find_where(result.causes, [&](const auto& own) { return own.first == cause; });
      auto& own = known != nullptr ? *known : result.causes.emplace_back(cause, 0.0);
      own.second += p;
    }
  }
  result.caused = std::min(result.caused, 1.0);
  return result;
}

/// Shares out the total weight of models with a pattern in proportion to these weights; those
/// without keep theirs.
void redistribute(const VectorXd& weights, double together, ModelComparison& comparison) {
  // Floor for a model that no part supports, so that its logarithm is finite.
  constexpr double kNothing = 1e-300;
  double all = kNothing;
  for (const auto k : each_index(comparison.models)) {
    if (comparison.models[k].discrepancy >= 0) all += weights(as_index(k));
  }
  for (const auto k : each_index(comparison.models)) {
    CandidateModel& model = comparison.models[k];
    const double p = model.discrepancy >= 0 ? weights(as_index(k)) / all * together
                                            : comparison.probability(model);
    model.log_weight = std::log(std::max(p, kNothing));
  }
  sort_by_weight(comparison);
}

}  // namespace

std::vector<BedPart> bed_parts(const RegressorSystem& system, std::size_t fewest) {
  std::vector<UnitPlace> places = places_of_units(system);
  const auto out = static_cast<std::size_t>(kShareLeftOut * as_double(places.size()));
  std::vector<BedPart> parts;
  for (int k = 0; k < kCutDirections && out > 0; ++k) {
    // Half a step from the axes, so that no line runs along the columns of a lattice.
    const double towards = (k + 0.5) * 2.0 * std::numbers::pi / kCutDirections;
    const Vector2d direction(std::cos(towards), std::sin(towards));
    const auto along = [&](const UnitPlace& own) { return direction.dot(own.at); };
    stable_sort(places, descending(along));
    // Readings of one mark stay together.
    constexpr double kOneMarkMm = 1e-6;
    const double last = along(places[out - 1]) - kOneMarkMm;
    const auto rest = std::find_if(places.begin(), places.end(),
                                   [&](const UnitPlace& own) { return along(own) < last; });
    BedPart part{towards, {}};
    for (auto own = places.begin(); own != rest; ++own) part.units.push_back(own->unit);
    const std::size_t left = places.size() - part.units.size();
    if (left >= std::max<std::size_t>(fewest, 3) && !lie_on_a_line({rest, places.end()}))
      parts.push_back(std::move(part));
  }
  if (2 * parts.size() < as_size(kCutDirections)) parts.clear();
  return parts;
}

std::vector<PartPosterior> average_over_parts(const RegressorSystem& system, std::size_t fewest,
                                              ModelComparison& comparison) {
  std::vector<PartPosterior> result;
  double pattern = 0.0;
  for (const CandidateModel& model : comparison.models) {
    if (model.discrepancy >= 0) pattern += comparison.probability(model);
  }
  if (pattern <= kDiscrepancyLikely) return result;
  std::vector<BedPart> parts = bed_parts(system, fewest);
  if (parts.empty()) return result;
  const Downdating downdating(system, comparison, followed_of(system));
  std::vector<VectorXd> of_part(parts.size());
  for_each_index(parts.size(), [&](std::size_t p) {
    of_part[p] = downdating.probabilities_without(parts[p].units, CountAs::all);
  });
  VectorXd weights = VectorXd::Zero(std::ssize(comparison.models));
  for (const auto p : each_index(parts)) {
    weights += of_part[p];
    result.push_back(summary(system, comparison, of_part[p], std::move(parts[p])));
  }
  redistribute(weights, pattern, comparison);
  return result;
}

std::vector<PartPosterior> session_posteriors(const RegressorSystem& system, std::size_t fewest,
                                              const ModelComparison& comparison) {
  std::vector<PartPosterior> result;
  std::size_t sessions = 0;
  for (const SystemUnit& unit : system.units) sessions = std::max(sessions, unit.observation + 1);
  if (sessions < 2) return result;
  const Downdating downdating(system, comparison, followed_of(system));
  for (std::size_t session = 0; session < sessions; ++session) {
    BedPart others;
    for (const auto u : each_index(system.units)) {
      if (system.units[u].observation != session) others.units.push_back(u);
    }
    if (system.units.size() - others.units.size() < std::max<std::size_t>(fewest, 1)) continue;
    const VectorXd own = downdating.probabilities_without(others.units, CountAs::themselves);
    result.push_back(summary(system, comparison, own, std::move(others)));
    result.back().session = session;
  }
  if (result.size() < 2) result.clear();
  return result;
}

namespace {

/// A cause holds in a part if it is more likely than not; in a session if it would be named.
constexpr double kHolds = 0.5;
constexpr double kHoldsInSession = 0.9;

double probability_of_class(const PartPosterior& part, const CauseClass& members) {
  double sum = 0.0;
  for (const auto& [cause, p] : part.causes) {
    if (contains(members, cause)) sum += p;
  }
  return std::min(sum, 1.0);
}

PartFinding finding_of(const Analysis& a, const PartPosterior& part) {
  PartFinding result;
  result.towards_rad = part.left_out.towards_rad;
  result.units = part.left_out.units.size();
  result.likeliest = {"nothing", "", 1.0 - part.caused};
  double most = kHolds;
  for (const CauseClass& members : a.decision.classes) {
    const double p = probability_of_class(part, members);
    if (p > most) {
      most = p;
      result.likeliest = hypothesis_of(members, p);
    }
  }
  for (const std::size_t index : a.decision.listed) {
    const CauseClass& members = a.decision.classes[index];
    result.named.push_back(hypothesis_of(members, probability_of_class(part, members)));
  }
  return result;
}

std::string_view quarter(double towards_rad) {
  constexpr std::array<std::string_view, 8> kNames = {
      "right", "upper right", "top", "upper left", "left", "lower left", "bottom", "lower right"};
  const long eighth = std::lround(towards_rad / (0.25 * std::numbers::pi));
  return kNames[as_size(eighth) % kNames.size()];
}

/// Name of a hypothesis in sentences.
std::string cause_words(const Hypothesis& one) {
  return one.causes.empty() ? one.effect : fmt::format("\"{}\"", sized(one.causes.front(), {}));
}

bool is_named(const PartFinding& part, const Hypothesis& one) {
  return any_of(part.named, [&](const Hypothesis& own) {
    return own.effect == one.effect && own.side == one.side;
  });
}

/// A named cause does not hold there; for a set, none of its causes does.
bool denies(const Diagnosis& d, const PartFinding& part) {
  const auto holds = [](const Hypothesis& own) { return own.probability >= kHolds; };
  if (d.verdict == Verdict::named_set) {
    double sum = 0.0;
    for (const Hypothesis& own : part.named) sum += own.probability;
    return sum < kHolds;
  }
  return !all_of(part.named, holds);
}

/// One answer shared by several quarters.
struct OtherAnswer {
  std::string words;
  double least = 1.0;
  double most = 0.0;
  std::vector<std::string_view> quarters{};
};

/// The change without a quarter, and its probability: another cause is the likeliest, or a named one is
/// no longer likely. \pre the part denies what is named.
std::pair<std::string, double> answer_without(const PartFinding& part) {
  const auto lost = min_element(part.named, ascending(&Hypothesis::probability));
  const Hypothesis& best = part.likeliest;
  if (best.effect == "nothing") return {"no cause is more likely than not", best.probability};
  if (!is_named(part, best) || lost->probability >= kHolds)
    return {fmt::format("it is {}", cause_words(best)), best.probability};
  return {fmt::format("{} is not likely", cause_words(*lost)), lost->probability};
}

std::string words_of_quarters(const Diagnosis& d) {
  std::vector<OtherAnswer> answers;
  for (const PartFinding& part : d.bed_parts) {
    if (!denies(d, part)) continue;
    const auto own = answer_without(part);
    auto* same = find_where(answers, having(&OtherAnswer::words, own.first));
    OtherAnswer& answer = same != nullptr ? *same : answers.emplace_back(OtherAnswer{own.first});
    answer.least = std::min(answer.least, own.second);
    answer.most = std::max(answer.most, own.second);
    const std::string_view where = quarter(part.towards_rad);
    if (!contains(answer.quarters, where)) answer.quarters.push_back(where);
  }
  std::vector<std::string> sentences;
  for (const OtherAnswer& answer : answers) {
    const std::string least = percent(answer.least);
    const std::string most = percent(answer.most);
    sentences.push_back(fmt::format("Without the {} quarter of the bed {} ({}).",
                                    fmt::join(answer.quarters, " or the "), answer.words,
                                    least == most ? least : fmt::format("{} to {}", least, most)));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

/// Causes that only some sessions support alone.
std::vector<std::string> words_of_sessions(const Diagnosis& d) {
  std::vector<std::string> result;
  if (d.sessions.empty()) return result;
  for (const auto k : each_index(d.sessions.front().named)) {
    std::vector<std::string> with, without;
    for (const PartFinding& session : d.sessions) {
      const Hypothesis& own = session.named[k];
      std::string words = fmt::format("{} ({})", session.session, percent(own.probability));
      if (own.probability >= kHoldsInSession)
        with.push_back(std::move(words));
      else if (own.probability <= 1.0 - kHoldsInSession)
        without.push_back(std::move(words));
    }
    const Hypothesis& named = d.sessions.front().named[k];
    const std::string cause = cause_words(named);
    if (with.size() == d.sessions.size()) {
      result.push_back(fmt::format("Each session alone shows {}.", cause));
    } else if (!with.empty() && !without.empty()) {
      result.push_back(fmt::format("The sessions contradict each other: {} is in {}, not in {}.",
                                   cause, fmt::join(with, " and "), fmt::join(without, " and ")));
    }
  }
  return result;
}

}  // namespace

std::vector<PartFinding> bed_part_findings(const Analysis& a) {
  std::vector<PartFinding> result;
  if (a.decision.discrepancy <= kDiscrepancyLikely) return result;
  for (const PartPosterior& part : a.parts) result.push_back(finding_of(a, part));
  return result;
}

std::vector<PartFinding> session_findings(const Analysis& a,
                                          const std::vector<std::string>& names) {
  std::vector<PartFinding> result;
  if (a.decision.listed.empty()) return result;
  for (const PartPosterior& own : a.sessions) {
    if (own.session >= names.size()) continue;  // direct readings that came with a file
    PartFinding one = finding_of(a, own);
    one.session = names[own.session];
    one.units = a.system.units.size() - one.units;
    result.push_back(std::move(one));
  }
  if (result.size() < 2) result.clear();
  return result;
}

std::vector<std::string> parts_in_words(const Diagnosis& d) {
  std::vector<std::string> result = words_of_sessions(d);
  if (std::string quarters = words_of_quarters(d); !quarters.empty())
    result.insert(result.begin(), std::move(quarters));
  return result;
}

}  // namespace chaintrue::grid::diagnosis
