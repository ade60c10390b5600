// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From measurements to named causes, and what may withdraw a name: dependence on a single reading,
/// or a claimed law. Private to grid/diagnosis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/diagnosis/laws.hpp"
#include "grid/map/joint_fit.hpp"

namespace chaintrue::grid::diagnosis {

struct Naming {
  Analysis analysis;
  std::optional<VisitingOrderFound> order;  ///< found, and used
  LawsFound laws;
  std::optional<Stability> stability;
  std::vector<CauseGivenLaw> causes_given_law;
  std::optional<std::string> refusal;  ///< why a name that depends on one reading was withdrawn
};

/// `causes`: checks that can only withdraw a name are skipped if there is none.
enum class NamingFor { report, causes };

/// Fails as diagnose() does. Both uses name the same causes.
[[nodiscard]] tl::expected<Naming, DiagnosisFailure> name_causes(const Measured& measured,
                                                                 const DiagnosisOptions& options,
                                                                 NamingFor use);

/// name_causes() and joint_fit() of the same readings, in parallel if there are two cores.
struct NamingAndPlainFit {
  tl::expected<Naming, DiagnosisFailure> naming;
  tl::expected<JointFit, FitFailure> plain;
};
NamingAndPlainFit name_and_fit(const Measured& measured, const DiagnosisOptions& options,
                               NamingFor use, JointFitOptions fit_options);

}  // namespace chaintrue::grid::diagnosis
