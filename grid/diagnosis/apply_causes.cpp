// SPDX-License-Identifier: GPL-3.0-or-later

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/findings.hpp"
#include "interp/eigen.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {

void apply_causes(const Analysis& a, Diagnosis& diagnosis) {
  const ObservationSet& session = a.session;
  const bool scale_read = any_of(session.readings(), shows_scale);
  // The most probable of a set is applied: at these points its rivals do the same.
  std::vector<Cause> used = diagnosis.causes;
  if (diagnosis.verdict == Verdict::named_set) used.resize(1);
  // An extension must improve left-out points.
  const bool worse = diagnosis.improvement && diagnosis.improvement->extended.rms_mm >=
                                                  diagnosis.improvement->calibrated.rms_mm;
  std::vector<AppliedEffect> into_machine;
  RegressorSet taken;
  for (const Cause& cause : used) {
    const int column = best_regressor(a, cause.cause);
    // Miscounted or skipped links are not properties of the machine: readings are always corrected.
    if (worse && !regressor(a, column).fixed) continue;
    const bool paper_too = any_of(
        cause.same_as, [](const auto& s) { return s.cause.effect->station == Station::paper; });
    // Chain or paper: neither is changed before the links are read or the tape is checked.
    if (paper_too && !scale_read && !a.options.accept_class) continue;
    const bool in_machine =
        !depends_on_visit(*cause.cause.effect) && cause.cause.effect->station != Station::paper;
    auto& into = in_machine ? into_machine : diagnosis.data_corrections;
    into.push_back(applied(cause));
    into.back().probability = cause.probability;
    taken.push_back(column);
  }
  // The settings that go with the applied causes only.
  const Estimate fitted = taken.empty() ? estimate_of(a, {}) : estimate_with(a, taken);
  const VectorXd values = a.system.setting + fitted.setting_change;
  diagnosis.extended_machine = with_settings(session, stated_state(session), values).machine();
  append_all(diagnosis.extended_machine.effects, into_machine);
}

}  // namespace chaintrue::grid::diagnosis
