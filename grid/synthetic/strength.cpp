// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/strength.hpp"

#include "grid/plane_vectors.hpp"
#include "grid/synthetic/design.hpp"

namespace chaintrue::grid::synthetic {
namespace {

using model::AppliedEffect;
using model::Machine;
using model::Visit;

std::vector<model::ChainLengths> lengths_of(const Machine& machine,
                                            const std::vector<Visit>& visits) {
  const auto lengths = model::readings(model::ReadingModel(machine), visits);
  if (!lengths) {
    const model::BedPoint p = visits[lengths.error().place].position;
    throw precondition(
        "signature: ({}, {}) mm cannot be reached: {}", p.x_mm, p.y_mm, lengths.error().sentence());
  }
  return *lengths;
}

}  // namespace

std::vector<Visit> regular_session(const Machine& machine, int columns, int rows) {
  Design design;
  design.columns = columns;
  design.rows = rows;
  Random unused(0);
  std::vector<Visit> visits;
  for (const Mark& mark : marks(machine.bed, design, unused)) {
    visits.push_back({model::identity_placement(mark.place), static_cast<int>(visits.size())});
  }
  return visits;
}

std::vector<Eigen::Vector2d> SessionSignature::tool_shift_mm() const {
  std::vector<Eigen::Vector2d> shift;
  for (std::size_t i = 0; i < residual_mm.size(); ++i) {
    shift.emplace_back(-length_by_xy[i].inverse() * residual_mm[i]);
  }
  return shift;
}

SessionSignature signature(const Machine& stated,
                           const std::vector<AppliedEffect>& effects,
                           const std::vector<Visit>& visits) {
  Machine true_machine = stated;
  append_all(true_machine.effects, effects);
  const model::ReadingModel plain(stated);
  const model::MarkFrame mark_frame(true_machine);
  const model::MarkFrame stated_mark_frame(stated);
  const std::vector<model::ChainLengths> before = lengths_of(stated, visits);
  const std::vector<model::ChainLengths> after = lengths_of(true_machine, visits);
  SessionSignature result;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const auto reading = plain.at(visits[i].position);
    if (!reading) {
      throw precondition("signature: visit {}: {}", i, reading.error().sentence());
    }
    const model::MarkPoint place = model::identity_placement(visits[i].position);
    const model::MarkPoint written = mark_frame.written(place);
    const model::MarkPoint usual = stated_mark_frame.written(place);
    const Eigen::Vector2d moved = difference(written, usual);
    const Eigen::Vector2d gained = difference(after[i], before[i]);
    result.length_by_xy.push_back(reading->position_jacobian);
    result.residual_mm.emplace_back(gained - reading->position_jacobian * moved);
  }
  return result;
}

}  // namespace chaintrue::grid::synthetic
