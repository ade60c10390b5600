// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a chaintrue_anchors file for holes that were fitted together with the belts.

#include <fmt/format.h>

#include "grid/belts/belt_holes.hpp"
#include "grid/containers.hpp"
#include "grid/files/belts_record.hpp"
#include "grid/files/record_values.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kPositiveMm{"mm", 1e-9, 1e6};
constexpr Range kFactor{"", 1e-3, 1e3};
constexpr Range kAngle{"rad", -1.0, 1.0};
constexpr int kMostSets = 1000;

RECORD_OF(BeltHole, "a fitted hole")
REQUIRED(name, "Its name.")
FIELD(place, &BeltHole::commanded, "Commanded x.", "Commanded y, up.", kMillimetres)
NESTED(required, "mark_x_mm", mark, x_mm,
       "x from the fitted anchors, in the frame of the commands; the sheet may be elsewhere.",
       kMillimetres)
NESTED(required, "mark_y_mm", mark, y_mm, "y from the fitted anchors, up.", kMillimetres)
END_RECORD;

RECORD_OF(BeltTapedDistance, "a fitted distance")
REQUIRED(set, "Number of the file of holes, from 0.", index_number(0, kMostSets))
NAMED(required, "between", words, "Its ends.")
REQUIRED(measured_mm, "Taped distance, without the hook offset.", kMillimetres)
NAMED(required, "off_mm", residual_mm, "Taped minus fitted.", kMillimetres)
REQUIRED(left_out_mm, "Taped minus the prediction of a fit without it.", kMillimetres)
REQUIRED(left_out_sigma_mm, "Uncertainty of that, 1 sigma.", kSigmaMm)
NAMED(required, "set_aside", rejected, "It contradicts the others and was not used.")
END_RECORD;

/// x, y, and the tool's offset in x and y.
using MovedPlace = std::array<double, 4>;

void take_moved_places(DisplacementParts& parts, const std::vector<MovedPlace>& places) {
  parts.at_mm.resize(2 * as_index(places.size()));
  for (const auto& [x, y, offset_x, offset_y] : places) {
    parts.at_mm.segment<2>(2 * as_index(parts.places.size())) << offset_x, offset_y;
    parts.places.push_back({x, y});
  }
}

std::optional<std::vector<MovedPlace>> moved_places(const DisplacementParts& parts) {
  std::vector<MovedPlace> places;
  for (const MarkPoint& at : parts.places) {
    const auto row = 2 * as_index(places.size());
    places.push_back({at.x_mm, at.y_mm, parts.at_mm[row], parts.at_mm[row + 1]});
  }
  return places;
}

RECORD_OF(DisplacementParts, "a displacement of the tool")
REQUIRED(size_mm, "Its prior sigma, on each axis.", kPositiveMm)
REQUIRED(reach_mm, "Length over which it changes.", kPositiveMm)
FIELD(computed, "places",
      "For each place x, y, and the displacement of the tool in x and y from the "
      "position given by its upper two belts; mm.",
      true, list(exactly<4>(number(kMillimetres), "four numbers of each place"), 1),
      take_moved_places, moved_places)
END_RECORD;

auto stated_sheet_record() {
  RECORD(SheetPlacement, "where the sheet lies")
  FIELD(place, "x of the sheet, to the right of the origin of commands.",
        "y of the sheet, up from there.", kMillimetres)
  REQUIRED(rotation_rad, "Rotation, counter-clockwise.", kAngle);
}

void check_together(const Cursor& at, const HolesWithBelts& holes) {
  if (!at.clean()) return;
  constexpr std::size_t kFewestHoles = 3;
  if (holes.holes.size() < kFewestHoles) at.child("holes").expect("three holes at least");
  if (!holes.machine.anchors_known)
    at.child("machine").expect("the anchors in force when the holes were cut");
  const Index moved = holes.displacement ? holes.displacement->at_mm.size() : 0;
  const Index size = belts::kFrameUnknowns + moved;
  if (holes.covariance.rows() != size || holes.covariance.cols() != size) {
    at.child("covariance")
        .expect(fmt::format("{} rows of as many numbers: six, and two for each place of the "
                            "displacement",
                            size));
  }
}

}  // namespace

RECORD_OF(HolesWithBelts, "what holes add to belts")
REQUIRED(machine, "The machine, with the anchors in force when the holes were cut.",
         belt_machine_record())
REQUIRED(holes, "Holes of the first file, whose sheet defines the frame of the map.")
REQUIRED(distances, "All taped distances.")
REQUIRED(noise_factor, "Estimated noise of tape and holes, relative to the given one.", kFactor)
REQUIRED(left_out_rms_mm,
         "Rms of the distances left out one at a time, without those that were rejected.", kSigmaMm)
OPTIONAL(displacement,
         "Displacement of the tool from the position given by its upper two belts; absent: "
         "the holes show none.")
OPTIONAL(sheet,
         "From its measured edges; absent: the holes, as a whole, are where they were commanded.",
         converted<Vector3d>(
             object(stated_sheet_record()),
             [](const SheetPlacement& own) {
               return Vector3d(own.x_mm, own.y_mm, own.rotation_rad);
             },
             [](const Vector3d& own) {
               return SheetPlacement{own.x(), own.y(), own.z()};
             }))
REQUIRED(covariance,
         "Of tl_x, tl_y, tr_x, tr_y, br_x, the logarithm of the scale, and x and y of the "
         "displacement at each of its places.",
         matrix_of_numbers(kAnyNumber, 0))
    .check(check_together) END_RECORD;

}  // namespace chaintrue::grid::files
