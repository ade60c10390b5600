// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/map_file.hpp"

#include "grid/files/names.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kErrorMm{"mm", -1e5, 1e5};
constexpr Range kSigmaFactor{"", 1.0, 1e6};

RECORD_OF(MarkPoint, "a point")
FIELD(place, "x of the tool. Null in a list that is not filled in yet.",
      "y of the tool, up. Null in a list that is not filled in yet.", kPlaceMm)
END_RECORD;

RECORD_OF(OutsideRule, "behaviour outside the measured part")
REQUIRED(way, "Behaviour outside the measured part.", in_order<Outside>(kOutsideWays))
OPTIONAL(fade_width_mm, "For fade: distance over which the correction goes to zero.", kFadeWidthMm)
END_RECORD;

RECORD_OF(MapNoise, "the noise used by the fit")
REQUIRED(length_mm, "Noise of a chain reading, 1 sigma.", kNotNegative)
REQUIRED(position_mm, "Noise of a position, 1 sigma on each axis.", kNotNegative)
REQUIRED(source, "Where it comes from.", by_name_to(NoiseSource::assumed))
REQUIRED(factor_found, "Scatter of the points relative to this noise.", kNotNegative)
END_RECORD;

RECORD_OF(HeldOutError, "errors of points left out")
REQUIRED(chain, "In a chain's length.")
REQUIRED(tool, "At the tool.")
REQUIRED(tool_x_rms_mm, "At the tool, in x.", kNotNegative)
REQUIRED(tool_y_rms_mm, "At the tool, in y.", kNotNegative)
END_RECORD;

constexpr const char* kRelativeTo =
    "leave_one_out and blocked: relative to the readings, whose noise they contain; expected_tool: "
    "one sigma, relative "
    "to the true machine";

RECORD_OF(MapAccuracy, "the map's own error")
FIELD(constant, "relative_to", "What the errors are relative to.", kRelativeTo)
REQUIRED(leave_one_out, "Errors of points predicted by a map without them, one at a time.")
REQUIRED(blocked, "The same with a block of the bed left out at a time.")
REQUIRED(expected_tool, "Expected error of the tool over the measured part.")
REQUIRED(expected_worst_at, "Where it is largest.")
END_RECORD;

auto map_point_record() {
  const auto pair = pair_of_numbers(kErrorMm);
  RECORD(MapPoint, "a measured point")
  FIELD(place, &MapPoint::mark, "x, to the right of the bed's middle, or of the marks' origin.",
        "y, up from the bed's middle, or from the marks' origin.", kPlaceMm)
  NESTED(required, "left_mm", lengths, left_mm, "The left chain.", kPlaceMm)
  NESTED(required, "right_mm", lengths, right_mm, "The right chain.", kPlaceMm)
  REQUIRED(bad, "True if the fit left it out.")
  REQUIRED(distance_sigmas, "Its distance from the prediction of the others, in sigmas.",
           kNotNegative)
  REQUIRED(as_stated_mm, "Measured position minus that of the machine file.", pair)
  REQUIRED(sheet_placed_mm, "The same after the best placement of the sheet.", pair)
  REQUIRED(mapped_mm, "The same with the map.", pair)
  REQUIRED(left_out_mm, "The same with a map made without it.", pair);
}

RECORD_OF(MirrorTest, "comparison of mirrored chains")
REQUIRED(points, "Number of points whose mirror image was measured.")
REQUIRED(difference, "Right chain minus left chain at the mirrored place.")
REQUIRED(mean_mm, "Mean difference.", kErrorMm)
REQUIRED(worst_at, "Where the difference is largest.")
REQUIRED(worst_signed_mm, "The difference there.", kErrorMm)
REQUIRED(holds, "True if noise alone explains the difference.")
REQUIRED(sentence, "The same in words.")
END_RECORD;

auto distances_record() {
  const auto count = integer(0, kMostNumbered);
  RECORD(DistancesUsed, "the distances between holes")
  REQUIRED(used, "Number of distances used.", count)
  NAMED(required, "set_aside", rejected, "Number of distances left out.", count)
  REQUIRED(tape_sigma_mm, "Noise of the tape in the fit, 1 sigma.", kNotNegative)
  REQUIRED(left_out_all, "Errors of distances predicted by a map without them.")
  REQUIRED(left_out_good, "The same without the rejected distances.");
}

void check_map(const Cursor& at, MapContents& map) {
  if (at.is_null("on_machine") == at.is_null("direct")) {
    at.expect("either \"on_machine\" or \"direct\", the two kinds of surface, and not both");
  }
  if (!at.is_null("direct") && map.outside.way == Outside::fade) {
    at.child("outside").child("way").expect(
        "a different value: without a machine there is no value where a surface fades out");
  }
  if (!at.clean()) return;
  check_content(at);
  try {
    const MeasuredArea area(map.hull, map.edge_mm, map.domain);
  } catch (const std::invalid_argument&) {
    at.child("hull").expect("the corners of an area, counter-clockwise");
  }
}

}  // namespace

FILE_RECORD(map, MapContents, "a chaintrue_map file", kMapFormat)
OPTIONAL(name, "Name of the grid.")
ALSO(add_surface)
NAMED(required, "domain_mm", domain, "Where the map can be evaluated.")
REQUIRED(hull, "Corners of the measured part, counter-clockwise.",
         list(record_of(Of<MarkPoint>()), 3))
REQUIRED(edge_mm, "Places closer to the hull than this count as on its edge.", kNotNegative)
SPARSE(outside, "Behaviour outside the hull.")
SPARSE(sigma_factor_beyond,
       "Factor on sigmas outside the measured part if causes were found, so that the larger "
       "error "
       "of the plain map applies there.",
       kSigmaFactor)
REQUIRED(noise, "The noise used by the fit.")
REQUIRED(accuracy, "The map's own error.")
REQUIRED(settings, "The machine's numbers, as in its file and calibrated.", setting_record())
REQUIRED(points, "The points that the map was made from.", map_point_record())
OPTIONAL(mirror, "Whether one chain's surface is the other's, mirrored.")
OPTIONAL(distances, "For a map from holes and a tape.", distances_record())
REQUIRED(notes, "Notes for the reader, in sentences.")
ALSO(add_made_by_key)
ALSO(add_content_hash, "Hash of everything else; an edited map is refused.")
    .schema_also({{"oneOf", {{{"required", {"on_machine"}}}, {{"required", {"direct"}}}}}})
    .check(check_map) END_FILE_RECORD;

Record<SettingResult> setting_record() {
  RECORD(SettingResult, "a setting")
  REQUIRED(setting, "Name of the setting.", setting_word())
  REQUIRED(stated, "Value in the machine file.")
  REQUIRED(calibrated, "Calibrated value.")
  REQUIRED(sigma, "Uncertainty of the calibrated value, 1 sigma.", kNotNegative)
  REQUIRED(off, "True if it differs by more than its uncertainty allows.");
}

CompensationMap parse_map(const std::string& text, const std::string& file) {
  return CompensationMap(read_document(map_record(), text, file));
}

std::string write_map(const CompensationMap& map, const std::optional<Provenance>& made_by) {
  return print_with_hash(with_made_by(map_record().write(map.contents()), made_by));
}

}  // namespace chaintrue::grid::files
