// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/map_surface_record.hpp"
#include "grid/files/names.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/schemas.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kErrorMm{"mm", -1e5, 1e5};
constexpr Range kSigmaFactor{"", 1.0, 1e6};

auto mark_record() {
  return Record<model::MarkPoint>("a point").place(
      "x of the tool. Null in a list that is not filled in yet.",
      "y of the tool, up. Null in a list that is not filled in yet.",
      kPlaceMm);
}

auto outside_record() {
  return Record<OutsideRule>("behaviour outside the measured part")
      .required(
          "way", "Behaviour outside the measured part.", &OutsideRule::way, choice(kOutsideWays))
      .optional("fade_width_mm",
                "For fade: distance over which the correction goes to zero.",
                &OutsideRule::fade_width_mm,
                kFadeWidthMm);
}

auto map_noise_record() {
  return Record<MapNoise>("the noise used by the fit")
      .required(
          "length_mm", "Noise of a chain reading, 1 sigma.", &MapNoise::length_mm, kNotNegative)
      .required("position_mm",
                "Noise of a position, 1 sigma on each axis.",
                &MapNoise::position_mm,
                kNotNegative)
      .required(
          "source", "Where it comes from.", &MapNoise::source, by_name_to(NoiseSource::assumed))
      .required("factor_found",
                "Scatter of the points relative to this noise.",
                &MapNoise::factor_found,
                kNotNegative);
}

auto held_out_record() {
  return Record<HeldOutError>("errors of points left out")
      .required("chain", "In a chain's length.", &HeldOutError::chain, error_summary_record())
      .required("tool", "At the tool.", &HeldOutError::tool, error_summary_record())
      .required("tool_x_rms_mm", "At the tool, in x.", &HeldOutError::tool_x_rms_mm, kNotNegative)
      .required("tool_y_rms_mm", "At the tool, in y.", &HeldOutError::tool_y_rms_mm, kNotNegative);
}

constexpr const char* kRelativeTo =
    "leave_one_out and blocked: relative to the readings, whose noise they contain; expected_tool: "
    "one sigma, relative "
    "to the true machine";

auto accuracy_record() {
  return Record<MapAccuracy>("the map's own error")
      .constant("relative_to", "What the errors are relative to.", kRelativeTo)
      .required("leave_one_out",
                "Errors of points predicted by a map without them, one at a time.",
                &MapAccuracy::leave_one_out,
                held_out_record())
      .required("blocked",
                "The same with a block of the bed left out at a time.",
                &MapAccuracy::blocked,
                held_out_record())
      .required("expected_tool",
                "Expected error of the tool over the measured part.",
                &MapAccuracy::expected_tool,
                error_summary_record())
      .required("expected_worst_at",
                "Where it is largest.",
                &MapAccuracy::expected_worst_at,
                mark_record());
}

auto setting_record() {
  return Record<SettingResult>("a setting")
      .required("setting", "Name of the setting.", &SettingResult::setting, setting_word())
      .required("stated", "Value in the machine file.", &SettingResult::stated, kAnyNumber)
      .required("calibrated", "Calibrated value.", &SettingResult::calibrated, kAnyNumber)
      .required("sigma",
                "Uncertainty of the calibrated value, 1 sigma.",
                &SettingResult::sigma,
                kNotNegative)
      .required(
          "off", "True if it differs by more than its uncertainty allows.", &SettingResult::off);
}

auto map_point_record() {
  const auto pair = pair_of_numbers(kErrorMm);
  return Record<MapPoint>("a measured point")
      .place(&MapPoint::mark,
             "x, to the right of the bed's middle, or of the marks' origin.",
             "y, up from the bed's middle, or from the marks' origin.",
             kPlaceMm)
      .required("left_mm",
                "The left chain.",
                path(&MapPoint::lengths, &model::ChainLengths::left_mm),
                kPlaceMm)
      .required("right_mm",
                "The right chain.",
                path(&MapPoint::lengths, &model::ChainLengths::right_mm),
                kPlaceMm)
      .required("bad", "True if the fit left it out.", &MapPoint::bad)
      .required("distance_sigmas",
                "Its distance from the prediction of the others, in sigmas.",
                &MapPoint::distance_sigmas,
                kNotNegative)
      .required("as_stated_mm",
                "Measured position minus that of the machine file.",
                &MapPoint::as_stated_mm,
                pair)
      .required("sheet_placed_mm",
                "The same after the best placement of the sheet.",
                &MapPoint::sheet_placed_mm,
                pair)
      .required("mapped_mm", "The same with the map.", &MapPoint::mapped_mm, pair)
      .required(
          "left_out_mm", "The same with a map made without it.", &MapPoint::left_out_mm, pair);
}

