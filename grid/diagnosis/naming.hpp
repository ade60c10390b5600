// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From what was measured to the causes that are named, with what may take a name back: one reading that
/// makes it, or a claimed law. Private to grid/diagnosis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/visiting_order_found.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::grid::diagnosis {

struct Naming {
  Analysis analysis;
  std::optional<VisitingOrderFound> order;  ///< found, and gone by
  LawsFound laws;
  std::optional<Stability> stability;
  std::vector<CauseGivenLaw> causes_given_law;
  std::optional<std::string> refusal;  ///< why a name was taken back that one reading makes
};

/// `causes`: what can only take a name back is left out where there is no name.
enum class NamingFor { report, causes };

/// Fails as diagnose() does. Both uses name the same causes.
[[nodiscard]] tl::expected<Naming, DiagnosisFailure> name_causes(const Measured& measured,
                                                                 const DiagnosisOptions& options,
                                                                 NamingFor use);

/// name_causes() and joint_fit() of the same readings, at the same time where there are two cores.
struct NamingAndPlainFit {
  tl::expected<Naming, DiagnosisFailure> naming;
  tl::expected<JointFit, FitFailure> plain;
};
[[nodiscard]] NamingAndPlainFit name_and_fit(const Measured& measured,
                                             const DiagnosisOptions& options,
                                             NamingFor use,
                                             JointFitOptions fit_options);

}  // namespace chaintrue::grid::diagnosis
