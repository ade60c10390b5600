// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An analysis in the words of the answer: causes with sizes, hypotheses, terms, bounds, settings,
/// outliers, the extended machine and the pictures.
#pragma once

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

[[nodiscard]] std::vector<Cause> causes_found(const Session& session,
                                              const Analysis& analysis,
                                              bool order_assumed);
[[nodiscard]] std::vector<Hypothesis> hypotheses(const Analysis& analysis);
[[nodiscard]] std::vector<Term> terms(const Session& session,
                                      const DiagnosisOptions& options,
                                      const Analysis& analysis);
/// Also moves effects that the settings absorb to `not_testable`.
[[nodiscard]] std::vector<Bound> bounds(const Session& session,
                                        const Analysis& analysis,
                                        std::vector<NotTestable>& not_testable);
[[nodiscard]] std::vector<CalibratedSetting> settings_found(const Session& session,
                                                            const Analysis& analysis);
[[nodiscard]] std::vector<Outlier> outliers_found(const Session& session, const Analysis& analysis);
/// The same of distances; distance_findings.cpp.
[[nodiscard]] std::vector<Outlier> distance_outliers_found(const Session& session,
                                                           const Analysis& analysis);
[[nodiscard]] std::vector<HolePicture> hole_pictures(const Session& session,
                                                     const Analysis& analysis);
[[nodiscard]] std::vector<DistancePicture> distance_pictures(const Session& session,
                                                             const Analysis& analysis);
[[nodiscard]] std::vector<Separation> separations(const Analysis& analysis);
[[nodiscard]] std::vector<PointPicture> pictures(const Session& session, const Analysis& analysis);
[[nodiscard]] LeftOver left_over(const Session& session,
                                 const Analysis& analysis,
                                 std::uint64_t seed);

/// Sets the machine and the corrections of the data from the causes; a class that may lie on the
/// paper as well only where `accept_class`.
void extend(const Session& session,
            const Analysis& analysis,
            bool accept_class,
            Diagnosis& diagnosis);

/// verdict, sentence, what_to_do, not_proved and notes from everything else.
void put_into_words(const Session& session, Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
