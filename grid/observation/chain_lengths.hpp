// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two chain lengths with the tool at a mark, read off the chains or paid out by the controller
/// for a command (then the mark is where the tool really went). A point is a unit of two rows.
///
///   y_i = f(sheet(m_i)),   C_i = sigma_length^2 I + sigma_position^2 J J'                   (1)
///
///   m_i  a mark
///   J    d(L, R)/d(mark)
#pragma once

#include <fmt/format.h>
#include <tuple>

#include "grid/containers.hpp"
#include "grid/eigen.hpp"
#include "grid/observation/observation.hpp"
#include "grid/plane_vectors.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::observation {

/// One sigma of a reading: of each chain's length, and of the tool's place on each axis.
struct PointNoise {
  double length_mm = 0.2;
  double position_mm = 0.3;
};

/// C_i of (1).
Matrix2d covariance_of(const PointNoise& noise, const Matrix2d& by_mark);

class ChainLengthReadings final : public Observation {
 public:
  /// Sorts the places: by visit where the order is known, else by mark and lengths.
  ChainLengthReadings(std::vector<Place> places, bool ordered, PointNoise noise, double noise_dof,
                      std::optional<SheetPrior> sheet)
      : Observation(ordered, noise_dof), noise_(noise) {
    sheet_ = sheet;
    sort(places, [](const Place& a, const Place& b) {
      return std::tie(a.order, a.mark.x_mm, a.mark.y_mm, a.lengths.left_mm, a.lengths.right_mm) <
             std::tie(b.order, b.mark.x_mm, b.mark.y_mm, b.lengths.left_mm, b.lengths.right_mm);
    });
    take(std::move(places));
  }
  /// As above, in the order of `places`.
  static ChainLengthReadings in_given_order(std::vector<Place> places, bool ordered,
                                            PointNoise noise, double noise_dof,
                                            std::optional<SheetPrior> sheet) {
    ChainLengthReadings readings({}, ordered, noise, noise_dof, sheet);
    readings.take(std::move(places));
    return readings;
  }

  const Kind& kind() const override { return chain_lengths; }
  [[nodiscard]] tl::expected<VectorXd, Unreachable> predicted(const View& view) const override {
    const model::MarkFrame frame(view.chains().machine());
    std::vector<model::Visit> visits;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      visits.push_back({view.sheet.to_bed(frame.place(places_[i].mark)),
                        ordered_ ? places_[i].order : static_cast<int>(i)});
    }
    const auto lengths = model::readings(view.chains(), visits);
    if (!lengths)
      return tl::unexpected(
          model::mechanism_failure(lengths.error().reason).at(lengths.error().place));
    VectorXd all(rows());
    for (std::size_t i = 0; i < lengths->size(); ++i) {
      model::ChainLengths own = (*lengths)[i];
      if (view.correction != nullptr) {
        own = view.correction->at(places_[i].mark, own, Matrix2d::Zero()).lengths;
      }
      const auto row = 2 * as_index(i);
      all.segment<2>(row) = vector_of(own);
    }
    return all;
  }

  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override {
    const std::vector<model::Setting> settings = settings_in(columns);
    const model::MarkFrame frame(view.chains().machine());
    Linearisation line = blank(std::ssize(settings));
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const model::MarkPoint place = frame.place(places_[i].mark);
      const auto reading = view.chains().at(view.sheet.to_bed(place));
      if (!reading) return tl::unexpected(model::mechanism_failure(reading.error()).at(i));
      ChainPlaceState state{*reading, places_[i].mark,
                            reading->position_jacobian * view.sheet.rotation()};
      model::ChainLengths lengths = reading->lengths;
      if (view.correction != nullptr) {
        const auto corrected = view.correction->at(places_[i].mark, lengths, state.by_mark);
        lengths = corrected.lengths;
        state.by_mark = corrected.by_mark;
        state.by_length = corrected.by_length;
      }
      const auto row = 2 * as_index(i);
      line.predicted.segment<2>(row) = vector_of(lengths);
      line.by_setting.middleRows<2>(row) =
          state.by_length.asDiagonal() * lengths_by_setting(view, *reading, place, settings);
      UnitState unit;
      unit.covariance = covariance_of(noise_, state.by_mark);
      unit.places.push_back({i, Matrix2d::Identity()});
      line.places.push_back(std::move(state));
      line.units.push_back(std::move(unit));
    }
    return line;
  }

  std::string name_of(std::size_t unit) const override {
    const Place& place = places_.at(unit);
    return fmt::format("point {} at ({:.1f}, {:.1f}) mm", place.name, place.mark.x_mm,
                       place.mark.y_mm);
  }

  const PointNoise& noise() const { return noise_; }

 private:
  void take(std::vector<Place> places) {
    places_ = std::move(places);
    measured_.resize(2 * std::ssize(places_));
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto row = 2 * as_index(i);
      measured_.segment<2>(row) = vector_of(places_[i].lengths);
      units_.push_back({row, 2, places_[i].index});
    }
  }

  PointNoise noise_;
};

}  // namespace chaintrue::grid::observation
