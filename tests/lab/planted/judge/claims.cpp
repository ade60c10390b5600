// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "sealed/judge/trial.hpp"

namespace chaintrue::planted {
namespace {

constexpr double kLeastWritten = 0.001;

std::string id_of(const grid::diagnosis::Hypothesis& h) {
  return h.effect + ":" + (h.side.empty() ? "-" : h.side);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

double number_of(const std::string& text) {
  std::size_t end = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  if (end == 0 || end != text.size())
    throw std::invalid_argument("\"" + text + "\" is not a number");
  return value;
}

Reference parse_reference(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() != 8) {
    throw std::invalid_argument(
        fmt::format("a reference has 8 words, this line has {}: \"{}\"", words.size(), line));
  }
  Reference r;
  r.scan = words[0];
  r.points = static_cast<std::size_t>(number_of(words[1]));
  r.field = {number_of(words[2]),
             number_of(words[3]),
             number_of(words[4]),
             number_of(words[5]),
             number_of(words[6])};
  if (words[7] != "-") {
    for (const std::string& word : split(words[7], ',')) r.claims.push_back(parse_claim(word));
  }
  return r;
}

}  // namespace

bool Claim::means(std::string_view id) const {
  return std::find(members.begin(), members.end(), id) != members.end();
}

std::vector<Claim> claims_of(const grid::diagnosis::Diagnosis& found) {
  std::vector<Claim> claims;
  for (const auto& h : found.hypotheses) {
    const bool is_cause = h.effect != "nothing" && h.effect != "unknown" && h.effect != "noise" &&
                          h.effect != "bad_points" && h.effect != "law";
    if (!is_cause || h.probability < kLeastWritten) continue;
    Claim claim{{id_of(h)}, std::round(1e4 * h.probability) / 1e4};
    // A hypothesis has the name of its class.
    for (std::size_t i = 1; i < h.causes.size(); ++i) claim.members.push_back(sealed::id_of(h.causes[i]));
    std::sort(claim.members.begin() + 1, claim.members.end());
    claims.push_back(std::move(claim));
  }
  return claims;
}

std::string word_of(const Claim& claim) {
  return fmt::format("{}={:.4f}", fmt::join(claim.members, "~"), claim.probability);
}

Claim parse_claim(const std::string& word) {
  const auto at = word.rfind('=');
  if (at == std::string::npos || at == 0) {
    throw std::invalid_argument("\"" + word + "\": expected effect:side=probability");
  }
  return {split(word.substr(0, at), '~'), number_of(word.substr(at + 1))};
}

double probability_in(const std::vector<Claim>& claims, const Claim& of) {
  double most = 0.0;
  for (const Claim& claim : claims) {
    const bool common = std::any_of(
        of.members.begin(), of.members.end(), [&](const auto& id) { return claim.means(id); });
    if (common) most = std::max(most, claim.probability);
  }
  return most;
}

std::string text_of(const std::vector<Reference>& references) {
  std::string text =
      "# scan, points; the field: length, left, right [mm], correlation, noise as a "
      "multiple of the stated one; classes of causes\n";
  for (const Reference& r : references) {
    std::vector<std::string> words;
    for (const Claim& claim : r.claims) words.push_back(word_of(claim));
    text += fmt::format("{} {} {:.0f} {:.3f} {:.3f} {:.2f} {:.3f} {}\n",
                        r.scan,
                        r.points,
                        r.field.length_mm,
                        r.field.left_mm,
                        r.field.right_mm,
                        r.field.correlation,
                        r.field.noise_factor,
                        words.empty() ? "-" : fmt::format("{}", fmt::join(words, ",")));
  }
  return text;
}

std::vector<Reference> read_references(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::invalid_argument(path + " cannot be read");
  std::vector<Reference> references;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.front() != '#') references.push_back(parse_reference(line));
  }
  return references;
}

const Reference& reference_of(const std::vector<Reference>& references, std::string_view scan) {
  for (const Reference& r : references) {
    if (r.scan == scan) return r;
  }
  throw std::invalid_argument(
      fmt::format("no reference of the scan {}; --reference makes it", scan));
}

}  // namespace chaintrue::planted
