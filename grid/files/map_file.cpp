// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/content_hash.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/map_surface_record.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/whole_file.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kPlaceMm{"mm", -1e5, 1e5};
constexpr Range kErrorMm{"mm", -1e5, 1e5};
constexpr Range kAny{"", -1e12, 1e12};
constexpr Range kPositive{"", 0.0, 1e12};

/// A map as it stands in the file, where that differs from the map in memory.
struct MapPart {
  std::string name;
  std::optional<ModelPart> model;
  std::optional<DirectPart> direct;
  std::vector<model::BedPoint> hull;
  double edge_mm = 0.0;
  interp::Rectangle domain;
  std::optional<OutsideRule> outside;
  MapNoise noise;
  MapAccuracy accuracy;
  std::vector<SettingResult> settings;
  std::vector<MapPoint> points;
  std::optional<MirrorTest> mirror;
  std::optional<DistancesUsed> distances;
  std::vector<std::string> notes;
  std::string content_hash = {};
};

const Record<model::BedPoint>& place_record() {
  static const auto record = Record<model::BedPoint>("a point")
                                 .required("x_mm", &model::BedPoint::x_mm, number(kPlaceMm))
                                 .required("y_mm", &model::BedPoint::y_mm, number(kPlaceMm));
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

const Record<MapNoise>& noise_record() {
  static const auto record =
      Record<MapNoise>("the noise that the fit went by")
          .required("length_mm", &MapNoise::length_mm, number(kPositive))
          .required("position_mm", &MapNoise::position_mm, number(kPositive))
          .required("source", &MapNoise::source, one_of({"stated", "repeats", "fit", "assumed"}))
          .required("factor_found", &MapNoise::factor_found, number(kPositive));
  return record;
}

const Record<ErrorSummary>& summary_record() {
  static const auto record =
      Record<ErrorSummary>("rms and maximum")
          .required("rms_mm", &ErrorSummary::rms_mm, number(kPositive))
          .required("maximum_mm", &ErrorSummary::maximum_mm, number(kPositive));
  return record;
}

const Record<HeldOutError>& held_out_record() {
  static const auto record =
      Record<HeldOutError>("held-out errors")
          .required("chain", &HeldOutError::chain, object(summary_record()))
          .required("tool", &HeldOutError::tool, object(summary_record()))
          .required("tool_x_rms_mm", &HeldOutError::tool_x_rms_mm, number(kPositive))
          .required("tool_y_rms_mm", &HeldOutError::tool_y_rms_mm, number(kPositive));
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
          .required("expected_tool", &MapAccuracy::expected_tool, object(summary_record()))
          .required("expected_worst_at", &MapAccuracy::expected_worst_at, object(place_record()));
  return record;
}

Value<model::Setting> setting_word() {
  std::vector<std::pair<std::string, model::Setting>> names;
  for (auto setting : model::kMachineSettings) names.emplace_back(model::name(setting), setting);
  for (auto setting : model::kSheetSettings) names.emplace_back(model::name(setting), setting);
  return choice<model::Setting>(std::move(names));
}

const Record<SettingResult>& setting_record() {
  static const auto record = Record<SettingResult>("a setting")
                                 .required("setting", &SettingResult::setting, setting_word())
                                 .required("stated", &SettingResult::stated, number(kAny))
                                 .required("calibrated", &SettingResult::calibrated, number(kAny))
                                 .required("sigma", &SettingResult::sigma, number(kPositive))
                                 .required("off", &SettingResult::off, boolean());
  return record;
}

/// A vector in the plane as a pair of numbers.
template <class T>
Record<T>& pair(Record<T>& record, const std::string& key, Eigen::Vector2d T::*member) {
  const Value<Numbers> value = list(number(kErrorMm), 2);
  return record.custom(
      key,
      true,
      "a pair of numbers in mm",
      [member, value](const Cursor& at, T& object) {
        const auto read = value.read(at);
        if (read && read->size() == 2) {
          object.*member = {(*read)[0], (*read)[1]};
        } else if (read) {
          at.expect("a pair of numbers in mm");
        }
      },
      [member](const T& object) {
        return std::optional<Json>(
            Json::array({(object.*member)[0] + 0.0, (object.*member)[1] + 0.0}));
      });
}

const Record<MapPoint>& point_record() {
  static const auto record = [] {
    Record<MapPoint> point("a measured point");
    const auto coordinate = [&point](const char* key, auto get) {
      point.custom(
          key,
          true,
          "a number in mm",
          [get](const Cursor& at, MapPoint& p) {
            if (const auto value = at.number(kPlaceMm)) get(p) = *value;
          },
          [get](const MapPoint& p) {
            MapPoint copy = p;
            return std::optional<Json>(get(copy));
          });
    };
    coordinate("x_mm", [](MapPoint& p) -> double& { return p.mark.x_mm; });
    coordinate("y_mm", [](MapPoint& p) -> double& { return p.mark.y_mm; });
    coordinate("left_mm", [](MapPoint& p) -> double& { return p.lengths.left_mm; });
    coordinate("right_mm", [](MapPoint& p) -> double& { return p.lengths.right_mm; });
    point.required("bad", &MapPoint::bad, boolean())
        .required("distance_sigmas", &MapPoint::distance_sigmas, number(kPositive));
    pair(point, "as_stated_mm", &MapPoint::as_stated_mm);
    pair(point, "sheet_placed_mm", &MapPoint::sheet_placed_mm);
    pair(point, "mapped_mm", &MapPoint::mapped_mm);
    pair(point, "left_out_mm", &MapPoint::left_out_mm);
    return point;
  }();
  return record;
}

const Record<MirrorTest>& mirror_record() {
  static const auto record =
      Record<MirrorTest>("the mirror claim")
          .custom(
              "points",
              true,
              "a count",
              [](const Cursor& at, MirrorTest& test) {
                if (const auto count = at.integer(0, 1000000))
                  test.points = static_cast<std::size_t>(*count);
              },
              [](const MirrorTest& test) { return std::optional<Json>(test.points); })
          .required("difference", &MirrorTest::difference, object(summary_record()))
          .required("mean_mm", &MirrorTest::mean_mm, number(kErrorMm))
          .required("worst_at", &MirrorTest::worst_at, object(place_record()))
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
          .required("set_aside", &DistancesUsed::set_aside, integer(0, kMost))
          .required("tape_sigma_mm", &DistancesUsed::tape_sigma_mm, number(kPositive))
          .required("left_out_all", &DistancesUsed::left_out_all, object(summary_record()))
          .required("left_out_good", &DistancesUsed::left_out_good, object(summary_record()));
  return record;
}

/// The hash stands in files of version 1.1, and there it must be right.
void check_content(const Cursor& at) {
  const Cursor hash = at.child("content_hash");
  if (at.has("content_hash")) {
    if (hash.json() != content_hash(at.json())) {
      hash.expect(
          "the hash of this file's content: something in it was changed or damaged since it was "
          "written; fit the points again");
    }
  } else if (at.child("format_version").json() == "1.0") {
    at.warn("written before maps carried a hash of their content; taken to be undamaged");
  } else {
    hash.missing("the hash of this file's content");
  }
}

void check_map(const Cursor& at, MapPart& map) {
  if (map.model.has_value() == map.direct.has_value()) {
    at.expect("either \"on_machine\" or \"direct\", the two kinds of surface, and not both");
  }
  if (map.direct && map.outside && map.outside->way == Outside::fade) {
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

const Record<MapPart>& map_record() {
  static const auto record =
      Record<MapPart>(
          "a chaintrue_map file", "chaintrue_map", std::vector<std::string>{"1.0", "1.1"})
          .optional("name", &MapPart::name, text())
          .optional("on_machine", &MapPart::model, object(model_part_record()))
          .optional("direct", &MapPart::direct, object(direct_part_record()))
          .required("domain_mm", &MapPart::domain, object(rectangle_record()))
          .required("hull", &MapPart::hull, list(object(place_record()), 3))
          .required("edge_mm", &MapPart::edge_mm, number(kPositive))
          .optional("outside", &MapPart::outside, object(outside_record()))
          .required("noise", &MapPart::noise, object(noise_record()))
          .required("accuracy", &MapPart::accuracy, object(accuracy_record()))
          .required("settings", &MapPart::settings, list(object(setting_record())))
          .required("points", &MapPart::points, list(object(point_record())))
          .optional("mirror", &MapPart::mirror, object(mirror_record()))
          .optional("distances", &MapPart::distances, object(distances_record()))
          .required("notes", &MapPart::notes, list(text()))
          .sparse("content_hash", &MapPart::content_hash, text())
          .check(check_map);
  return record;
}

MapPart part_of(const MapContents& map) {
  MapPart part{map.name,
               std::nullopt,
               std::nullopt,
               map.hull,
               map.edge_mm,
               map.domain,
               std::nullopt,
               map.noise,
               map.accuracy,
               map.settings,
               map.points,
               map.mirror,
               map.distances,
               map.notes};
  if (const auto* model = std::get_if<ModelSurface>(&map.surface)) {
    part.model = files::part_of(*model);
  } else {
    part.direct = files::part_of(std::get<DirectSurface>(map.surface));
  }
  if (map.outside.way != Outside::continued) part.outside = map.outside;
  return part;
}

MapContents contents_of(const MapPart& part) {
  MapContents map;
  map.name = part.name;
  if (part.model) {
    map.surface = surface_of(*part.model);
  } else {
    map.surface = surface_of(*part.direct);
  }
  map.hull = part.hull;
  map.edge_mm = part.edge_mm;
  map.domain = part.domain;
  map.outside = part.outside.value_or(OutsideRule{});
  map.noise = part.noise;
  map.accuracy = part.accuracy;
  map.settings = part.settings;
  map.points = part.points;
  map.mirror = part.mirror;
  map.distances = part.distances;
  map.notes = part.notes;
  return map;
}

}  // namespace

CompensationMap parse_map(const std::string& text,
                          const std::string& file,
                          std::vector<Warning>* warnings) {
  Problems problems(file);
  CompensationMap map(contents_of(read_document(map_record(), text, problems)));
  if (warnings != nullptr) {
    warnings->insert(warnings->end(), problems.warnings().begin(), problems.warnings().end());
  }
  return map;
}

CompensationMap read_map(const std::filesystem::path& path, std::vector<Warning>* warnings) {
  return parse_map(read_whole_file(path), name_in_messages(path), warnings);
}

std::string write_map(const CompensationMap& map) {
  Json json = map_record().write(part_of(map.contents()));
  json["content_hash"] = content_hash(json);
  return print_json(json);
}

}  // namespace chaintrue::grid::files
