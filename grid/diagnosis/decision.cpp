// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/decision.hpp"

#include <algorithm>
#include <map>

#include "grid/diagnosis/estimate.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Key = Indices;  ///< classes that act, ascending

struct Grouped {
  double probability = 0.0;
  double discrepancy = 0.0;
  const CandidateModel* best = nullptr;  ///< without a discrepancy, if there is one
  const CandidateModel* with_discrepancy = nullptr;
};

class Decider {
 public:
  Decider(const RegressorSystem& system, const ModelComparison& comparison, const Flags& excluded,
          std::vector<CauseClass> classes)
      : system_(system), comparison_(comparison), excluded_(excluded) {
    result_.classes = std::move(classes);
  }

  Decision run(bool detected) {
    group();
    marginals();
    // A pattern exceeds noise on its own and can pass a test against noise alone.
    const bool beyond_noise = detected || result_.discrepancy > kDiscrepancyLikely;
    if (beyond_noise && result_.caused > kCaused) {
      name_best();
    } else {
      abstain();
    }
    add_all_sure();
    return std::move(result_);
  }

 private:
  void group() {
    for (const CandidateModel& model : comparison_.models) {
      const double p = comparison_.probability(model);
      Key key;
      for (const int k : model.regressors) {
        key.push_back(result_.class_of(system_.regressor(k).cause));
      }
      sort(key);
      Grouped& one = groups_[key];
      one.probability += p;
      if (model.discrepancy >= 0) {
        one.discrepancy += p;
        result_.discrepancy += p;
        if (one.with_discrepancy == nullptr) one.with_discrepancy = &model;
      } else if (one.best == nullptr) {
        one.best = &model;
      }
      if (key.empty()) {
        share_abstention(model, p);
      } else {
        result_.caused += p;
      }
    }
    // Rounding of thousands of addends.
    for (double* const sum : {&result_.caused, &result_.discrepancy, &result_.discrepancy_alone,
                              &result_.outliers, &result_.noise, &result_.nothing}) {
      *sum = std::min(*sum, 1.0);
    }
  }

  void share_abstention(const CandidateModel& model, double p) {
    const bool with_outliers =
        comparison_.marginalised_systems[model.marginalised].outliers != excluded_;
    if (model.discrepancy >= 0) {
      result_.discrepancy_alone += p;
    } else if (with_outliers) {
      result_.outliers += p;
    } else {
      result_.noise += p * model.larger_noise;
      result_.nothing += p * (1.0 - model.larger_noise);
    }
  }

  void marginals() {
    std::vector<double> p(result_.classes.size(), 0.0);
    for (const auto& [key, grouped] : groups_) {
      for (const std::size_t k : key) {
        if (k < p.size()) p[k] += grouped.probability;
      }
    }
    for (const auto k : each_index(p)) result_.marginal.push_back({k, std::min(p[k], 1.0)});
    stable_sort(result_.marginal, descending(&ClassProbability::probability));
  }

  /// The number of causes is decided first, then which.
  const Grouped* best_group() {
    std::map<std::size_t, double> by_count;
    for (const auto& [key, grouped] : groups_) by_count[key.size()] += grouped.probability;
    std::size_t count = 1;
    for (const auto& [n, p] : by_count) {
      if (n > 0 && p > by_count[count]) count = n;
    }
    const Grouped* best = nullptr;
    for (const auto& [key, grouped] : groups_) {
      if (key.size() != count) continue;
      if (best == nullptr || grouped.probability > best->probability) {
        best = &grouped;
        best_key_ = key;
      }
    }
    return best;
  }

  void take(const Grouped& grouped) {
    const CandidateModel* given = grouped.with_discrepancy;
    result_.discrepancy_left = grouped.discrepancy > 0.5 * grouped.probability;
    const CandidateModel& model =
        result_.discrepancy_left || grouped.best == nullptr ? *given : *grouped.best;
    result_.regressors = model.regressors;
    result_.marginalised = model.marginalised;
    if (given != nullptr) result_.best_discrepancy = given->discrepancy;
  }

  /// For several causes those more likely than not are reported; a partner that could be any of many
  /// is dropped.
  const Grouped* without_doubtful(const Grouped* best_model) {
    if (best_key_.size() < 2) return best_model;
    Key sure;
    for (const std::size_t k : best_key_) {
      const bool given_discrepancy = result_.discrepancy > kDiscrepancyLikely;
      if (result_.probability_of(k) >=
          (given_discrepancy ? kNamedGivenDiscrepancy : kLikelierThanNot))
        sure.push_back(k);
    }
    const auto found = groups_.find(sure);
    if (sure.empty() || found == groups_.end()) return best_model;
    best_key_ = sure;
    return &found->second;
  }

  void name_best() {
    const Grouped* best_model = without_doubtful(best_group());
    if (best_model == nullptr) {
      abstain();
      return;
    }
    // With an unlisted pattern a set is reported only if one of its members surely acts.
    if (result_.discrepancy > kDiscrepancyLikely &&
        result_.marginal.front().probability < enough_to_name() && result_.caused < kSetHolds) {
      abstain();
      return;
    }
    name_causes(*best_model);
  }

  /// A pattern lowers a cause's probability, but does not keep it from being named.
  double enough_to_name() const {
    return result_.discrepancy > kDiscrepancyLikely ? kNamedGivenDiscrepancy : kNamedAlone;
  }

