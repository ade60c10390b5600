// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/anchors_file.hpp"

#include <fmt/format.h>

#include "grid/files/belts_record.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kSquare{"mm^2", -1e12, 1e12};
constexpr int kMostPlaces = 100000;

auto fitted_coordinate_record() {
  RECORD(AnchorCoordinate, "a coordinate of an anchor")
  NAMED(required, "coordinate", name,
        "Which coordinate; the bottom left anchor is the origin, and the bottom right "
        "one is on the x axis.",
        one_of({"tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"}))
  OPTIONAL(stated_mm, "Value in the settings; null if unknown.", kMillimetres)
  REQUIRED(fitted_mm, "Fitted value.", kMillimetres)
  REQUIRED(sigma_mm, "Its uncertainty, 1 sigma.", kSigmaMm)
  NAMED(required, "rests_on", variance_share, "Share of its variance from each belt's readings.",
        per_belt_record<double>(number(kAnyNumber)));
}

RECORD_OF(BadBeltReading, "a bad reading")
REQUIRED(point, "Number of the place, from 0.", index_number(0, kMostPlaces))
REQUIRED(belt, "The belt.", belt_word())
NAMED(required, "off_mm", residual_mm, "Reading minus the value predicted from all others.",
      kMillimetres)
END_RECORD;

auto residual_record() {
  RECORD(BeltResidual, "a reading's residual")
  NAMED(required, "off_mm", residual_mm, "Reading minus fitted value.", kMillimetres)
  REQUIRED(counts, "False if it was left out.")
  REQUIRED(sigmas,
           "Distance from a fit without it, in sigmas; 0 if no other reading determines it.")
  NAMED(required, "beside_mm", deleted_residual_mm,
        "Reading minus the value predicted from all others.", kMillimetres);
}

void residual_keys(Record<FittedPlace>& place) {
  for (const Belt belt : kBelts) {
    place.computed(
        name(belt), fmt::format("Residual of the {} belt.", words(belt)), true,
        object(residual_record()),
        [belt](FittedPlace& p, const BeltResidual& own) { p.belts[belt] = own; },
        [belt](const FittedPlace& p) { return p.belts[belt]; });
  }
}

RECORD_OF(FittedPlace, "a fitted place")
FIELD(place, &FittedPlace::at, "x of the tool, to the right of the bottom left anchor.",
      "y of the tool, up from the bottom left anchor.", kMillimetres)
FIELD(
    computed, "covariance_mm2", "Covariance of x and y: xx, xy, yy.", true,
    exactly<3>(number(kSquare), "3 numbers"),
    [](FittedPlace& p, const std::array<double, 3>& c) {
      p.covariance_mm2 << c[0], c[1], c[1], c[2];
    },
    [](const FittedPlace& p) {
      const auto& c = p.covariance_mm2;
      return std::array{c(0, 0), c(0, 1), c(1, 1)};
    })
ALSO(residual_keys)
END_RECORD;

using Row = std::array<double, 5>;
using Rows = std::array<Row, 5>;
using RowMajor = Eigen::Matrix<double, 5, 5, Eigen::RowMajor>;

auto both_predictions_record() {
  RECORD(BeltsFit, "what was predicted")
  REQUIRED(one_left_out, "Each place predicted from all others.")
  OPTIONAL(half_left_out,
           "Each half predicted from the other; null for fewer than "
           "ten places.");
}

/// For the belts' table, with values that it may have.
void check_cause(const Cursor& at, CauseInAnchorFit& cause) {
  const std::vector<AppliedEffect> applied = {{cause.effect, cause.side, cause.parameters}};
  for (const MachineProblem& problem :
       model::effects::problems_in(model::belts::belt_effects(), applied))
    at.problems().add(at.pointer() + problem.parameter.substr(2), problem);
}

RECORD_OF(CauseInAnchorFit, "a cause with the anchors")
REQUIRED(effect, "The cause, by its id in docs/maslow4.md.")
SPARSE(side, "The belt, or all four.", one_of({"tl", "tr", "bl", "br", "all"}))
REQUIRED(parameters,
         "Its size and onset, averaged over the models that the readings leave possible.",
         dictionary(number(kAnyNumber)))
REQUIRED(sigma, "Uncertainty of its size, 1 sigma.")
REQUIRED(probability,
         "Its probability under the prior used for sigmas, which assumes causes to be "
         "common; not a verdict.",
         kShare)
    .check(check_cause) END_RECORD;

auto fit_record() {
  RECORD(BeltsFit, "a fit of four belts")
  REQUIRED(machine, "The machine with the anchors fitted.", belt_machine_record())
  REQUIRED(coordinates, "The five coordinates that belts determine.",
           exactly<5>(object(fitted_coordinate_record()), "five coordinates"))
  FIELD(
      computed, "covariance_mm2", "Of the five, in their order.", true,
      exactly<5>(exactly<5>(number(kSquare), "5 numbers"), "five rows of five numbers"),
      [](BeltsFit& fit, const Rows& rows) {
        fit.covariance_mm2 = Eigen::Map<const RowMajor>(rows.front().data());
      },
      [](const BeltsFit& fit) {
        Rows rows{};
        Eigen::Map<RowMajor>(rows.front().data()) = fit.covariance_mm2;
        return rows;
      })
  NAMED(required, "spread_mm", residual_sigma_mm,
        "Spread of a reading, with 2N - 5 checks in the denominator.", kSigmaMm)
  REQUIRED(checks, "Degrees of freedom: that denominator.", integer(0, 4 * kMostPlaces))
  REQUIRED(rms_mm, "Rms over all readings, rejected ones included, as in the machine's message.",
           kSigmaMm)
  REQUIRED(rms_of_mm, "Rms of each belt's readings without the rejected ones.",
           per_belt_record<double>(number(kAnyNumber)))
  FIELD(part, "foretold", "Lower belts predicted from the upper two at places left out of the fit.",
        true, both_predictions_record())
  OPTIONAL(scale, "From taped distances; absent: not known.")
  SPARSE(causes,
         "Causes besides the anchors: the stretch of the belts, and others that are more "
         "likely than not. Places and residuals are corrected for them.")
  SPARSE(bad, "Readings left out, the worst first.")
  SPARSE(bad_points, "Places where fewer than three readings agree.",
         list(index_number(0, kMostPlaces)))
  REQUIRED(places, "The fitted places.");
}

}  // namespace

FILE_RECORD(anchors, FittedAnchors, "a chaintrue_anchors file", kAnchorsFormat)
SPARSE(name, "Name of the set.")
REQUIRED(fit, "The fit.", fit_record())
OPTIONAL(holes, "Results from cut and taped holes; absent: none were given.")
ALSO(add_made_by_key)
ALSO(add_content_hash, "Hash of everything else; edited anchors are refused.")
    .check([](const Cursor& at, FittedAnchors&) {
      if (at.clean()) check_content(at);
    }) END_FILE_RECORD;

FittedAnchors parse_anchors(const std::string& text, const std::string& file) {
  return read_document(anchors_record(), text, file);
}

std::string write_anchors(const FittedAnchors& anchors, const std::optional<Provenance>& made_by) {
  return print_with_hash(with_made_by(anchors_record().write(anchors), made_by));
}

}  // namespace chaintrue::grid::files
