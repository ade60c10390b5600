// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include "sealed/judge/binomial.hpp"
#include "sealed/judge/pattern_table.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Mix;
using grid::diagnosis::Verdict;

/// Two columns, one row for each figure.
class Rows {
 public:
  void add(const std::string& what, const std::string& value) {
    fmt::format_to(std::back_inserter(text_), "| {} | {} |\n", what, value);
  }
  void add(const std::string& what, const Share& share) {
    if (share.of > 0) add(what, text(share));
  }
  [[nodiscard]] const std::string& str() const { return text_; }

 private:
  std::string text_;
};

Share share_of(const std::vector<Trial>& trials, const std::function<bool(const Trial&)>& hit) {
  Share share;
  for (const Trial& t : trials) share.count(hit(t));
  return share;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto i = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  return values[std::min(values.size() - 1, i == 0 ? 0 : i - 1)];
}

bool detected(const Trial& t) { return t.family_wise_p < 0.01; }

void bins_of_delta(const std::vector<Trial>& trials, Rows& rows) {
  struct Bin {
    double from, to;
    const char* text;
  };
  constexpr Bin kBins[] = {
      {6.0, 8.0, "delta 6-8"}, {8.0, 12.0, "delta 8-12"}, {12.0, 1e9, "above 12"}};
  for (const Bin& bin : kBins) {
    Share right, set, separable, alone;
    double members = 0.0;
    for (const Trial& t : trials) {
      if (t.answer.delta.empty()) continue;
      const double delta = t.answer.delta.front();
      if (delta < bin.from || delta >= bin.to) continue;
      right.count(leads_right(t));
      set.count(in_set(t));
      if (t.answer.separable) separable.count(leads_right(t));
      if (names_something(t)) {
        members += static_cast<double>(t.causes.size());
        alone.count(t.causes.size() == 1);
      }
    }
    if (right.of == 0) continue;
    rows.add(fmt::format("exact name, {}", bin.text), right);
    rows.add(fmt::format("... of causes separable at their strength, {}", bin.text), separable);
    rows.add(fmt::format("in the named set, {}", bin.text), set);
    if (alone.of > 0) {
      rows.add(fmt::format("mean size of the set, {}", bin.text),
               fmt::format("{:.2f}", members / alone.of));
    }
  }
}

void about_one(const std::vector<Trial>& trials, Rows& rows) {
  rows.add("detected (family-wise p below 1 %)", share_of(trials, detected));
  rows.add("a verdict other than nothing or noise", share_of(trials, [](const Trial& t) {
             return t.verdict != Verdict::nothing_found &&
                    t.verdict != Verdict::noise_larger_than_stated;
           }));
  rows.add("exact name, all", share_of(trials, leads_right));
  bins_of_delta(trials, rows);
}

/// What another threshold on a name's probability would give and take.
void about_thresholds(const std::vector<Trial>& trials, Rows& rows) {
  for (const double least : {0.5, 0.9, 0.95, 0.99, 0.999}) {
    const auto names = [&](bool right) {
      return share_of(trials, [&](const Trial& t) {
        return names_outright(t) && std::any_of(t.causes.begin(), t.causes.end(), [&](const NamedCause& c) {
                 const bool acts = std::any_of(t.hidden.begin(), t.hidden.end(), [&](const std::string& id) {
                   return means(c, id);
                 });
                 return c.probability >= least && acts == right;
               });
      });
    };
    rows.add(fmt::format("a name of {:g} and more: right; wrong", least),
             fmt::format("{:.1f} %; {:.1f} %", 100.0 * names(true).value(), 100.0 * names(false).value()));
  }
}

void about_claims(const std::vector<Trial>& trials, Rows& rows) {
  const Honesty h = honesty(trials);
  if (h.calibration.claims() == 0) return;
  rows.add("calibration error of stated probabilities",
           fmt::format("{:.3f} over {} claims", h.calibration.error(), h.calibration.claims()));
  rows.add("claims of 95 % or more that are right", h.sure_right);
}

void about_several(const std::vector<Trial>& trials, Rows& rows) {
  rows.add("all causes named", share_of(trials, all_named));
  rows.add("the leading cause is one of them", share_of(trials, [](const Trial& t) {
             return !t.causes.empty() &&
                    std::any_of(t.hidden.begin(), t.hidden.end(), [&](const std::string& id) {
                      return means(t.causes.front(), id);
                    });
           }));
  rows.add("a cause named that is not there", share_of(trials, [](const Trial& t) {
             if (t.verdict == Verdict::named_set) return false;
             return std::any_of(t.causes.begin(), t.causes.end(), [&](const NamedCause& c) {
               return std::none_of(t.hidden.begin(), t.hidden.end(), [&](const std::string& id) {
                 return means(c, id);
               });
             });
           }));
}

