// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/true_errors.hpp"

#include <algorithm>
#include <cmath>

#include "generator/hidden/oracle.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Hidden;
using generator::Lengths;
using generator::Vec2;
using generator::Visit;

// A miscount happened once; a fresh session does not include it.
std::vector<Hidden> lasting(std::vector<Hidden> effects) {
  std::erase_if(effects,
                [](const Hidden& h) { return h.cause == generator::Cause::link_miscount; });
  return effects;
}

bool hangs_on_visits(const generator::SealedSet& set) {
  using generator::Cause;
  const auto& hidden = set.machine.hidden();
  return std::any_of(hidden.begin(), hidden.end(), [](const Hidden& h) {
    return h.cause == Cause::drift || h.cause == Cause::tooth_skip ||
           h.cause == Cause::zero_shift || h.cause == Cause::direction_hysteresis;
  });
}

struct Fresh {
  std::vector<Visit> visits;
  std::vector<Vec2> marks;
  std::vector<int> numbers;
  std::vector<Lengths> exact;
  std::vector<std::array<double, 4>> slopes;
};

std::optional<Fresh> fresh_of(const generator::SealedSet& set) {
  generator::Dice dice(1, "fresh session");
  Fresh fresh;
  // Effects of the visits are evaluated at the session's own positions; all others over the whole
  // area.
  fresh.visits = hangs_on_visits(set) ? generator::fresh_session(set.machine, 150.0, dice)
                                      : generator::area_session(set.machine, dice);
  const auto hidden = lasting(set.machine.hidden());
  generator::HiddenMachine later(set.machine.stated(), set.machine.truth(), hidden);
  if (set.answer.left_over_delta > 0.0) later.suffers(set.machine.disturbance());
  const auto exact = later.exact(fresh.visits);
  const auto yardstick =
      generator::Yardstick::make(set.machine.truth(), fresh.visits, set.noise, {});
  if (!exact || !yardstick) return std::nullopt;
  fresh.exact = *exact;
  fresh.slopes = yardstick->slopes();
  for (const Visit& v : fresh.visits) {
    fresh.marks.push_back(generator::written(v.place, hidden));
    fresh.numbers.push_back(v.number);
  }
  return fresh;
}

// By the inverse Jacobian, from chains to tool.
double tool_rms_mm(const Fresh& fresh, const std::vector<Lengths>& predicted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const auto& [a, b, c, d] = fresh.slopes[i];
    const double l = fresh.exact[i][0] - predicted[i][0];
    const double r = fresh.exact[i][1] - predicted[i][1];
    const double det = a * d - b * c;
    const double x = (d * l - b * r) / det, y = (a * r - c * l) / det;
    sum += x * x + y * y;
  }
  return std::sqrt(sum / static_cast<double>(predicted.size()));
}

std::optional<double> reply(const generator::SealedSet& set, const Fresh& fresh,
                            std::span<const Hidden> effects) {
  generator::Record record;
  record.notes = set.notes;
  record.noise = set.noise;
  record.left_out = set.answer.bad_points;
  // Without the miscount, one point is still off by a whole link.
  for (const Hidden& h : set.answer.hidden) {
    if (h.cause == generator::Cause::link_miscount) {
      record.left_out.push_back(static_cast<std::size_t>(h.place));
    }
  }
  auto fitted = generator::fit_given(set.machine, effects, record);
  if (!fitted) return std::nullopt;
  fitted->effects = lasting(fitted->effects);
  const auto predicted = fitted->predict(fresh.marks, fresh.numbers);
  if (!predicted) return std::nullopt;
  return tool_rms_mm(fresh, *predicted);
}

// The diagnosis's machine with its corrections of the data; those that depend on the visits only
// for the session's own visits: no map includes them.
model::Machine extended(const grid::diagnosis::Diagnosis& found, bool same_visits) {
  model::Machine machine = found.extended_machine;
  machine.effects.insert(machine.effects.end(), found.data_corrections.begin(),
                         found.data_corrections.end());
  std::erase_if(machine.effects, [&](const model::AppliedEffect& e) {
    const auto* effect = model::effects::find_effect(e.effect);
    return e.effect == "link_miscount" ||
           (!same_visits && model::effects::depends_on_visit(*effect));
  });
  return machine;
}

std::optional<std::vector<Lengths>> predicted_by(const model::Machine& machine,
                                                 const Fresh& fresh) {
  const model::MarkFrame mark_frame(machine);
  std::vector<model::Visit> visits;
  for (std::size_t i = 0; i < fresh.marks.size(); ++i) {
    const model::MarkPoint mark{fresh.marks[i].x, fresh.marks[i].y};
    visits.push_back({model::identity_placement(mark_frame.place(mark)), fresh.numbers[i]});
  }
  const auto read = model::readings(model::ReadingModel(machine), visits);
  if (!read) return std::nullopt;
  std::vector<Lengths> lengths;
  for (const auto& r : *read) lengths.push_back({r.left_mm, r.right_mm});
  return lengths;
}

}  // namespace

std::optional<TrueErrors> true_errors(const generator::SealedSet& set,
                                      const grid::diagnosis::Diagnosis& found) {
  const auto fresh = fresh_of(set);
  if (!fresh) return std::nullopt;
  const auto predicted = predicted_by(extended(found, hangs_on_visits(set)), *fresh);
  const auto calibrated = reply(set, *fresh, {});
  const auto oracle = reply(set, *fresh, set.answer.hidden);
  if (!predicted || !calibrated || !oracle) return std::nullopt;
  TrueErrors errors{*calibrated, tool_rms_mm(*fresh, *predicted), *oracle};
  if (found.improvement) {
    errors.reported_drop = found.improvement->drop_mm2;
    errors.reported_share = found.improvement->drop_share;
  }
  return errors;
}

}  // namespace chaintrue::sealed
