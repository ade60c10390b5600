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

Reference parse_reference(const std::string& line) {
  std::istringstream stream(line);
  Reference r;
  std::string words;
  SmoothField& f = r.field;
  stream >> r.scan >> r.points >> f.length_mm >> f.left_mm >> f.right_mm >> f.correlation >>
      f.noise_factor >> words;
  if (!stream) throw std::invalid_argument("no reference: \"" + line + "\"");
  for (const std::string& word : sealed::words_of(words, ','))
    r.claims.push_back(sealed::parse_claim(word));
  return r;
}

}  // namespace

std::vector<Claim> claims_of(const grid::diagnosis::Diagnosis& found) {
  std::vector<Claim> claims;
  for (const auto& h : found.hypotheses) {
    const bool is_cause = h.effect != "nothing" && h.effect != "unknown" && h.effect != "noise" &&
                          h.effect != "bad_points" && h.effect != "law";
    if (!is_cause || h.probability < kLeastWritten) continue;
    Claim claim{{sealed::id_of(h.effect, h.side)}, std::round(1e4 * h.probability) / 1e4};
    // A hypothesis has the name of its class.
    for (std::size_t i = 1; i < h.causes.size(); ++i)
      claim.members.push_back(sealed::id_of(h.causes[i]));
    std::sort(claim.members.begin() + 1, claim.members.end());
    claims.push_back(std::move(claim));
  }
  return claims;
}

double probability_in(const std::vector<Claim>& claims, const Claim& of) {
  double most = 0.0;
  for (const Claim& claim : claims) {
    const bool common =
        std::ranges::any_of(of.members, [&](const auto& id) { return claim.means(id); });
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
    text += fmt::format("{} {} {:.0f} {:.3f} {:.3f} {:.2f} {:.3f} {}\n", r.scan, r.points,
                        r.field.length_mm, r.field.left_mm, r.field.right_mm, r.field.correlation,
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
