// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/pattern_table.hpp"

#include <algorithm>
#include <functional>

namespace chaintrue::sealed {
namespace {

using grid::diagnosis::Verdict;

constexpr double kStrong = 10.0;  // of the figure "of delta 10 and more"
constexpr double kSeen = 8.0;     // of a pattern alone

bool every_cause_strong(const Trial& t) {
  return !t.answer.delta.empty() &&
         *std::min_element(t.answer.delta.begin(), t.answer.delta.end()) >= kStrong;
}

bool named_right(const Trial& t) { return names_outright(t) && all_named(t); }

bool claims_wrongly(const Trial& t) {
  return names_wrongly(t) && t.causes.front().probability >= 0.9;
}

Share share_where(const std::vector<Trial>& trials,
                  const std::function<bool(const Trial&)>& counts,
                  const std::function<bool(const Trial&)>& hit) {
  Share share;
  for (const Trial& t : trials) {
    if (counts(t)) share.count(hit(t));
  }
  return share;
}

}  // namespace

bool tells_pattern(const Trial& trial) { return trial.unknown_probability > 0.5; }

bool names_outright(const Trial& trial) {
  return trial.verdict == Verdict::named || trial.verdict == Verdict::several_causes;
}

bool names_wrongly(const Trial& trial) {
  if (trial.verdict == Verdict::named_set) {
    return std::none_of(trial.hidden.begin(), trial.hidden.end(), [&](const std::string& id) {
      return std::any_of(trial.causes.begin(), trial.causes.end(), [&](const NamedCause& c) {
        return means(c, id);
      });
    });
  }
  return std::any_of(trial.causes.begin(), trial.causes.end(), [&](const NamedCause& c) {
    return std::none_of(trial.hidden.begin(), trial.hidden.end(), [&](const std::string& id) {
      return means(c, id);
    });
  });
}

std::vector<std::pair<std::string, Share>> pattern_rows(const std::vector<Trial>& trials) {
  const auto all = [](const Trial&) { return true; };
  const auto hides = [](const Trial& t) { return !t.hidden.empty(); };
  std::vector<std::pair<std::string, Share>> rows;
  rows.emplace_back("every cause named", share_where(trials, hides, named_right));
  rows.emplace_back("... of delta 10 and more",
                    share_where(trials, every_cause_strong, named_right));
  rows.emplace_back("pattern told", share_where(trials, all, tells_pattern));
  for (const int points : {28, 60, 117, 200, 465}) {
    rows.emplace_back("... of delta 8 and more, " + std::to_string(points) + " points",
                      share_where(
                          trials,
                          [&](const Trial& t) {
                            return t.points == points && t.answer.pattern &&
                                   t.answer.pattern->delta >= kSeen;
                          },
                          tells_pattern));
  }
  rows.emplace_back("both", share_where(trials, hides, [](const Trial& t) {
                      return named_right(t) && tells_pattern(t);
                    }));
  rows.emplace_back("a wrong name", share_where(trials, all, names_wrongly));
  rows.emplace_back("... claimed with 90 % or more", share_where(trials, all, claims_wrongly));
  return rows;
}

}  // namespace chaintrue::sealed
