// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/anchors_file.hpp"

#include <fmt/format.h>

#include "grid/files/belt_holes_record.hpp"
#include "grid/files/belts_record.hpp"
#include "grid/files/content_hash.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/schemas.hpp"
#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Belt;
using model::PerBelt;

constexpr Range kSquare{"mm^2", -1e12, 1e12};
constexpr int kMostPlaces = 100000;

const Record<AnchorCoordinate>& fitted_coordinate_record() {
  static const auto record =
      Record<AnchorCoordinate>("a coordinate of an anchor")
          .required("coordinate",
                    &AnchorCoordinate::name,
                    one_of({"tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"}))
          .optional("stated_mm", &AnchorCoordinate::stated_mm, number(kMillimetres))
          .required("fitted_mm", &AnchorCoordinate::fitted_mm, number(kMillimetres))
          .required("sigma_mm", &AnchorCoordinate::sigma_mm, number(kSigmaMm))
          .required("rests_on",
                    &AnchorCoordinate::variance_share,
                    object(per_belt_record<double>(number(kAnyNumber))));
  return record;
}

const Record<BadBeltReading>& bad_record() {
  static const auto record =
      Record<BadBeltReading>("a bad reading")
          .required("point", &BadBeltReading::point, index_number(0, kMostPlaces))
          .required("belt", &BadBeltReading::belt, belt_word())
          .required("off_mm", &BadBeltReading::residual_mm, number(kMillimetres));
  return record;
}

const Record<BeltResidual>& residual_record() {
  static const auto record =
      Record<BeltResidual>("a reading's residual")
          .required("off_mm", &BeltResidual::residual_mm, number(kMillimetres))
          .required("counts", &BeltResidual::counts, boolean())
          .required("sigmas", &BeltResidual::sigmas, number(kAnyNumber))
          .required("beside_mm", &BeltResidual::deleted_residual_mm, number(kMillimetres));
  return record;
}

/// A list of exactly that length; problems are reported.
std::optional<std::vector<double>> numbers(const Cursor& at,
                                           std::size_t count,
                                           const Range& range) {
  auto found = list(number(range)).read(at);
  if (found && found->size() != count) {
    at.problems().add(at.pointer(),
                      fmt::format("{} of them", found->size()),
                      fmt::format("{} numbers", count),
                      ProblemKind::wrong_count);
    return std::nullopt;
  }
  return found;
}

const Record<FittedPlace>& fitted_place_record() {
  static const auto record = [] {
    Record<FittedPlace> place("a fitted place");
    using model::FramePoint;
    place.required("x_mm", path(&FittedPlace::at, &FramePoint::x_mm), number(kMillimetres))
        .required("y_mm", path(&FittedPlace::at, &FramePoint::y_mm), number(kMillimetres));
    place.custom(
        "covariance_mm2",
        true,
        {"its covariance: xx, xy, yy", list(number(kSquare), 3).expected.schema},
        [](const Cursor& at, FittedPlace& p) {
          if (const auto c = numbers(at, 3, kSquare))
            p.covariance_mm2 << (*c)[0], (*c)[1], (*c)[1], (*c)[2];
        },
        [](const FittedPlace& p) {
          const auto& c = p.covariance_mm2;
          return std::optional<Json>(Json::array({c(0, 0), c(0, 1), c(1, 1)}));
        });
    for (const Belt belt : model::kBelts) {
      place.custom(
          std::string(name(belt)),
          true,
          residual_record().expected(),
          [belt](const Cursor& at, FittedPlace& p) {
            if (const auto found = residual_record().read(at)) p.belts[belt] = *found;
          },
          [belt](const FittedPlace& p) {
            return std::optional<Json>(residual_record().write(p.belts[belt]));
          });
    }
    return place;
  }();
  return record;
}

void read_coordinates(const Cursor& at, BeltsFit& fit) {
  const auto found = list(object(fitted_coordinate_record())).read(at);
  if (!found) return;
  if (found->size() != fit.coordinates.size()) {
    at.problems().add(at.pointer(),
                      fmt::format("{} of them", found->size()),
                      "five coordinates",
                      ProblemKind::wrong_count);
    return;
  }
  std::copy(found->begin(), found->end(), fit.coordinates.begin());
}

void read_covariance(const Cursor& at, BeltsFit& fit) {
  constexpr Eigen::Index kSize = 5;
  if (!at.json().is_array() || at.json().size() != kSize)
    return at.expect("five rows of five numbers");
  for (Eigen::Index i = 0; i < kSize; ++i) {
    const auto row = numbers(at.element(static_cast<std::size_t>(i)), kSize, kSquare);
    for (Eigen::Index j = 0; row && j < kSize; ++j)
      fit.covariance_mm2(i, j) = (*row)[static_cast<std::size_t>(j)];
  }
}

