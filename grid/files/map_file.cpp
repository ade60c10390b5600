// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/content_hash.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/map_surface_record.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/schemas.hpp"
#include "grid/files/whole_file.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kErrorMm{"mm", -1e5, 1e5};
constexpr Range kSigmaFactor{"", 1.0, 1e6};

const Record<model::MarkPoint>& mark_record() {
  static const auto record = Record<model::MarkPoint>("a point")
                                 .required("x_mm", &model::MarkPoint::x_mm, number(kPlaceMm))
                                 .required("y_mm", &model::MarkPoint::y_mm, number(kPlaceMm));
  return record;
}

const Record<OutsideRule>& outside_record() {
  static const auto record =
      Record<OutsideRule>("what the map does beyond its points")
          .required("way",
                    &OutsideRule::way,
                    choice<Outside>({{"continued", Outside::continued},
                                     {"refuse", Outside::refuse},
                                     {"fade", Outside::fade},
                                     {"linear", Outside::linear},
                                     {"clamp", Outside::clamp}}))
          .optional("fade_width_mm", &OutsideRule::fade_width_mm, number(kFadeWidthMm));
  return record;
}

Value<NoiseSource> noise_source() {
  std::vector<std::pair<std::string, NoiseSource>> names;
  for (const NoiseSource source :
       {NoiseSource::stated, NoiseSource::repeats, NoiseSource::fit, NoiseSource::assumed}) {
    names.emplace_back(name(source), source);
  }
  return choice<NoiseSource>(std::move(names));
}

const Record<MapNoise>& map_noise_record() {
  static const auto record =
      Record<MapNoise>("the noise that the fit went by")
          .required("length_mm", &MapNoise::length_mm, number(kNotNegative))
          .required("position_mm", &MapNoise::position_mm, number(kNotNegative))
          .required("source", &MapNoise::source, noise_source())
          .required("factor_found", &MapNoise::factor_found, number(kNotNegative));
  return record;
}

const Record<HeldOutError>& held_out_record() {
  static const auto record =
      Record<HeldOutError>("errors of points left out")
          .required("chain", &HeldOutError::chain, object(error_summary_record()))
          .required("tool", &HeldOutError::tool, object(error_summary_record()))
          .required("tool_x_rms_mm", &HeldOutError::tool_x_rms_mm, number(kNotNegative))
          .required("tool_y_rms_mm", &HeldOutError::tool_y_rms_mm, number(kNotNegative));
  return record;
}

constexpr const char* kRelativeTo =
    "leave_one_out and blocked: relative to the readings, whose noise they contain; expected_tool: "
    "one sigma, relative "
    "to the true machine";

const Record<MapAccuracy>& accuracy_record() {
  static const auto record =
      Record<MapAccuracy>("the map's own error")
          .constant("relative_to", kRelativeTo)
          .required("leave_one_out", &MapAccuracy::leave_one_out, object(held_out_record()))
          .required("blocked", &MapAccuracy::blocked, object(held_out_record()))
          .required("expected_tool", &MapAccuracy::expected_tool, object(error_summary_record()))
          .required("expected_worst_at", &MapAccuracy::expected_worst_at, object(mark_record()));
  return record;
}

const Record<SettingResult>& setting_record() {
  static const auto record =
      Record<SettingResult>("a setting")
          .required("setting", &SettingResult::setting, setting_word())
          .required("stated", &SettingResult::stated, number(kAnyNumber))
          .required("calibrated", &SettingResult::calibrated, number(kAnyNumber))
          .required("sigma", &SettingResult::sigma, number(kNotNegative))
          .required("off", &SettingResult::off, boolean());
  return record;
}

const Record<MapPoint>& map_point_record() {
  using model::ChainLengths;
  using model::MarkPoint;
  static const auto record =
      Record<MapPoint>("a measured point")
          .required("x_mm", path(&MapPoint::mark, &MarkPoint::x_mm), number(kPlaceMm))
          .required("y_mm", path(&MapPoint::mark, &MarkPoint::y_mm), number(kPlaceMm))
          .required("left_mm", path(&MapPoint::lengths, &ChainLengths::left_mm), number(kPlaceMm))
          .required("right_mm", path(&MapPoint::lengths, &ChainLengths::right_mm), number(kPlaceMm))
          .required("bad", &MapPoint::bad, boolean())
          .required("distance_sigmas", &MapPoint::distance_sigmas, number(kNotNegative))
          .required("as_stated_mm", &MapPoint::as_stated_mm, pair_of_numbers(kErrorMm))
          .required("sheet_placed_mm", &MapPoint::sheet_placed_mm, pair_of_numbers(kErrorMm))
          .required("mapped_mm", &MapPoint::mapped_mm, pair_of_numbers(kErrorMm))
          .required("left_out_mm", &MapPoint::left_out_mm, pair_of_numbers(kErrorMm));
  return record;
}

