// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis claims: each class of causes with its probability; and the classes of a whole scan,
/// against which the claims of its parts are held.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "planted/judge/smooth_field.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::planted {

using sealed::Claim;

/// To four digits, those of 0.001 and more.
std::vector<Claim> claims_of(const grid::diagnosis::Diagnosis& found);
/// For the likeliest class that has a member in common; 0 where there is none.
double probability_in(const std::vector<Claim>& claims, const Claim& of);

/// The diagnosis of a whole scan without an order of visits, and the smooth field on it.
struct Reference {
  std::string scan;
  std::size_t points = 0;
  SmoothField field;
  std::vector<Claim> claims;
};
std::string text_of(const std::vector<Reference>& references);
/// Lines that begin with `#` are comments. \throws std::invalid_argument with the line if it is
/// malformed, or with the path if it cannot be read.
std::vector<Reference> read_references(const std::string& path);
/// \throws std::invalid_argument if there is none.
const Reference& reference_of(const std::vector<Reference>& references, std::string_view scan);

}  // namespace chaintrue::planted
