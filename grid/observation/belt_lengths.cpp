// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/belt_lengths.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>

#include "grid/precondition.hpp"

namespace chaintrue::grid::observation {

const Kind belt_lengths{"belt_lengths", "point", "points", "point", false};

namespace {

std::vector<LengthsAtPlace> sorted_readings(std::vector<LengthsAtPlace> places) {
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) {
    if (a.visit.order != b.visit.order) return a.visit.order < b.visit.order;
    return std::lexicographical_compare(
        a.lengths_mm.begin(), a.lengths_mm.end(), b.lengths_mm.begin(), b.lengths_mm.end());
  });
  return places;
}

std::vector<Eigen::Index> counting_rows(const LengthsAtPlace& place) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < place.lengths_mm.size(); ++i) {
    if (place.counting.empty() || place.counting.at(static_cast<std::size_t>(i))) rows.push_back(i);
  }
  return rows;
}

Eigen::Index rows_of(const LengthsAtPlace& place) {
  const auto counting = static_cast<Eigen::Index>(counting_rows(place).size());
  return place.known ? counting : std::max<Eigen::Index>(counting - 2, 0);
}

}  // namespace

BeltLengthReadings::BeltLengthReadings(std::vector<LengthsAtPlace> places,
                                       bool ordered,
                                       BeltNoise noise,
                                       double noise_dof)
    : readings_(sorted_readings(std::move(places))),
      ordered_(ordered),
      noise_(noise),
      noise_dof_(noise_dof) {
  if (!(noise_.length_mm > 0.0 && noise_.position_mm >= 0.0)) {
    throw precondition("lengths with a sigma of {} mm at positions with {} mm",
                       noise_.length_mm,
                       noise_.position_mm);
  }
  std::vector<double> measured;
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const LengthsAtPlace& own = readings_[i];
    Place place;
    place.index = own.index;
    place.name = own.name;
    place.order = own.visit.order;
    if (own.known) place.mark = {own.known->x_mm, own.known->y_mm};
    places_.push_back(std::move(place));
    const Eigen::Index rows = rows_of(own);
    if (rows == 0) continue;
    units_.push_back({static_cast<Eigen::Index>(measured.size()), rows, own.index});
    place_of_unit_.push_back(i);
    if (own.known) {
      for (const Eigen::Index row : counting_rows(own)) measured.push_back(own.lengths_mm[row]);
    } else {
      measured.insert(measured.end(), static_cast<std::size_t>(rows), 0.0);
    }
  }
  measured_ = Eigen::Map<const Eigen::VectorXd>(measured.data(),
                                                static_cast<Eigen::Index>(measured.size()));
}

tl::expected<model::ToolPosition, model::MechanismFailure> BeltLengthReadings::position_of(
    const View& view, std::size_t place) const {
  const LengthsAtPlace& own = readings_.at(place);
  if (own.known) return *own.known;
  // From where all lengths together put it, from the middle where they put it nowhere.
  const auto by_all = view.mechanism->locate(own.lengths_mm, own.visit);
  if (by_all && own.counting.empty()) return *by_all;
  return model::locate_by_newton(*view.mechanism,
                                 own.lengths_mm,
                                 own.visit,
                                 by_all ? *by_all : view.mechanism->extent().centre(),
                                 own.counting);
}

tl::expected<BeltLengthReadings::UnitLine, Unreachable> BeltLengthReadings::line_of(
    const View& view, std::size_t unit, bool with_parameters) const {
  const std::size_t place = place_of_unit_[unit];
  const LengthsAtPlace& own = readings_[place];
  const auto position = position_of(view, place);
  if (!position) return tl::unexpected(Unreachable{place, position.error()});
  const auto at =
      view.mechanism->predict(*position,
                              own.visit,
                              with_parameters ? model::Derivatives::by_position_and_parameter
                                              : model::Derivatives::by_position);
  if (!at) return tl::unexpected(Unreachable{place, at.error()});
  const std::vector<Eigen::Index> rows = counting_rows(own);
  const auto count = static_cast<Eigen::Index>(rows.size());
  const Eigen::MatrixXd by_position = at->by_position(rows, Eigen::all);
  const Eigen::MatrixXd by_parameter = at->by_parameter(rows, Eigen::all);
  const double variance = noise_.length_mm * noise_.length_mm;
  Eigen::MatrixXd by_length =
      Eigen::MatrixXd::Zero(with_parameters ? count : 0, at->lengths_mm.size());
  for (Eigen::Index i = 0; i < by_length.rows(); ++i)
    by_length(i, rows[static_cast<std::size_t>(i)]) = 1.0;
  if (own.known) {
    return UnitLine{
        at->lengths_mm(rows),
        by_parameter,
        variance * Eigen::MatrixXd::Identity(count, count) +
            noise_.position_mm * noise_.position_mm * by_position * by_position.transpose(),
        by_length,
        at->lengths_mm};
  }
  const Eigen::MatrixXd q = by_position.householderQr().householderQ();
  const Eigen::MatrixXd checks = q.rightCols(count - 2).transpose();  // Q'
  const Eigen::VectorXd missing = own.lengths_mm(rows) - at->lengths_mm(rows);
  return UnitLine{-checks * missing,
                  checks * by_parameter,
                  variance * Eigen::MatrixXd::Identity(count - 2, count - 2),
                  with_parameters ? Eigen::MatrixXd(checks * by_length) : by_length,
                  at->lengths_mm};
}

tl::expected<Eigen::VectorXd, Unreachable> BeltLengthReadings::predicted(const View& view) const {
  Eigen::VectorXd all(rows());
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const auto line = line_of(view, u, false);
    if (!line) return tl::unexpected(line.error());
    all.segment(units_[u].first_row, units_[u].rows) = line->predicted;
  }
  return all;
}

tl::expected<Linearisation, Unreachable> BeltLengthReadings::linearise(
    const View& view, const Columns& columns) const {
  const Eigen::Index parameters = columns.parameters ? view.mechanism->values().size() : 0;
  Linearisation result;
  result.predicted.resize(rows());
  result.by_setting = Eigen::MatrixXd::Zero(rows(), parameters + (columns.sheet ? 3 : 0));
  result.by_nuisance.resize(rows(), 0);
  for (std::size_t u = 0; u < units_.size(); ++u) {
    auto line = line_of(view, u, columns.parameters);
    if (!line) return tl::unexpected(line.error());
    const Unit& unit = units_[u];
    result.predicted.segment(unit.first_row, unit.rows) = line->predicted;
    result.by_setting.block(unit.first_row, 0, unit.rows, parameters) = line->by_parameter;
    result.units.push_back({std::move(line->covariance), {}});
  }
  return result;
}

std::string BeltLengthReadings::untestable(const model::effects::Effect& effect,
                                           model::effects::EffectSide /*side*/) const {
  const bool needs_order = effect.needs == model::effects::DataNeed::order;
  return needs_order && !ordered_ ? "the order in which the points were visited is not known" : "";
}

std::string BeltLengthReadings::name_of(std::size_t unit) const {
  return "point " + places_.at(place_of_unit_.at(unit)).name;
}

}  // namespace chaintrue::grid::observation
