// SPDX-License-Identifier: GPL-3.0-or-later

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/findings.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {

void apply_causes(const Analysis& a, Diagnosis& diagnosis) {
  const ObservationSet& session = a.session;
  const bool scale_read = any_of(session.readings(), [](const ExtraReading& r) {
    return r.what == ReadingOf::link_pitch || r.what == ReadingOf::tape_error;
  });
  // Of a set the most probable goes in: on these points its rivals would do the same.
  std::vector<Cause> used = diagnosis.causes;
  if (diagnosis.verdict == Verdict::named_set) used.resize(1);
  // An extension that does not help on points that it was not fitted to is not made.
  const bool worse =
      diagnosis.improvement && diagnosis.improvement->extended.rms_mm >= diagnosis.improvement->calibrated.rms_mm;
  std::vector<model::AppliedEffect> into_machine;
  std::vector<int> taken;
  for (const Cause& cause : used) {
    const int column = best_regressor(a, cause.cause);
    // Links miscounted or skipped are none of the machine's: readings are mended whatever it gains.
    if (worse && !regressor(a, column).fixed) continue;
    const bool paper_too = any_of(cause.same_as, [](const auto& s) {
      return s.cause.effect->station == model::effects::Station::paper;
    });
    // Chain or paper: neither is touched before somebody has read the links or checked the tape.
    if (paper_too && !scale_read && !a.options.accept_class) continue;
    const bool in_machine = !model::effects::depends_on_visit(*cause.cause.effect) &&
                            cause.cause.effect->station != model::effects::Station::paper;
    auto& into = in_machine ? into_machine : diagnosis.data_corrections;
    into.push_back(applied(cause));
    into.back().probability = cause.probability;
    taken.push_back(column);
  }
  // The settings that belong to what is taken, and to nothing else.
  const Estimate fitted = taken.empty()
                              ? estimate_of(a, {})
                              : estimate_with(a, taken);
  const Eigen::VectorXd values = a.system.setting + fitted.setting_change;
  diagnosis.extended_machine = with_settings(session, stated_state(session), values).machine;
  append_all(diagnosis.extended_machine.effects, into_machine);
}

}  // namespace chaintrue::grid::diagnosis
