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
#include "sealed/judge/calibration.hpp"
#include "sealed/judge/rates.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Mix;

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

/// Figures that are not in the table of rates.
void about_names(const std::vector<Trial>& trials, Rows& rows) {
  Share separable;
  double members = 0.0;
  int sets = 0;
  for (const Trial& t : trials) {
    if (t.answer.separable) separable.count(leads_right(t));
    if (!names_something(t)) continue;
    members += static_cast<double>(t.causes.size());
    ++sets;
  }
  rows.add("detected (family-wise p below 1 %)", share_of(trials, detected));
  rows.add("exact name of causes separable at their strength", separable);
  if (sets > 0) rows.add("mean size of the named set", fmt::format("{:.2f}", members / sets));
}

/// The gain and loss with another threshold on a name's probability.
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

/// For every cause that is named, alone, among several or in a set; and how often those of 0.95 and more act.
void about_claims(const std::vector<Trial>& trials, Rows& rows) {
  Calibration calibration;
  Share sure_right;
  for (const Trial& t : trials) {
    if (!names_something(t)) continue;
    for (const NamedCause& named : t.causes) {
      const bool right =
          std::ranges::any_of(t.hidden, [&](const std::string& id) { return means(named, id); });
      calibration.add(named.probability, right);
      if (named.probability >= 0.95) sure_right.count(right);
    }
  }
  if (calibration.claims() == 0) return;
  rows.add("calibration error of stated probabilities",
           fmt::format("{:.3f} over {} claims", calibration.error(), calibration.claims()));
  rows.add("claims of 95 % or more that are right", sure_right);
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
    if (t.follow_up) resolved.count(*t.follow_up);
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

/// By the row of the table of rates that counts them.
std::string rate_kind_of(const generator::Recipe& recipe) {
  switch (recipe.kind) {
    case Mix::no_order:
    case Mix::rounded:
      return "single";
    case Mix::uneven_noise:
      return "wrong_noise";
    case Mix::alongside:
    case Mix::two_alongside:
      return recipe.patterns == generator::PatternGroup::other ? "beside_other" : "beside";
    default:
      return std::string(generator::word(recipe.kind));
  }
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

std::string markdown(const TrialOptions& options, const std::vector<Trial>& trials) {
  Rows rows;
  rows.add("sets", fmt::format("{}", trials.size()));
  rows.add("verdicts", verdict_row(trials));
  about_names(trials, rows);
  about_claims(trials, rows);
  about_thresholds(trials, rows);
  about_errors(trials, rows);
  about_follow_up(trials, rows);
  std::vector<double> seconds;
  std::vector<Outcome> outcomes;
  for (const Trial& t : trials) {
    seconds.push_back(t.seconds);
    outcomes.push_back(outcome_of(rate_kind_of(options.recipe), t));
  }
  rows.add("one analysis, median and longest [s]",
           fmt::format("{:.2f}, {:.2f}", quantile(seconds, 0.5), quantile(seconds, 1.0)));
  return fmt::format("{}\n| {} | |\n|---|---|\n{}",
                     rates_table(outcomes),
                     generator::word(options.recipe.kind),
                     rows.str());
}

}  // namespace chaintrue::sealed
