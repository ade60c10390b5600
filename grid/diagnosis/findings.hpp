// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Turns an analysis into the answer: causes with sizes, hypotheses, bounds, settings, outliers,
/// the extended machine and the pictures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

std::vector<Cause> causes_found(const Analysis& analysis);
/// Probability that some cause of a class acts.
Hypothesis hypothesis_of(const CauseClass& members, double probability);
std::vector<Hypothesis> hypotheses(const Analysis& analysis);
/// The quarters of the bed, and each session separately.
std::vector<PartFinding> bed_part_findings(const Analysis& analysis);
std::vector<PartFinding> session_findings(const Analysis& analysis,
                                          const std::vector<std::string>& names);
/// Also moves effects that the settings absorb to `not_testable`.
std::vector<Bound> bounds(const Analysis& analysis, std::vector<NotTestable>& not_testable);
std::vector<CalibratedSetting> settings_found(const Analysis& analysis);
/// By number, points first.
std::vector<Outlier> outliers_found(const Analysis& analysis);
LeftOver left_over(const Analysis& analysis);
Unexplained unexplained(const Analysis& analysis);
ErrorBudget error_budget(const Analysis& analysis);
/// Units that count, of those whose error is the tool's where chains were read.
Indices units_of_error(const Analysis& analysis);

/// Probability that a cause, or one of its class, acts; 0 if none was compared.
double probability_of(const Analysis& analysis, const CauseId& cause);
/// In the order of the files' points, holes and distances.
std::vector<PointPicture> point_pictures(const Analysis& analysis);
std::vector<HolePicture> hole_pictures(const Analysis& analysis);
std::vector<DistancePicture> distance_pictures(const Analysis& analysis);

/// Verdict, causes, hypotheses, bounds and untestable causes: the part common to all answers.
void take_findings(const Analysis& analysis, Diagnosis& diagnosis);

/// Whether a reading decides between chain and paper.
bool shows_scale(const ExtraReading& reading);

/// Sets the machine and the corrections of the data from the causes; a class that may also be on
/// the paper only if the options accept it.
void apply_causes(const Analysis& analysis, Diagnosis& diagnosis);

/// Quarters without which the answer differs, and causes of one session alone; empty if there are
/// none.
std::vector<std::string> parts_in_words(const Diagnosis& diagnosis);

/// verdict, sentence, what_to_do, not_proved and notes from everything else.
void put_into_words(const Analysis& analysis, Diagnosis& diagnosis);

// The sentences of a verdict that all machines share, in the current machine's vocabulary.

/// "Most likely ...", "One of 2 causes ...", "3 causes act together ...", and the pattern besides
/// them. Empty if the verdict names no cause.
std::string causes_in_words(const Diagnosis& diagnosis);

/// The claimed law and its effect on the names; empty if none is claimed.
std::string claimed_law_in_words(const Diagnosis& diagnosis);

/// "a; b and c": the outliers.
std::string outliers_in_words(const Diagnosis& diagnosis);
/// A sentence for data in which nothing but the outliers is wrong.
std::string only_outliers_in_words(const Diagnosis& diagnosis);

/// What to do about the causes, in at most two lines; empty for a set, of which only one acts.
void say_remedies(Diagnosis& diagnosis);

/// "Measure next: `first`, and 3 more below. All of it raises the chance of a single name to 96 %."
std::string next_in_words(const Diagnosis& diagnosis, std::string_view first,
                          const std::vector<NextMeasurement>& all);

/// "one explanation alone" or "a single name".
std::string_view aim_of(const Diagnosis& diagnosis);

/// What a verdict does not prove.
std::string not_proved_in_words(const Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
