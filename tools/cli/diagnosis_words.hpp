// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A diagnosis in the words and units of a workshop, for the terminal and for the report's page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "model/coordinates.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::cli {

/// "chain pitch error, left"
std::string cause_title(const diagnosis::CauseId& cause);
std::string cause_title(const AppliedEffect& effect);
/// Named causes that are neither in the diagnosis' machine nor in the corrected data: rivals of
/// those that are, and causes that may be the tape's.
std::vector<diagnosis::Cause> causes_left_out(const Diagnosis& found);
/// Also accepts the hypotheses nothing, unknown, noise and bad_points.
std::string hypothesis_title(const diagnosis::Hypothesis& hypothesis);

/// "point 17", counted from 1.
std::string point_name(std::size_t index);
/// "distance A-B", by its position in the file.
std::string distance_name(const Diagnosis& found, std::size_t index);
/// Whether distances between holes were measured instead of points.
bool is_of_distances(const Diagnosis& found);
/// A bound in a workshop unit.
std::string bound_in_words(const diagnosis::Bound& bound);
/// Noise alone gives as much in less than one of a hundred cases.
bool is_surprising(const diagnosis::LeftOver& left_over);
/// A sentence on the residual with the named causes.
std::string left_over_sentence(const diagnosis::LeftOver& left_over);
/// The files of a diagnosis, as named in a command: GRID, HOLES, both, or BELTS.
std::string_view files_in_words(const Diagnosis& found);

/// The data: "34 points", "20 distances", "34 points and 20 distances", "99 places".
std::string readings_counted(const Diagnosis& found);
/// Whether this outlier is a distance rather than a point.
bool is_distance(const Diagnosis& found, const diagnosis::Outlier& bad);
/// " A single right name then has probability 95 %." of the next measurement with that position;
/// empty if it determines the scale of belts, which does not discriminate between causes.
std::string chance_then(const Diagnosis& diagnosis, std::size_t position);
/// The next measurements as sentences: what to do, where, and how well.
std::vector<std::string> follow_ups_in_words(const Diagnosis& diagnosis);
/// Their places, each once: "3, 6" where the third and the sixth are at one mark.
struct FollowUpPlace {
  std::string numbers;
  MarkPoint mark;
  std::string what;
  double raises_probability_to = 0.0;
};
std::vector<FollowUpPlace> follow_up_places(const Diagnosis& diagnosis);

using diagnosis::off_in_words;
using diagnosis::percent;
using diagnosis::sizes_in_words;
/// "the top left belt at point 17: read 80.2 mm too long (31.0 sigmas)"
std::string bad_belt_in_words(const diagnosis::Outlier& bad);
using report::capitalised;
using report::fixed;

/// "left" or "right".
inline const char* chain_name(model::Side side) {
  return side == model::Side::left ? "left" : "right";
}

}  // namespace chaintrue::cli