  /// A hypothesis that is nearly certain is always among the causes.
  void add_all_sure() {
    Key sure;
    for (const ClassProbability& one : result_.marginal) {
      if (one.probability >= kSure) sure.push_back(one.index);
    }
    const auto& listed = result_.listed;
    const bool missing = any_of(sure, [&](std::size_t k) { return !contains(listed, k); });
    if (!missing) return;
    if (result_.verdict == Verdict::named || result_.verdict == Verdict::several_causes) {
      for (const std::size_t k : listed) {
        if (!contains(sure, k)) sure.push_back(k);
      }
    }
    sort(sure);
    const Grouped* home = likeliest_with(sure);
    if (home == nullptr) return;
    best_key_ = sure;
    result_.listed.clear();
    name_causes(*home);
    keep_only(sure);
  }

  /// The most probable group in which all of these act; empty if none does. `causes` ascending.
  const Grouped* likeliest_with(const Key& causes) const {
    const Grouped* best = nullptr;
    for (const auto& [key, grouped] : groups_) {
      const bool holds = std::includes(key.begin(), key.end(), causes.begin(), causes.end());
      if (holds && (best == nullptr || grouped.probability > best->probability)) best = &grouped;
    }
    return best;
  }

  /// Keeps only these classes' causes in the model.
  void keep_only(const Key& causes) {
    std::erase_if(result_.regressors, [&](int k) {
      return !contains(causes, result_.class_of(system_.regressor(k).cause));
    });
  }

  void name_causes(const Grouped& best_model) {
    if (best_key_.size() > 1) {
      result_.verdict = Verdict::several_causes;
      result_.listed = best_key_;
      stable_sort(result_.listed,
                  descending([&](std::size_t index) { return result_.probability_of(index); }));
      take(best_model);
      return;
    }
    const ClassProbability& top = result_.marginal.front();
    if (top.probability >= enough_to_name()) {
      // Over all groups another cause may be likelier than that of the leading group: fit what is
      // named.
      const Key named = {top.index};
      const auto alone = groups_.find(named);
      const Grouped* own = best_key_ == named       ? &best_model
                           : alone != groups_.end() ? &alone->second
                                                    : likeliest_with(named);
      take(*own);
      keep_only(named);
      best_key_ = named;
      result_.verdict = Verdict::named;
      result_.listed = named;
      return;
    }
    take(best_model);
    result_.verdict = Verdict::named_set;
    // Which cause, given that exactly one acts.
    std::vector<ClassProbability> alone;
    double all = 0.0;
    for (const auto& [key, grouped] : groups_) {
      if (key.size() != 1) continue;
      alone.push_back({key.front(), grouped.probability});
      all += grouped.probability;
    }
    stable_sort(alone, descending(&ClassProbability::probability));
    double sum = 0.0;
    for (const ClassProbability& one : alone) {
      result_.listed.push_back(one.index);
      sum += one.probability;
      if (sum >= kSetHolds * all) break;
    }
    if (result_.listed.size() == 1) result_.verdict = Verdict::named;
  }

  void abstain() {
    const auto found = groups_.find({});
    if (found != groups_.end()) {
      take(found->second);
      result_.discrepancy_left = false;
    }
    const double most =
        std::max({result_.nothing, result_.noise, result_.outliers, result_.discrepancy_alone});
    if (result_.discrepancy > 0.5 || result_.discrepancy_alone == most) {
      result_.verdict = Verdict::model_discrepancy;
      result_.discrepancy_left = true;
    } else if (result_.outliers == most) {
      result_.verdict = Verdict::outliers;
    } else if (result_.noise == most) {
      result_.verdict = Verdict::noise_larger_than_stated;
    } else {
      result_.verdict = Verdict::nothing_found;
    }
  }

  const RegressorSystem& system_;
  const ModelComparison& comparison_;
  const Flags& excluded_;
  std::map<Key, Grouped> groups_;
  Key best_key_;
  Decision result_;
};

}  // namespace

Decision decide(const RegressorSystem& system, const ModelComparison& comparison,
                const Flags& excluded, bool detected, std::vector<CauseClass> classes) {
  return Decider(system, comparison, excluded, std::move(classes)).run(detected);
}

namespace {

/// The likeliest pattern without any cause; false if none was compared.
bool take_pattern_alone(const ModelComparison& comparison, Decision& decision) {
  auto* alone = find_where(comparison.models, [](const CandidateModel& model) {
    return model.discrepancy >= 0 && model.regressors.empty();
  });
  if (alone == nullptr) return false;
  decision.best_discrepancy = alone->discrepancy;
  decision.marginalised = alone->marginalised;
  decision.discrepancy_left = true;
  return true;
}

}  // namespace

std::vector<CauseId> Decision::leaders() const {
  return mapped(listed, [&](std::size_t index) { return classes[index].front(); });
}

std::size_t Decision::class_of(const CauseId& cause) const {
  const auto* home =
      find_where(classes, [&](const CauseClass& members) { return contains(members, cause); });
  return home != nullptr ? as_size(home - classes.data()) : classes.size();
}

double Decision::probability_of(std::size_t index) const {
  const auto* one = find_where(marginal, having(&ClassProbability::index, index));
  return one != nullptr ? one->probability : 0.0;
}

void withdraw_names(const ModelComparison& comparison, Decision& decision) {
  if (decision.listed.empty() && decision.regressors.empty()) return;
  decision.listed.clear();
  decision.regressors.clear();
  decision.discrepancy_left = false;
  decision.verdict =
      decision.discrepancy > kDiscrepancyLikely && take_pattern_alone(comparison, decision)
          ? Verdict::model_discrepancy
          : Verdict::nothing_found;
}

}  // namespace chaintrue::grid::diagnosis
