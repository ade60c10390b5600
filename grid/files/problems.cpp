// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/problems.hpp"

#include <algorithm>
#include <map>

#include "grid/containers.hpp"

namespace chaintrue::grid::files {
namespace {

bool is_continuation_byte(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Levenshtein distance, case-insensitive.
std::size_t errors_between(std::string_view a, std::string_view b) {
  Indices row = numbers_below(b.size() + 1);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced =
          diagonal + (in_lower_case(a[i - 1]) == in_lower_case(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

/// True for `left` and `left_mm`: people omit the unit.
bool is_without_unit(std::string_view word, std::string_view candidate) {
  return !word.empty() && candidate.size() > word.size() && candidate[word.size()] == '_' &&
         std::equal(word.begin(), word.end(), candidate.begin(),
                    [](char a, char b) { return in_lower_case(a) == in_lower_case(b); });
}

/// Limits the number of problems of one kind: of one file, with the same expectation. The number of
/// the omitted ones is given at the last one listed.
std::vector<InputProblem> few_of_a_kind(const std::vector<InputProblem>& all) {
  using Kind = std::pair<std::string, std::string>;
  const auto kind_of = [](const InputProblem& problem) {
    return Kind(problem.file, problem.expected);
  };
  std::map<Kind, std::size_t> total;
  for (const InputProblem& problem : all) ++total[kind_of(problem)];
  std::map<Kind, std::size_t> listed;
  std::vector<InputProblem> few;
  for (const InputProblem& problem : all) {
    const std::size_t most = Problems::kMostOfAKind;
    const std::size_t number = ++listed[kind_of(problem)];
    const std::size_t in_all = total[kind_of(problem)];
    // One more line is no longer than a count of one.
    if (number <= most || in_all == most + 1) few.push_back(problem);
    if (number != most || in_all <= most + 1) continue;
    few.push_back(problem);
    few.back().place.clear();
    few.back().sentence.clear();
    few.back().value = fmt::format("{} more like these", in_all - most);
  }
  return few;
}

}  // namespace

void Problems::add(std::string place, std::string_view value, ProblemKind kind,
                   std::string expected) {
  list_.push_back({file_, std::move(place), shortened(value), std::move(expected), {}, kind});
}

void Problems::explain(std::string place, ProblemKind kind, std::string sentence) {
  list_.push_back({file_, std::move(place), {}, {}, std::move(sentence), kind});
}

void Problems::warn(std::string place, std::string sentence, ProblemKind kind) {
  warnings_.push_back({file_, std::move(place), {}, {}, std::move(sentence), kind});
}

void Problems::add_all(const std::vector<InputProblem>& found) { append_all(list_, found); }

void Problems::add_warnings(const std::vector<Warning>& warnings) {
  append_all(warnings_, warnings);
}

bool Problems::at_or_below(std::string_view pointer) const {
  return any_of(list_, [pointer](const InputProblem& problem) {
    const std::string_view place = problem.place;
    return place.substr(0, pointer.size()) == pointer &&
           (place.size() == pointer.size() || place[pointer.size()] == '/');
  });
}

void Problems::throw_if_any() const {
  if (list_.empty()) return;
  std::vector<InputProblem> shown = few_of_a_kind(list_);
  if (shown.size() > kMostProblems) {
    const std::size_t more = shown.size() - kMostProblems;
    shown.resize(kMostProblems);
    shown.push_back({file_,
                     "",
                     fmt::format("{} more problems", more),
                     "the problems above to be corrected first",
                     {},
                     ProblemKind::too_many});
  }
  throw InputError(std::move(shown));
}

std::string shortened(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  constexpr std::string_view kCut = "...";
  std::string printable;
  std::size_t characters = 0;
  std::size_t cut_at = 0;
  for (const char c : text) {
    if (!is_continuation_byte(c)) {
      if (characters == kLongest - kCut.size()) cut_at = printable.size();
      if (++characters > kLongest) break;
    }
    const auto byte = static_cast<unsigned char>(c);
    printable += byte < 0x20U || byte == 0x7FU ? ' ' : c;
  }
  if (characters > kLongest) {
    printable.resize(cut_at);
    printable += kCut;
  }
  return printable;
}

std::string line_place(std::size_t line) { return fmt::format("line {}", line); }

std::string line_and_column(std::size_t line, std::size_t column) {
  return fmt::format("line {}, column {}", line, column);
}

std::string line_and_column_of(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + count_equal(before, '\n');
  const std::size_t last_break = before.rfind('\n');
  const std::size_t column = last_break == npos ? before.size() + 1 : before.size() - last_break;
  return line_and_column(line, column);
}

std::string nearest(std::string_view word, const Words& candidates) {
  constexpr std::size_t kLongestCompared = 100;
  if (word.size() > kLongestCompared) return {};
  const std::size_t most_errors = std::max<std::size_t>(2, word.size() / 3);
  std::string best;
  std::size_t fewest = most_errors + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t slips =
        is_without_unit(word, candidate) ? 0 : errors_between(word, candidate);
    if (slips < fewest && slips < candidate.size()) {
      fewest = slips;
      best = candidate;
    }
  }
  return best;
}

std::string joined(const Words& words) { return fmt::format("{}", fmt::join(words, ", ")); }

}  // namespace chaintrue::grid::files
