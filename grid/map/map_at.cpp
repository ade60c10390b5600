// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_at.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/observation/observation.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

constexpr auto& kOfMachine = model::kMachineSettings;

tl::unexpected<CheckFailure> no_answer(std::string sentence) {
  return failed(CheckReason::unreachable, std::move(sentence));
}

/// Columns of d(lengths)/d(settings) at a mark, in the order of the surface's settings.
std::optional<Eigen::MatrixXd> design_at(const ModelSurface& surface,
                                         const model::ReadingModel& model,
                                         model::MarkPoint mark,
                                         Eigen::Matrix2Xd& by_parameter) {
  const observation::View view{model, surface.sheet};
  const auto reading = model.at(surface.sheet.to_bed(mark));
  if (!reading) return std::nullopt;
  by_parameter =
      observation::lengths_by_setting(view, *reading, mark, {kOfMachine.begin(), kOfMachine.end()});
  return design_rows(surface.residual.basis,
                     surface.columns,
                     mark,
                     reading->lengths,
                     observation::lengths_by_setting(view, *reading, mark, surface.settings));
}

}  // namespace

tl::expected<MapAt, CheckFailure> map_at(const CompensationMap& map,
                                         const std::vector<model::MarkPoint>& marks,
                                         const Progress& progress) {
  const auto count = std::ssize(marks);
  MapAt at;
  const auto* surface = std::get_if<ModelSurface>(&map.contents().surface);
  // A lattice's doubt is no linear function of the unknowns: its points stand for themselves.
  const bool is_joint = surface != nullptr && !surface->lattice;
  at.by_parameter.resize(2 * count, surface != nullptr ? std::ssize(kOfMachine) : 0);
  Eigen::MatrixXd design(2 * count, is_joint ? surface->columns.total() : 0);
  std::optional<model::ReadingModel> model;
  if (surface != nullptr) model.emplace(surface->machine);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double share = as_double(i) / as_double(count);
    tell(progress, {"the map at the new points", 1, 2, share});
    const model::MarkPoint mark = marks[as_size(i)];
    const auto refused = [&mark](const MapFailure& failure) {
      return no_answer(
          fmt::format("({:.1f}, {:.1f}): {}", mark.x_mm, mark.y_mm, failure.sentence()));
    };
    if (is_joint) {
      const auto here = map.lengths(mark);
      if (!here) return refused(here.error());
      at.lengths.push_back(here->lengths);
      at.by_mark.push_back(here->mark_jacobian);
    } else {
      const auto answer = map.query(mark);
      if (!answer) return refused(answer.error());
      at.lengths.push_back(answer->lengths);
      at.by_mark.push_back(answer->mark_jacobian);
      at.covariance.push_back(answer->covariance);
    }
    if (surface == nullptr) continue;
    Eigen::Matrix2Xd by_parameter;
    const auto rows = design_at(*surface, *model, mark, by_parameter);
    if (!rows) {
      return no_answer(fmt::format(
          "({:.1f}, {:.1f}): the calibrated machine has no pose there", mark.x_mm, mark.y_mm));
    }
    at.by_parameter.middleRows(2 * i, 2) = by_parameter;
    if (is_joint) design.middleRows(2 * i, 2) = *rows;
  }
  at.factor = is_joint ? Eigen::MatrixXd(design * surface->covariance_factor)
                       : Eigen::MatrixXd(2 * count, 0);
  return at;
}

}  // namespace chaintrue::grid
