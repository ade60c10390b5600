// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis claims: each class of causes with its probability, as one word of text, and the
/// classes of a whole scan, against which the claims of its parts are held.
///
///   tape_scale:x=0.9991
///   chain_pitch_error:both~tape_scale:both=0.1204
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "planted/judge/smooth_field.hpp"

namespace chaintrue::planted {

struct Claim {
  std::vector<std::string> members;  ///< effect:side; the one that gives the class its name first
  double probability = 0.0;

  [[nodiscard]] bool means(std::string_view id) const;
  bool operator==(const Claim&) const = default;
};
/// To four digits, those of 0.001 and more.
[[nodiscard]] std::vector<Claim> claims_of(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] std::string word_of(const Claim& claim);
/// \throws std::invalid_argument with the word if it is not one.
[[nodiscard]] Claim parse_claim(const std::string& word);

/// For the likeliest class that has a member in common; 0 where there is none.
[[nodiscard]] double probability_in(const std::vector<Claim>& claims, const Claim& of);

/// The diagnosis of a whole scan without an order of visits, and the smooth field on it.
struct Reference {
  std::string scan;
  std::size_t points = 0;
  SmoothField field;
  std::vector<Claim> claims;
};
[[nodiscard]] std::string text_of(const std::vector<Reference>& references);
/// Lines that begin with `#` are comments. \throws std::invalid_argument with the line if it is
/// malformed, or with the path if it cannot be read.
[[nodiscard]] std::vector<Reference> read_references(const std::string& path);
/// \throws std::invalid_argument if there is none.
[[nodiscard]] const Reference& reference_of(const std::vector<Reference>& references,
                                            std::string_view scan);

}  // namespace chaintrue::planted