std::optional<Json> written_covariance(const BeltsFit& fit) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < fit.covariance_mm2.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < fit.covariance_mm2.cols(); ++j)
      row.push_back(fit.covariance_mm2(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

struct StatedBeltPrediction {
  BeltPrediction one_left_out;
  std::optional<BeltPrediction> half_left_out;
};

const Record<StatedBeltPrediction>& both_predictions_record() {
  static const auto record =
      Record<StatedBeltPrediction>("what was predicted")
          .required(
              "one_left_out", &StatedBeltPrediction::one_left_out, object(prediction_record()))
          .optional(
              "half_left_out", &StatedBeltPrediction::half_left_out, object(prediction_record()));
  return record;
}

/// Of the belts' table, with values that it may have.
void check_cause(const Cursor& at, CauseInAnchorFit& cause) {
  const std::vector<model::AppliedEffect> applied = {{cause.effect, cause.side, cause.parameters}};
  for (const model::MachineProblem& problem : model::belts::problems_of(applied))
    at.problems().add(at.pointer() + problem.parameter.substr(2), problem);
}

const Record<CauseInAnchorFit>& cause_in_fit_record() {
  static const auto record =
      Record<CauseInAnchorFit>("a cause with the anchors")
          .required("effect", &CauseInAnchorFit::effect, text())
          .sparse("side", &CauseInAnchorFit::side, one_of({"tl", "tr", "bl", "br", "all"}))
          .required("parameters", &CauseInAnchorFit::parameters, dictionary(number(kAnyNumber)))
          .required("sigma", &CauseInAnchorFit::sigma, number(kAnyNumber))
          .required("probability", &CauseInAnchorFit::probability, number(kShare))
          .check(check_cause);
  return record;
}

/// All fields but the name.
void add_fit(Record<BeltsFit>& record) {
  record.required("machine", &BeltsFit::machine, object(belt_machine_record()))
      .custom("coordinates",
              true,
              {"five coordinates", list(object(fitted_coordinate_record()), 5).expected.schema},
              read_coordinates,
              [](const BeltsFit& fit) {
                Json all = Json::array();
                for (const AnchorCoordinate& c : fit.coordinates)
                  all.push_back(fitted_coordinate_record().write(c));
                return std::optional<Json>(std::move(all));
              })
      .custom("covariance_mm2",
              true,
              {"five rows of five numbers", list(list(number(kSquare), 5), 5).expected.schema},
              read_covariance,
              written_covariance)
      .required("spread_mm", &BeltsFit::residual_sigma_mm, number(kSigmaMm))
      .required("checks", &BeltsFit::checks, integer(0, 4 * kMostPlaces))
      .required("rms_mm", &BeltsFit::rms_mm, number(kSigmaMm))
      .required(
          "rms_of_mm", &BeltsFit::rms_of_mm, object(per_belt_record<double>(number(kAnyNumber))))
      .custom(
          "foretold",
          true,
          both_predictions_record().expected(),
          [](const Cursor& at, BeltsFit& fit) {
            const auto found = both_predictions_record().read(at);
            if (!found) return;
            fit.one_left_out = found->one_left_out;
            fit.half_left_out = found->half_left_out;
          },
          [](const BeltsFit& fit) {
            return std::optional<Json>(
                both_predictions_record().write({fit.one_left_out, fit.half_left_out}));
          })
      .optional("scale", &BeltsFit::scale, object(scale_record()))
      .sparse("causes", &BeltsFit::causes, list(object(cause_in_fit_record())))
      .sparse("bad", &BeltsFit::bad, list(object(bad_record())))
      .custom(
          "bad_points",
          false,
          {"a list of points", list(integer(0, kMostPlaces)).expected.schema},
          [](const Cursor& at, BeltsFit& fit) {
            const auto found = list(integer(0, kMostPlaces)).read(at);
            if (found) fit.bad_points.assign(found->begin(), found->end());
          },
          [](const BeltsFit& fit) {
            return fit.bad_points.empty() ? std::nullopt : std::optional<Json>(fit.bad_points);
          })
      .required("places", &BeltsFit::places, list(object(fitted_place_record())));
}

const Record<BeltsFit>& fit_record() {
  static const auto record = [] {
    Record<BeltsFit> fit("a fit of four belts");
    add_fit(fit);
    return fit;
  }();
  return record;
}

const Record<FittedAnchors>& fitted_anchors_record() {
  static const auto record = [] {
    Record<FittedAnchors> anchors("a chaintrue_anchors file", kAnchorsFormat);
    anchors.sparse("name", &FittedAnchors::name, text())
        .required("fit", &FittedAnchors::fit, object(fit_record()))
        .optional("holes", &FittedAnchors::holes, object(holes_with_belts_record()));
    add_content_hash(add_made_by_key(anchors)).check([](const Cursor& at, FittedAnchors&) {
      if (at.clean()) check_content(at);
    });
    return anchors;
  }();
  return record;
}

}  // namespace

Json anchors_schema() { return fitted_anchors_record().schema(); }

FittedAnchors parse_anchors(const std::string& text, const std::string& file) {
  return read_document(fitted_anchors_record(), text, file);
}

std::string write_anchors(const FittedAnchors& anchors, const std::optional<Provenance>& made_by) {
  return print_with_hash(with_made_by(fitted_anchors_record().write(anchors), made_by));
}

}  // namespace chaintrue::grid::files
