// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace chaintrue::planted {

bool same_class(std::string_view one, std::string_view other) {
  if (one == other) return true;
  using Two = std::array<std::string_view, 2>;
  constexpr std::array<Two, 3> kClasses = {Two{"chain_pitch_error:both", "tape_scale:both"},
                                           Two{"tooth_skip:left", "zero_shift:left"},
                                           Two{"tooth_skip:right", "zero_shift:right"}};
  return std::any_of(kClasses.begin(), kClasses.end(), [&](const Two& members) {
    const auto has = [&](std::string_view id) { return id == members[0] || id == members[1]; };
    return has(one) && has(other);
  });
}

void Method::add(const Scores& scores,
                 const std::vector<std::string>& hidden_here,
                 const std::vector<std::string>& no_matter) {
  ++sets;
  hidden += static_cast<int>(hidden_here.size());
  const auto is_one_of = [](const std::vector<std::string>& ids, const std::string& id) {
    return std::any_of(
        ids.begin(), ids.end(), [&](const std::string& other) { return same_class(id, other); });
  };
  for (const std::string& own : hidden_here) {
    double best = 0.0;
    bool named = false;
    for (const auto& [id, score] : scores) {
      if (!same_class(id, own)) continue;
      best = named ? std::max(best, score) : score;
      named = true;
    }
    if (named) names.push_back({best, true});
  }
  for (const auto& [id, score] : scores) {
    if (!is_one_of(hidden_here, id) && !is_one_of(no_matter, id)) names.push_back({score, false});
  }
}

CurvePoint at_threshold(const Method& method, double threshold) {
  CurvePoint point;
  for (const ScoredName& name : method.names) {
    if (name.score < threshold) continue;
    ++(name.right ? point.right : point.wrong);
  }
  return point;
}

CurvePoint at_most_wrong(const Method& method, int wrong) {
  std::vector<ScoredName> ranked = method.names;
  std::sort(
      ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  CurvePoint here, best;
  for (std::size_t k = 0; k < ranked.size(); ++k) {
    ++(ranked[k].right ? here.right : here.wrong);
    if (here.wrong > wrong) break;
    // Names of one score come together.
    const bool last_of_score = k + 1 == ranked.size() || ranked[k + 1].score < ranked[k].score;
    if (last_of_score) best = here;
  }
  return best;
}

std::string curves_table(const std::vector<Method>& methods) {
  constexpr std::array kWrongInAHundred = {1, 2, 5, 10, 20, 50};
  std::string text = "| right names, %, with so many false ones in 100 sets |";
  for (const int wrong : kWrongInAHundred) text += fmt::format(" {} |", wrong);
  text += " usual threshold | right, % | false in 100 sets |\n|---|";
  for (std::size_t k = 0; k < kWrongInAHundred.size() + 3; ++k) text += "---|";
  text += "\n";
  for (const Method& method : methods) {
    if (method.sets == 0 || method.hidden == 0) continue;
    const auto share = [&](int right) { return 100.0 * right / method.hidden; };
    text += "| " + method.name + " |";
    for (const int wrong : kWrongInAHundred) {
      text +=
          fmt::format(" {:.0f} |", share(at_most_wrong(method, wrong * method.sets / 100).right));
    }
    const CurvePoint usual = at_threshold(method, method.usual);
    text += fmt::format(" {:g} | {:.0f} | {:.0f} |\n",
                        method.usual,
                        share(usual.right),
                        100.0 * usual.wrong / method.sets);
  }
  return text;
}

}  // namespace chaintrue::planted