const Record<MirrorTest>& mirror_record() {
  static const auto record =
      Record<MirrorTest>("the mirror claim")
          .required("points", &MirrorTest::points, index_number())
          .required("difference", &MirrorTest::difference, object(error_summary_record()))
          .required("mean_mm", &MirrorTest::mean_mm, number(kErrorMm))
          .required("worst_at", &MirrorTest::worst_at, object(mark_record()))
          .required("worst_signed_mm", &MirrorTest::worst_signed_mm, number(kErrorMm))
          .required("holds", &MirrorTest::holds, boolean())
          .required("sentence", &MirrorTest::sentence, text());
  return record;
}

const Record<DistancesUsed>& distances_record() {
  constexpr int kMost = 1000000;
  static const auto record =
      Record<DistancesUsed>("the distances between holes")
          .required("used", &DistancesUsed::used, integer(0, kMost))
          .required("set_aside", &DistancesUsed::rejected, integer(0, kMost))
          .required("tape_sigma_mm", &DistancesUsed::tape_sigma_mm, number(kNotNegative))
          .required("left_out_all", &DistancesUsed::left_out_all, object(error_summary_record()))
          .required("left_out_good", &DistancesUsed::left_out_good, object(error_summary_record()));
  return record;
}

void check_map(const Cursor& at, MapContents& map) {
  const auto stands = [&at](std::string_view key) { return !at.child(key).json().is_null(); };
  if (stands("on_machine") == stands("direct")) {
    at.expect("either \"on_machine\" or \"direct\", the two kinds of surface, and not both");
  }
  if (stands("direct") && map.outside.way == Outside::fade) {
    at.child("outside").child("way").expect(
        "another way: without a machine nothing is left where a surface fades out");
  }
  if (!at.clean()) return;
  check_content(at);
  try {
    const MeasuredArea area(map.hull, map.edge_mm, map.domain);
  } catch (const std::invalid_argument&) {
    at.child("hull").expect("the corners of an area, counter-clockwise");
  }
}

/// One of the two kinds of surface: `Surface` in memory, `Part` in the file.
template <class Surface, class Part>
void add_surface(Record<MapContents>& record, const std::string& key, const Record<Part>& part) {
  record.custom(
      key,
      false,
      part.expected(),
      [&part](const Cursor& at, MapContents& map) {
        const auto read = part.read(at);
        if (read && at.clean()) map.surface = surface_of(*read);
      },
      [&part](const MapContents& map) -> std::optional<Json> {
        const auto* surface = std::get_if<Surface>(&map.surface);
        if (surface == nullptr) return std::nullopt;
        return part.write(part_of(*surface));
      });
}

/// Written only if it differs from the default.
std::optional<Json> write_outside(const MapContents& map) {
  if (map.outside.way == OutsideRule{}.way) return std::nullopt;
  return outside_record().write(map.outside);
}

Record<MapContents> make_map_record() {
  Record<MapContents> record("a chaintrue_map file", kMapFormat);
  record.optional("name", &MapContents::name, text());
  add_surface<ModelSurface>(record, "on_machine", model_part_record());
  add_surface<DirectSurface>(record, "direct", direct_part_record());
  record.required("domain_mm", &MapContents::domain, object(rectangle_record()))
      .required("hull", &MapContents::hull, list(object(mark_record()), 3))
      .required("edge_mm", &MapContents::edge_mm, number(kNotNegative))
      .custom(
          "outside",
          false,
          outside_record().expected(),
          [](const Cursor& at, MapContents& map) {
            if (const auto rule = outside_record().read(at)) map.outside = *rule;
          },
          write_outside)
      .custom(
          "sigma_factor_beyond",
          false,
          number(kSigmaFactor).expected,
          [](const Cursor& at, MapContents& map) {
            if (const auto factor = number(kSigmaFactor).read(at))
              map.sigma_factor_beyond = *factor;
          },
          [](const MapContents& map) -> std::optional<Json> {
            if (map.sigma_factor_beyond == MapContents{}.sigma_factor_beyond) return std::nullopt;
            return map.sigma_factor_beyond;
          })
      .required("noise", &MapContents::noise, object(map_noise_record()))
      .required("accuracy", &MapContents::accuracy, object(accuracy_record()))
      .required("settings", &MapContents::settings, list(object(setting_record())))
      .required("points", &MapContents::points, list(object(map_point_record())))
      .optional("mirror", &MapContents::mirror, object(mirror_record()))
      .optional("distances", &MapContents::distances, object(distances_record()))
      .required("notes", &MapContents::notes, list(text()));
  add_content_hash(add_made_by_key(record))
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

CompensationMap read_map(const std::filesystem::path& path) {
  return parse_map(read_whole_file(path), name_in_messages(path));
}

std::string write_map(const CompensationMap& map, const std::optional<Provenance>& made_by) {
  return print_with_hash(with_made_by(map_record().write(map.contents()), made_by));
}

Json map_schema() { return map_record().schema(); }

}  // namespace chaintrue::grid::files
