// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {
namespace {

using grid::diagnosis::Verdict;

/// Names with a lower probability do not count as claims.
constexpr double kClaim = 0.9;

std::string with_class(const NamedCause& cause) {
  std::string text = cause.id;
  for (const std::string& same : cause.same_as) text += "~" + same;
  return text;
}

double strength_of(const generator::Answer& answer) {
  if (!answer.delta.empty()) return answer.delta.front();
  if (answer.pattern) return answer.pattern->delta;
  return answer.left_over_delta;
}

/// The facts that are true, in the order of evaluation.
class Facts {
 public:
  void add(const char* fact, bool holds) {
    if (holds) facts_.emplace_back(fact);
  }
  [[nodiscard]] std::vector<std::string> taken() { return std::move(facts_); }

 private:
  std::vector<std::string> facts_;
};

std::vector<std::string> facts_of(const Trial& t) {
  if (t.failed) return {};
  Facts facts;
  const bool hides = !t.hidden.empty();
  facts.add("leads", leads_right(t));
  facts.add("alone", t.verdict == Verdict::named && leads_right(t));
  facts.add("held", in_set(t));
  facts.add("all", hides && all_named(t));
  facts.add("outright", names_outright(t));
  facts.add("nothing_false", !names_wrongly(t));
  facts.add("no_false_claim",
            !names_wrongly(t) || t.causes.empty() || t.causes.front().probability < kClaim);
  facts.add("no_name", !names_something(t));
  facts.add("pattern", tells_pattern(t));
  facts.add("no_pattern", !tells_pattern(t));
  facts.add("refused", t.verdict == Verdict::model_discrepancy);
  facts.add("only_bad_points", t.verdict == Verdict::outliers);
  facts.add("bad_found", all_bad_found(t));
  facts.add("no_more_bad", t.bad_points.size() <= t.answer.bad_points.size());
  return facts.taken();
}

std::vector<std::string> facts_of(const BeltsTrial& t) {
  if (t.failed) return {};
  Facts facts;
  facts.add("alone", t.exact);
  facts.add("held", t.held);
  facts.add("right_belt", t.right_belt);
  facts.add("nothing_false", !t.named || t.held);
  facts.add("no_name", !t.named);
  facts.add("no_pattern", t.verdict != "unknown_pattern");
  facts.add("bad_found", t.bad_found);
  return facts.taken();
}

std::string list(const std::vector<std::string>& words) {
  return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ","));
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  if (text == "-") return words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

template <class Number>
Number number_of(const std::string& text, const std::string& line) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end) {
    throw std::invalid_argument("\"" + text + "\" is not a number in the outcome \"" + line + "\"");
  }
  return value;
}

auto key(const Outcome& outcome) { return std::tie(outcome.kind, outcome.seed); }

}  // namespace

bool Outcome::has(std::string_view fact) const {
  return std::find(facts.begin(), facts.end(), fact) != facts.end();
}

Outcome outcome_of(std::string kind, const Trial& trial) {
  Outcome outcome{std::move(kind), trial.seed, trial.points, 0.0, trial.hidden, {}, {}, {}};
  outcome.strength = strength_of(trial.answer);
  outcome.verdict = trial.failed ? "failed" : std::string(grid::diagnosis::name(trial.verdict));
  for (const NamedCause& cause : trial.causes) outcome.named.push_back(with_class(cause));
  outcome.facts = facts_of(trial);
  return outcome;
}

Outcome outcome_of(std::string kind, const BeltsTrial& trial) {
  Outcome outcome{std::move(kind), trial.seed, trial.points, trial.secret.strength, {}, {}, {}, {}};
  if (!trial.secret.effect.empty()) {
    outcome.hidden.push_back(trial.secret.effect + ":" +
                             (trial.secret.side.empty() ? "-" : trial.secret.side));
  }
  outcome.verdict = trial.failed ? "failed" : trial.verdict;
  for (const NamedCause& cause : trial.causes) outcome.named.push_back(with_class(cause));
  outcome.facts = facts_of(trial);
  return outcome;
}

std::string line_of(const Outcome& o) {
  return fmt::format("{} {} {} {:.2f} {} {} {} {}",
                     o.kind,
                     o.seed,
                     o.points,
                     o.strength,
                     list(o.hidden),
                     o.verdict,
                     list(o.named),
                     list(o.facts));
}

Outcome parse_outcome(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() != 8) {
    throw std::invalid_argument(
        fmt::format("an outcome has 8 words, this line has {}: \"{}\"", words.size(), line));
  }
  return {words[0],
          number_of<std::uint64_t>(words[1], line),
          number_of<int>(words[2], line),
          number_of<double>(words[3], line),
          words_of(words[4]),
          words[5],
          words_of(words[6]),
          words_of(words[7])};
}

std::vector<Outcome> parse_outcomes(const std::string& text) {
  std::vector<Outcome> outcomes;
  std::istringstream stream(text.substr(0, text.rfind('\n') + 1));
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.front() != '#') outcomes.push_back(parse_outcome(line));
  }
  return outcomes;
}

std::vector<Outcome> sorted(std::vector<Outcome> outcomes) {
  std::stable_sort(outcomes.begin(), outcomes.end(), [](const Outcome& a, const Outcome& b) {
    return key(a) < key(b);
  });
  std::vector<Outcome> result;
  for (Outcome& outcome : outcomes) {
    if (result.empty() || key(result.back()) != key(outcome)) {
      result.push_back(std::move(outcome));
    } else if (line_of(result.back()) != line_of(outcome)) {
      throw std::invalid_argument("one set has two outcomes:\n" + line_of(result.back()) + "\n" +
                                  line_of(outcome));
    }
  }
  return result;
}

std::string text_of(const std::vector<Outcome>& outcomes) {
  std::string text;
  for (const Outcome& outcome : outcomes) text += line_of(outcome) + "\n";
  return text;
}

std::vector<Outcome> read_outcomes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::invalid_argument(path + " cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return parse_outcomes(text.str());
}

void write_outcomes(const std::string& path, const std::vector<Outcome>& outcomes) {
  const std::string whole = path + ".part";
  std::ofstream file(whole, std::ios::binary);
  file << text_of(outcomes);
  file.close();
  if (!file) throw std::invalid_argument(whole + " cannot be written");
  std::filesystem::rename(whole, path);
}

}  // namespace chaintrue::sealed
