// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/other_places.hpp"

#include "grid/raster.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The first part with chain readings at marks.
std::size_t chain_part(const ObservationSet& session) {
  const auto* found =
      find_where(session.parts, [](const auto& part) { return part.reads_chains(); });
  return as_size(found - session.parts.data());
}

}  // namespace

interp::Rectangle marked_area(const ObservationSet& session) {
  const auto& places = session.parts[chain_part(session)].observation->places();
  const MarkPoint first = places.front().mark;
  interp::Rectangle area{first.x_mm, first.x_mm, first.y_mm, first.y_mm};
  for (const observation::Place& place : places) take_in(area, place.mark);
  return area;
}

FollowUp readings_at(const ObservationSet& session, std::size_t part,
                     std::vector<observation::Place> places) {
  const auto& own =
      dynamic_cast<const observation::ChainLengthReadings&>(*session.parts[part].observation);
  return {std::make_shared<const observation::ChainLengthReadings>(
              observation::ChainLengthReadings::in_given_order(
                  std::move(places), false, own.noise(), own.noise_dof(), own.sheet())),
          part};
}

ObservationSet session_at(const Analysis& a, const std::vector<MarkPoint>& marks) {
  const std::size_t part = chain_part(a.session);
  const observation::View view = a.state.view(a.session.parts[part]);
  std::vector<observation::Place> places;
  for (const MarkPoint& mark : marks) {
    if (view.chains().at(view.sheet.to_bed(mark))) places.push_back({0, "", mark, {}, 0});
  }
  return with_observations(a.session, {readings_at(a.session, part, std::move(places))});
}

ExpectedRows expected_rows(const Analysis& a, const Estimate& fitted, const RegressorSystem& there,
                           const std::function<std::optional<VectorXd>(const Regressor&)>& column) {
  const Index settings = fitted.setting_change.size();
  const auto by_setting = there.by_setting.leftCols(settings);
  ExpectedRows result{linear::product(by_setting, fitted.setting_change),
                      MatrixXd::Zero(by_setting.rows(), fitted.covariance.cols())};
  result.by_unknown.leftCols(settings) = by_setting;
  Index next = settings;
  for (const auto k : each_index(fitted.regressors)) {
    const bool is_free = contains(fitted.free, k);
    if (const auto g = column(regressor(a, fitted.regressors[k]))) {
      result.mean += *g * fitted.coefficient(as_index(k));
      if (is_free) result.by_unknown.col(next) = *g;
    }
    if (is_free) ++next;
  }
  return result;
}

VectorXd pattern_at(const Analysis& a, const Estimate& fitted, const RegressorSystem& there) {
  VectorXd rows = VectorXd::Zero(there.e.size());
  for (const SystemUnit& unit : there.units) {
    const SystemPlace& place = there.places[unit.places.front().place];
    rows.segment<2>(unit.first_row) =
        unit.whitening * discrepancy_at(a.system, marginalised_system(a), fitted, place);
  }
  return rows;
}

}  // namespace chaintrue::grid::diagnosis
