// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
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
    auto* same =
        find_where(answers, [&](const OtherAnswer& other) { return other.words == own.first; });
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
  for (std::size_t k = 0; k < d.sessions.front().named.size(); ++k) {
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