void about_unlisted(const std::vector<Trial>& trials, Rows& rows) {
  rows.add("refused: unknown pattern", share_of(trials, [](const Trial& t) {
             return t.verdict == Verdict::model_discrepancy;
           }));
  rows.add("undecided: a set, noise, bad points, nothing", share_of(trials, [](const Trial& t) {
             return t.verdict != Verdict::model_discrepancy && t.verdict != Verdict::named &&
                    t.verdict != Verdict::several_causes;
           }));
  rows.add("misnamed: named or several causes", share_of(trials, [](const Trial& t) {
             return t.verdict == Verdict::named || t.verdict == Verdict::several_causes;
           }));
  rows.add("... with 95 % or more", share_of(trials, [](const Trial& t) {
             return (t.verdict == Verdict::named || t.verdict == Verdict::several_causes) &&
                    !t.causes.empty() && t.causes.front().probability >= 0.95;
           }));
}

void about_bad_points(const std::vector<Trial>& trials, Rows& rows) {
  rows.add("clean verdict: bad points and no cause",
           share_of(trials, [](const Trial& t) { return t.verdict == Verdict::outliers; }));
  rows.add("every slip found", share_of(trials, all_bad_found));
  rows.add("more points called bad than were", share_of(trials, [](const Trial& t) {
             return t.bad_points.size() > t.answer.bad_points.size();
           }));
}

bool only_miscounts(const generator::Answer& answer) {
  return std::all_of(answer.hidden.begin(), answer.hidden.end(), [](const generator::Hidden& h) {
    return h.cause == generator::Cause::link_miscount;
  });
}

void about_errors(const std::vector<Trial>& trials, Rows& rows) {
  double calibrated = 0.0, extended = 0.0, oracle = 0.0;
  int count = 0;
  std::vector<double> worse;
  Share honest;
  Share honest_share;
  for (const Trial& t : trials) {
    if (!t.errors) continue;
    const TrueErrors& e = *t.errors;
    calibrated += e.calibrated * e.calibrated;
    extended += e.extended * e.extended;
    oracle += e.oracle * e.oracle;
    ++count;
    worse.push_back(e.extended / e.calibrated);
    // Naming a reading with a gross error hardly changes anything else.
    if (names_something(t) && !only_miscounts(t.answer)) {
      const double drop = e.calibrated * e.calibrated - e.extended * e.extended;
      honest.count(std::abs(e.reported_drop - drop) <= 0.15 * std::abs(drop));
      const double share = drop / (e.calibrated * e.calibrated);
      honest_share.count(std::abs(e.reported_share - share) <= 0.15 * std::abs(share));
    }
  }
  if (count == 0) return;
  const auto pooled = [&](double sum) { return std::sqrt(sum / count); };
  rows.add("held-out rms of the tool: calibrated, extended, oracle [mm]",
           fmt::format("{:.3f}, {:.3f}, {:.3f} ({} sets)",
                       pooled(calibrated),
                       pooled(extended),
                       pooled(oracle),
                       count));
  rows.add("extended over oracle", fmt::format("{:.3f}", std::sqrt(extended / oracle)));
  rows.add("extended over calibrated, 99th percentile",
           fmt::format("{:.3f}", quantile(worse, 0.99)));
  rows.add("reported drop of the mean square [mm^2] within 15 % of the true one", honest);
  rows.add("reported share of the mean square that goes within 15 % of the true one", honest_share);
}

void about_follow_up(const std::vector<Trial>& trials, Rows& rows) {
  Share resolved;
  for (const Trial& t : trials) {
    if (t.follow_up) resolved.count(t.follow_up->single_right);
  }
  rows.add("ambiguous sets with a single right name after follow-up", resolved);
}

std::string verdict_row(const std::vector<Trial>& trials) {
  std::map<std::string, int> counts;
  for (const Trial& t : trials) {
    ++counts[t.failed ? "failed" : std::string(grid::diagnosis::name(t.verdict))];
  }
  std::string line;
  for (const auto& [verdict, count] : counts) {
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", verdict, count);
  }
  return line;
}

std::string cell(const std::vector<NamedCause>& causes) {
  std::string line;
  for (const NamedCause& c : causes) {
    line += fmt::format("{}{}={:.3f}", line.empty() ? "" : " ", c.id, c.probability);
    for (const std::string& same : c.same_as) line += "~" + same;
  }
  return line;
}

std::string cell(const std::vector<std::size_t>& indices) {
  return fmt::format("{}", fmt::join(indices, " "));
}

}  // namespace

std::string text(const Share& share) {
  if (share.of == 0) return "-";
  const RateBounds bounds = rate_bounds_95(share.hits, share.of);
  return fmt::format("{:.1f} % ({} of {}; {:.1f}-{:.1f})",
                     100.0 * share.value(),
                     share.hits,
                     share.of,
                     100.0 * bounds.lower,
                     100.0 * bounds.upper);
}

