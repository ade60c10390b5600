// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/anchors_file.hpp"

#include <fmt/format.h>

#include "grid/belts/belt_holes.hpp"
#include "grid/containers.hpp"
#include "grid/files/belts_record.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/schemas.hpp"
#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::files {
namespace {

// The part of a chaintrue_anchors file for holes that were fitted together with the belts. Private
// to grid/files.

using model::SheetPlacement;

constexpr Range kPositiveMm{"mm", 1e-9, 1e6};
constexpr Range kFactor{"", 1e-3, 1e3};
constexpr Range kAngle{"rad", -1.0, 1.0};
constexpr int kMostSets = 1000;

Record<BeltHole> belt_hole_record() {
  Record<BeltHole> hole("a fitted hole");
  hole.required("name", "Its name.", &BeltHole::name);
  const auto coordinate = [&](const char* key, const char* meaning, auto member) {
    hole.required(key, meaning, member, kMillimetres);
  };
  using model::BedPoint, model::MarkPoint;
  coordinate("x_mm", "Commanded x.", path(&BeltHole::commanded, &BedPoint::x_mm));
  coordinate("y_mm", "Commanded y, up.", path(&BeltHole::commanded, &BedPoint::y_mm));
  coordinate("mark_x_mm",
             "x from the fitted anchors, in the frame of the commands; the sheet may be elsewhere.",
             path(&BeltHole::mark, &MarkPoint::x_mm));
  coordinate(
      "mark_y_mm", "y from the fitted anchors, up.", path(&BeltHole::mark, &MarkPoint::y_mm));
  return hole;
}

Record<BeltTapedDistance> taped_distance_record() {
  return Record<BeltTapedDistance>("a fitted distance")
      .required("set",
                "Number of the file of holes, from 0.",
                &BeltTapedDistance::set,
                index_number(0, kMostSets))
      .required("between", "Its ends.", &BeltTapedDistance::words)
      .required("measured_mm",
                "Taped distance, without the hook offset.",
                &BeltTapedDistance::measured_mm,
                kMillimetres)
      .required("off_mm", "Taped minus fitted.", &BeltTapedDistance::residual_mm, kMillimetres)
      .required("left_out_mm",
                "Taped minus the prediction of a fit without it.",
                &BeltTapedDistance::left_out_mm,
                kMillimetres)
      .required("left_out_sigma_mm",
                "Uncertainty of that, 1 sigma.",
                &BeltTapedDistance::left_out_sigma_mm,
                kSigmaMm)
      .required(
          "set_aside", "It contradicts the others and was not used.", &BeltTapedDistance::rejected);
}

struct StatedDisplacement {
  double size_mm = 0.0;
  double reach_mm = 1.0;
  std::vector<std::vector<double>> places;
};

/// x, y, and the tool's offset in x and y.
constexpr std::size_t kNumbersOfAPlace = 4;

Record<StatedDisplacement> displacement_record() {
  return Record<StatedDisplacement>("a displacement of the tool")
      .required(
          "size_mm", "Its prior sigma, on each axis.", &StatedDisplacement::size_mm, kPositiveMm)
      .required(
          "reach_mm", "Length over which it changes.", &StatedDisplacement::reach_mm, kPositiveMm)
      .required("places",
                "For each place x, y, and the displacement of the tool in x and y from the "
                "position given by its upper two belts; mm.",
                &StatedDisplacement::places,
                list(list(kMillimetres, kNumbersOfAPlace), 1))
      .check([](const Cursor& at, StatedDisplacement& stated) {
        for (const auto& place : stated.places) {
          if (place.size() != kNumbersOfAPlace && at.clean())
            at.child("places").expect("four numbers of each place");
        }
      });
}

DisplacementParts displacement_of(const StatedDisplacement& stated) {
  DisplacementParts parts{stated.size_mm, stated.reach_mm, {}, {}};
  parts.at_mm.resize(2 * as_index(stated.places.size()));
  for (const auto& place : stated.places) {
    const auto row = 2 * as_index(parts.places.size());
    parts.places.push_back({place[0], place[1]});
    parts.at_mm.segment<2>(row) << place[2], place[3];
  }
  return parts;
}

StatedDisplacement stated_of(const DisplacementParts& parts) {
  StatedDisplacement stated{parts.size_mm, parts.reach_mm, {}};
  for (std::size_t i = 0; i < parts.places.size(); ++i) {
    const auto row = 2 * as_index(i);
    stated.places.push_back(
        {parts.places[i].x_mm, parts.places[i].y_mm, parts.at_mm[row], parts.at_mm[row + 1]});
  }
  return stated;
}

Record<SheetPlacement> stated_sheet_record() {
  return Record<SheetPlacement>("where the sheet lies")
      .required("x_mm",
                "x of the sheet, to the right of the origin of commands.",
                &SheetPlacement::x_mm,
                kMillimetres)
      .required("y_mm", "y of the sheet, up from there.", &SheetPlacement::y_mm, kMillimetres)
      .required(
          "rotation_rad", "Rotation, counter-clockwise.", &SheetPlacement::rotation_rad, kAngle);
}

void check_together(const Cursor& at, const HolesWithBelts& holes) {
  if (!at.clean()) return;
  constexpr std::size_t kFewestHoles = 3;
  if (holes.holes.size() < kFewestHoles) at.child("holes").expect("three holes at least");
  if (!holes.machine.anchors_known)
    at.child("machine").expect("the anchors in force when the holes were cut");
  const Eigen::Index moved = holes.displacement ? holes.displacement->at_mm.size() : 0;
  const Eigen::Index size = belts::kFrameUnknowns + moved;
  if (holes.covariance.rows() != size || holes.covariance.cols() != size) {
    at.child("covariance")
        .expect(fmt::format("{} rows of as many numbers: six, and two for each place of the "
                            "displacement",
                            size));
  }
}

Record<HolesWithBelts> holes_with_belts_record() {
  return Record<HolesWithBelts>("what holes add to belts")
      .required("machine",
                "The machine, with the anchors in force when the holes were cut.",
                &HolesWithBelts::machine,
                belt_machine_record())
      .required("holes",
                "Holes of the first file, whose sheet defines the frame of the map.",
                &HolesWithBelts::holes,
                list(belt_hole_record()))
      .required("distances",
                "All taped distances.",
                &HolesWithBelts::distances,
                list(taped_distance_record()))
      .required("noise_factor",
                "Estimated noise of tape and holes, relative to the given one.",
                &HolesWithBelts::noise_factor,
                kFactor)
      .required("left_out_rms_mm",
                "Rms of the distances left out one at a time, without those that were rejected.",
                &HolesWithBelts::left_out_rms_mm,
                kSigmaMm)
      .optional(
          "displacement",
          "Displacement of the tool from the position given by its upper two belts; absent: "
          "the holes show none.",
          &HolesWithBelts::displacement,
          converted<DisplacementParts>(object(displacement_record()), displacement_of, stated_of))
      .optional(
          "sheet",
          "From its measured edges; absent: the holes, as a whole, are where they were commanded.",
          &HolesWithBelts::sheet,
          converted<Eigen::Vector3d>(
              object(stated_sheet_record()),
              [](const SheetPlacement& own) {
                return Eigen::Vector3d(own.x_mm, own.y_mm, own.rotation_rad);
              },
              [](const Eigen::Vector3d& own) {
                return SheetPlacement{own.x(), own.y(), own.z()};
              }))
      .required("covariance",
                "Of tl_x, tl_y, tr_x, tr_y, br_x, the logarithm of the scale, and x and y of the "
                "displacement at each of its places.",
                &HolesWithBelts::covariance,
                matrix_of_numbers(kAnyNumber, 0))
      .check([](const Cursor& at, HolesWithBelts& holes) { check_together(at, holes); });
}

using model::Belt;
using model::PerBelt;

constexpr Range kSquare{"mm^2", -1e12, 1e12};
constexpr int kMostPlaces = 100000;

Record<AnchorCoordinate> fitted_coordinate_record() {
  return Record<AnchorCoordinate>("a coordinate of an anchor")
      .required("coordinate",
                "Which coordinate; the bottom left anchor is the origin, and the bottom right "
                "one is on the x axis.",
                &AnchorCoordinate::name,
                one_of({"tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"}))
      .optional("stated_mm",
                "Value in the settings; null if unknown.",
                &AnchorCoordinate::stated_mm,
                kMillimetres)
      .required("fitted_mm", "Fitted value.", &AnchorCoordinate::fitted_mm, kMillimetres)
      .required("sigma_mm", "Its uncertainty, 1 sigma.", &AnchorCoordinate::sigma_mm, kSigmaMm)
      .required("rests_on",
                "Share of its variance from each belt's readings.",
                &AnchorCoordinate::variance_share,
                per_belt_record<double>(number(kAnyNumber)));
}

Record<BadBeltReading> bad_record() {
  return Record<BadBeltReading>("a bad reading")
      .required("point",
                "Number of the place, from 0.",
                &BadBeltReading::point,
                index_number(0, kMostPlaces))
      .required("belt", "The belt.", &BadBeltReading::belt, belt_word())
      .required("off_mm",
                "Reading minus the value predicted from all others.",
                &BadBeltReading::residual_mm,
                kMillimetres);
}

Record<BeltResidual> residual_record() {
  return Record<BeltResidual>("a reading's residual")
      .required("off_mm", "Reading minus fitted value.", &BeltResidual::residual_mm, kMillimetres)
      .required("counts", "False if it was left out.", &BeltResidual::counts)
      .required("sigmas",
                "Distance from a fit without it, in sigmas; 0 if no other reading determines it.",
                &BeltResidual::sigmas,
                kAnyNumber)
      .required("beside_mm",
                "Reading minus the value predicted from all others.",
                &BeltResidual::deleted_residual_mm,
                kMillimetres);
}

Record<FittedPlace> fitted_place_record() {
  Record<FittedPlace> place("a fitted place");
  using model::FramePoint;
  place
      .required("x_mm",
                "x of the tool, to the right of the bottom left anchor.",
                path(&FittedPlace::at, &FramePoint::x_mm),
                kMillimetres)
      .required("y_mm",
                "y of the tool, up from the bottom left anchor.",
                path(&FittedPlace::at, &FramePoint::y_mm),
                kMillimetres);
  place.computed(
      "covariance_mm2",
      "Covariance of x and y: xx, xy, yy.",
      true,
      exactly<3>(number(kSquare), "3 numbers"),
      [](FittedPlace& p, const std::array<double, 3>& c) {
        p.covariance_mm2 << c[0], c[1], c[1], c[2];
      },
      [](const FittedPlace& p) {
        const auto& c = p.covariance_mm2;
        return std::array{c(0, 0), c(0, 1), c(1, 1)};
      });
  for (const Belt belt : model::kBelts) {
    place.computed(
        name(belt),
        fmt::format("Residual of the {} belt.", words(belt)),
        true,
        object(residual_record()),
        [belt](FittedPlace& p, const BeltResidual& own) { p.belts[belt] = own; },
        [belt](const FittedPlace& p) { return p.belts[belt]; });
  }
  return place;
}

using Row = std::array<double, 5>;
using Rows = std::array<Row, 5>;
using RowMajor = Eigen::Matrix<double, 5, 5, Eigen::RowMajor>;

Record<BeltsFit> both_predictions_record() {
  return Record<BeltsFit>("what was predicted")
      .required("one_left_out",
                "Each place predicted from all others.",
                &BeltsFit::one_left_out,
                prediction_record())
      .optional("half_left_out",
                "Each half predicted from the other; null for fewer than "
                "ten places.",
                &BeltsFit::half_left_out,
                prediction_record());
}

/// For the belts' table, with values that it may have.
void check_cause(const Cursor& at, CauseInAnchorFit& cause) {
  const std::vector<model::AppliedEffect> applied = {{cause.effect, cause.side, cause.parameters}};
  for (const model::MachineProblem& problem :
       model::effects::problems_in(model::belts::belt_effects(), applied))
    at.problems().add(at.pointer() + problem.parameter.substr(2), problem);
}

Record<CauseInAnchorFit> cause_in_fit_record() {
  return Record<CauseInAnchorFit>("a cause with the anchors")
      .required("effect", "The cause, by its id in docs/maslow4.md.", &CauseInAnchorFit::effect)
      .sparse("side",
              "The belt, or all four.",
              &CauseInAnchorFit::side,
              one_of({"tl", "tr", "bl", "br", "all"}))
      .required("parameters",
                "Its size and onset, averaged over the models that the readings leave possible.",
                &CauseInAnchorFit::parameters,
                dictionary(number(kAnyNumber)))
      .required("sigma", "Uncertainty of its size, 1 sigma.", &CauseInAnchorFit::sigma, kAnyNumber)
      .required("probability",
                "Its probability under the prior used for sigmas, which assumes causes to be "
                "common; not a verdict.",
                &CauseInAnchorFit::probability,
                kShare)
      .check(check_cause);
}

/// All fields but the name.
void add_fit(Record<BeltsFit>& record) {
  record
      .required("machine",
                "The machine with the anchors fitted.",
                &BeltsFit::machine,
                belt_machine_record())
      .required("coordinates",
                "The five coordinates that belts determine.",
                &BeltsFit::coordinates,
                exactly<5>(object(fitted_coordinate_record()), "five coordinates"))
      .computed(
          "covariance_mm2",
          "Of the five, in their order.",
          true,
          exactly<5>(exactly<5>(number(kSquare), "5 numbers"), "five rows of five numbers"),
          [](BeltsFit& fit, const Rows& rows) {
            fit.covariance_mm2 = Eigen::Map<const RowMajor>(rows.front().data());
          },
          [](const BeltsFit& fit) {
            Rows rows{};
            Eigen::Map<RowMajor>(rows.front().data()) = fit.covariance_mm2;
            return rows;
          })
      .required("spread_mm",
                "Spread of a reading, with 2N - 5 checks in the denominator.",
                &BeltsFit::residual_sigma_mm,
                kSigmaMm)
      .required("checks",
                "Degrees of freedom: that denominator.",
                &BeltsFit::checks,
                integer(0, 4 * kMostPlaces))
      .required("rms_mm",
                "Rms over all readings, rejected ones included, as in the machine's message.",
                &BeltsFit::rms_mm,
                kSigmaMm)
      .required("rms_of_mm",
                "Rms of each belt's readings without the rejected ones.",
                &BeltsFit::rms_of_mm,
                per_belt_record<double>(number(kAnyNumber)))
      .part("foretold",
            "Lower belts predicted from the upper two at places left out of the fit.",
            true,
            both_predictions_record())
      .optional(
          "scale", "From taped distances; absent: not known.", &BeltsFit::scale, scale_record())
      .sparse("causes",
              "Causes besides the anchors: the stretch of the belts, and others that are more "
              "likely than not. Places and residuals are corrected for them.",
              &BeltsFit::causes,
              list(cause_in_fit_record()))
      .sparse("bad", "Readings left out, the worst first.", &BeltsFit::bad, list(bad_record()))
      .sparse("bad_points",
              "Places where fewer than three readings agree.",
              &BeltsFit::bad_points,
              list(index_number(0, kMostPlaces)))
      .required("places", "The fitted places.", &BeltsFit::places, list(fitted_place_record()));
}

Record<BeltsFit> fit_record() {
  Record<BeltsFit> fit("a fit of four belts");
  add_fit(fit);
  return fit;
}

const Record<FittedAnchors>& fitted_anchors_record() {
  static const auto record = [] {
    Record<FittedAnchors> anchors("a chaintrue_anchors file", kAnchorsFormat);
    anchors.sparse("name", "Name of the set.", &FittedAnchors::name)
        .required("fit", "The fit.", &FittedAnchors::fit, fit_record())
        .optional("holes",
                  "Results from cut and taped holes; absent: none were given.",
                  &FittedAnchors::holes,
                  holes_with_belts_record());
    add_content_hash(add_made_by_key(anchors),
                     "Hash of everything else; edited anchors are refused.")
        .check([](const Cursor& at, FittedAnchors&) {
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
