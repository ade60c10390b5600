// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <tuple>

#include "grid/containers.hpp"

namespace chaintrue::sealed {
namespace {

std::string list(const std::vector<std::string>& words) {
  return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ","));
}

auto key(const Outcome& outcome) { return std::tie(outcome.kind, outcome.seed); }

}  // namespace

std::vector<std::string> words_of(const std::string& text, char separator) {
  std::vector<std::string> words;
  std::istringstream stream(text == "-" ? "" : text);
  for (std::string word; std::getline(stream, word, separator);) words.push_back(word);
  return words;
}

std::vector<std::vector<std::string>> table(const std::string& file) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream in(CHAINTRUE_FIXTURES "/../tests/lab/" + file);
  if (!in) throw std::runtime_error("no table " + file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with('#')) rows.push_back(words_of(line, '\t'));
  }
  return rows;
}

void Outcome::fail() {
  verdict = "failed";
  named.clear();
  facts.clear();
}

bool Outcome::has(std::string_view fact) const {
  return grid::contains(facts, fact) || fact == "is_" + verdict;
}

std::string line_of(const Outcome& o) {
  std::vector<std::string> numbers;
  for (const auto& [name, value] : o.numbers)
    numbers.push_back(fmt::format("{}={:.6g}", name, value));
  return fmt::format("{} {} {} {:.2f} {} {} {} {}{}{}", o.kind, o.seed, o.points, o.strength,
                     list(o.hidden), o.verdict, list(o.named), list(o.facts),
                     numbers.empty() ? "" : " ", fmt::join(numbers, ","));
}

Outcome parse_outcome(const std::string& line) {
  const std::vector<std::string> words = words_of(line, ' ');
  try {
    if (words.size() != 8 && words.size() != 9)
      throw std::invalid_argument("an outcome has 8 or 9 words");
    Outcome outcome{words[0],
                    number_of<std::uint64_t>(words[1]),
                    number_of<int>(words[2]),
                    number_of<double>(words[3]),
                    words_of(words[4], ','),
                    words[5],
                    words_of(words[6], ','),
                    words_of(words[7], ','),
                    {}};
    for (const std::string& word : words_of(words.size() > 8 ? words[8] : "", ',')) {
      const auto at = word.find('=');
      outcome.numbers[word.substr(0, at)] = number_of<double>(word.substr(at + 1));
    }
    return outcome;
  } catch (const std::invalid_argument& trouble) {
    throw std::invalid_argument(fmt::format("{}: \"{}\"", trouble.what(), line));
  }
}

std::vector<Outcome> parse_outcomes(const std::string& text) {
  std::vector<Outcome> outcomes;
  for (const std::string& line : words_of(text.substr(0, text.rfind('\n') + 1), '\n')) {
    if (!line.empty() && line.front() != '#') outcomes.push_back(parse_outcome(line));
  }
  return outcomes;
}

std::vector<Outcome> sorted(std::vector<Outcome> outcomes) {
  grid::stable_sort(outcomes, grid::ascending(key));
  const auto is_same = [](const Outcome& a, const Outcome& b) {
    if (key(a) != key(b)) return false;
    if (line_of(a) != line_of(b))
      throw std::invalid_argument("one set has two outcomes:\n" + line_of(a) + "\n" + line_of(b));
    return true;
  };
  outcomes.erase(std::unique(outcomes.begin(), outcomes.end(), is_same), outcomes.end());
  return outcomes;
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