auto mirror_record() {
  return Record<MirrorTest>("comparison of mirrored chains")
      .required("points", "Number of points whose mirror image was measured.", &MirrorTest::points)
      .required("difference",
                "Right chain minus left chain at the mirrored place.",
                &MirrorTest::difference,
                error_summary_record())
      .required("mean_mm", "Mean difference.", &MirrorTest::mean_mm, kErrorMm)
      .required(
          "worst_at", "Where the difference is largest.", &MirrorTest::worst_at, mark_record())
      .required("worst_signed_mm", "The difference there.", &MirrorTest::worst_signed_mm, kErrorMm)
      .required("holds", "True if noise alone explains the difference.", &MirrorTest::holds)
      .required("sentence", "The same in words.", &MirrorTest::sentence);
}

auto distances_record() {
  const auto count = integer(0, kMostNumbered);
  return Record<DistancesUsed>("the distances between holes")
      .required("used", "Number of distances used.", &DistancesUsed::used, count)
      .required("set_aside", "Number of distances left out.", &DistancesUsed::rejected, count)
      .required("tape_sigma_mm",
                "Noise of the tape in the fit, 1 sigma.",
                &DistancesUsed::tape_sigma_mm,
                kNotNegative)
      .required("left_out_all",
                "Errors of distances predicted by a map without them.",
                &DistancesUsed::left_out_all,
                error_summary_record())
      .required("left_out_good",
                "The same without the rejected distances.",
                &DistancesUsed::left_out_good,
                error_summary_record());
}

void check_map(const Cursor& at, MapContents& map) {
  const auto stands = [&at](std::string_view key) { return !at.child(key).json().is_null(); };
  if (stands("on_machine") == stands("direct")) {
    at.expect("either \"on_machine\" or \"direct\", the two kinds of surface, and not both");
  }
  if (stands("direct") && map.outside.way == Outside::fade) {
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

auto make_map_record() {
  Record<MapContents> record("a chaintrue_map file", kMapFormat);
  record.optional("name", "Name of the grid.", &MapContents::name);
  add_surface(record);
  record
      .required(
          "domain_mm", "Where the map can be evaluated.", &MapContents::domain, rectangle_record())
      .required("hull",
                "Corners of the measured part, counter-clockwise.",
                &MapContents::hull,
                list(mark_record(), 3))
      .required("edge_mm",
                "Places closer to the hull than this count as on its edge.",
                &MapContents::edge_mm,
                kNotNegative)
      .sparse("outside", "Behaviour outside the hull.", &MapContents::outside, outside_record())
      .sparse("sigma_factor_beyond",
              "Factor on sigmas outside the measured part if causes were found, so that the larger "
              "error "
              "of the plain map applies there.",
              &MapContents::sigma_factor_beyond,
              kSigmaFactor)
      .required("noise", "The noise used by the fit.", &MapContents::noise, map_noise_record())
      .required("accuracy", "The map's own error.", &MapContents::accuracy, accuracy_record())
      .required("settings",
                "The machine's numbers, as in its file and calibrated.",
                &MapContents::settings,
                setting_record())
      .required("points",
                "The points that the map was made from.",
                &MapContents::points,
                map_point_record())
      .optional("mirror",
                "Whether one chain's surface is the other's, mirrored.",
                &MapContents::mirror,
                mirror_record())
      .optional("distances",
                "For a map from holes and a tape.",
                &MapContents::distances,
                distances_record())
      .required("notes", "Notes for the reader, in sentences.", &MapContents::notes);
  add_content_hash(add_made_by_key(record), "Hash of everything else; an edited map is refused.")
      .schema_also({{"oneOf", {{{"required", {"on_machine"}}}, {{"required", {"direct"}}}}}})
      .check(check_map);
  return record;
}

const Record<MapContents>& map_record() {
  static const Record<MapContents> record = make_map_record();
  return record;
}

}  // namespace

CompensationMap parse_map(const std::string& text, const std::string& file) {
  return CompensationMap(read_document(map_record(), text, file));
}

std::string write_map(const CompensationMap& map, const std::optional<Provenance>& made_by) {
  return print_with_hash(with_made_by(map_record().write(map.contents()), made_by));
}

Json map_schema() { return map_record().schema(); }

}  // namespace chaintrue::grid::files