Honesty honesty(const std::vector<Trial>& trials) {
  Honesty result;
  for (const Trial& t : trials) {
    if (!names_something(t)) continue;
    for (const NamedCause& named : t.causes) {
      const bool right = std::any_of(t.hidden.begin(), t.hidden.end(), [&](const std::string& id) {
        return means(named, id);
      });
      result.calibration.add(named.probability, right);
      if (named.probability >= 0.95) result.sure_right.count(right);
    }
  }
  return result;
}

std::string markdown(const TrialOptions& options, const std::vector<Trial>& trials) {
  Rows rows;
  rows.add("sets", fmt::format("{}", trials.size()));
  rows.add("verdicts", verdict_row(trials));
  switch (options.recipe.kind) {
    case Mix::single:
    case Mix::no_order:
    case Mix::rounded:
      about_one(trials, rows);
      break;
    case Mix::two:
    case Mix::three:
      about_several(trials, rows);
      break;
    case Mix::unlisted:
      about_unlisted(trials, rows);
      break;
    case Mix::alongside:
    case Mix::two_alongside:
    case Mix::pattern:
    case Mix::near:
      for (const auto& [what, share] : pattern_rows(trials)) rows.add(what, share);
      break;
    case Mix::bad_points:
      about_bad_points(trials, rows);
      rows.add("false name", share_of(trials, names_something));
      break;
    case Mix::bad_points_and_effect:
      rows.add("right name", share_of(trials, leads_right));
      rows.add("every slip found", share_of(trials, all_bad_found));
      break;
    default:
      rows.add("false name", share_of(trials, names_something));
      break;
  }
  about_claims(trials, rows);
  about_thresholds(trials, rows);
  const bool hides_pattern = trials.front().answer.pattern || options.recipe.kind == Mix::unlisted;
  if (!hides_pattern) {
    rows.add("a pattern told that is not there", share_of(trials, tells_pattern));
  }
  about_errors(trials, rows);
  about_follow_up(trials, rows);
  std::vector<double> seconds;
  for (const Trial& t : trials) seconds.push_back(t.seconds);
  rows.add("one analysis, median and longest [s]",
           fmt::format("{:.2f}, {:.2f}", quantile(seconds, 0.5), quantile(seconds, 1.0)));
  return fmt::format("| {} | |\n|---|---|\n{}", generator::word(options.recipe.kind), rows.str());
}

std::string csv(const std::vector<Trial>& trials) {
  std::string text =
      "seed,points,order,hidden,sizes,places,delta,nearest,nearest_rho,separable,verdict,family_"
      "wise_p,right,in_set,"
      "causes,hypotheses,left_over_delta,noise_factor,bad_found,bad_true,unlisted,unlisted_left_"
      "over,"
      "calibrated_mm,extended_mm,oracle_mm,reported_drop_mm2,follow_up,follow_up_right,seconds\n";
  auto out = std::back_inserter(text);
  for (const Trial& t : trials) {
    std::string sizes, places, hypotheses;
    for (const auto& h : t.answer.hidden) {
      sizes += fmt::format("{}{:.5g}", sizes.empty() ? "" : " ", h.size);
      places += fmt::format("{}{:.4g}", places.empty() ? "" : " ", h.place);
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(5, t.hypotheses.size()); ++i) {
      const auto& h = t.hypotheses[i];
      hypotheses += fmt::format("{}{}:{}={:.3f}",
                                i == 0 ? "" : " ",
                                h.effect,
                                h.side.empty() ? "-" : h.side,
                                h.probability);
    }
    fmt::format_to(out,
                   "{},{},{},{},{},{},{:.2f},",
                   t.seed,
                   t.points,
                   generator::word(t.answer.order),
                   fmt::join(t.hidden, " "),
                   sizes,
                   places,
                   fmt::join(t.answer.delta, " "));
    fmt::format_to(out,
                   "{}:{},{:.3f},{},{},{:.4f},{},{},{},{},{:.2f},{:.2f},{},{},{},{:.2f},",
                   generator::card(t.answer.nearest).id,
                   generator::word(t.answer.nearest_where),
                   t.answer.nearest_rho,
                   t.answer.separable ? 1 : 0,
                   t.failed ? "failed" : grid::diagnosis::name(t.verdict),
                   t.family_wise_p,
                   leads_right(t) ? 1 : 0,
                   in_set(t) ? 1 : 0,
                   cell(t.causes),
                   hypotheses,
                   t.left_over_delta,
                   t.noise_factor,
                   cell(t.bad_points),
                   cell(t.answer.bad_points),
                   t.answer.unlisted ? generator::word(t.answer.unlisted->oddity) : "",
                   t.answer.left_over_delta);
    const TrueErrors e = t.errors.value_or(TrueErrors{});
    fmt::format_to(out,
                   "{:.4f},{:.4f},{:.4f},{:.4f},{},{},{:.3f}\n",
                   e.calibrated,
                   e.extended,
                   e.oracle,
                   e.reported_drop,
                   t.follow_up ? t.follow_up->measurements : 0,
                   t.follow_up && t.follow_up->single_right ? 1 : 0,
                   t.seconds);
  }
  return text;
}

}  // namespace chaintrue::sealed
