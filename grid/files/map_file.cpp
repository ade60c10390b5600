// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "grid/files/json_reader.hpp"
#include "grid/files/machine_record.hpp"
#include "grid/files/whole_file.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {
namespace {

using Numbers = std::vector<double>;

constexpr Range kPlaceMm{"mm", -1e5, 1e5};
constexpr Range kErrorMm{"mm", -1e5, 1e5};
constexpr Range kAny{"", -1e12, 1e12};
constexpr Range kPositive{"", 0.0, 1e12};

Value<Numbers> numbers(std::size_t fewest = 0) { return list(number(kAny), fewest); }

/// The parts of a map as they stand in the file, where those differ from the parts in memory.
struct SplinePart {
  interp::Rectangle rectangle;
  int x_intervals = 0;
  int y_intervals = 0;
  double scale_left = 0.0;
  double scale_right = 0.0;
  Numbers left_mm;
  Numbers right_mm;
};

struct ModelPart {
  model::Machine machine;
  model::SheetPlacement sheet;
  std::vector<std::string> unknown_settings;
  SplinePart residual;
  std::vector<Numbers> covariance_factor;
};

struct DirectPart {
  Numbers x_nodes_mm;
  Numbers y_nodes_mm;
  std::vector<Numbers> left_mm;  // rows of constant x
  std::vector<Numbers> right_mm;
  interp::TensorEnds ends;
  double interpolation_sigma_mm = 0.0;
};

struct MapPart {
  std::string name;
  std::optional<ModelPart> model;
  std::optional<DirectPart> direct;
  std::vector<model::BedPoint> hull;
  double edge_mm = 0.0;
  interp::Rectangle domain;
  MapNoise noise;
  MapAccuracy accuracy;
  std::vector<SettingResult> settings;
  std::vector<MapPoint> points;
  std::optional<MirrorTest> mirror;
  std::vector<std::string> notes;
};

const Record<interp::Rectangle>& rectangle_record() {
  static const auto record = Record<interp::Rectangle>("a rectangle in mm")
                                 .required("x_min", &interp::Rectangle::x_min, number(kPlaceMm))
                                 .required("x_max", &interp::Rectangle::x_max, number(kPlaceMm))
                                 .required("y_min", &interp::Rectangle::y_min, number(kPlaceMm))
                                 .required("y_max", &interp::Rectangle::y_max, number(kPlaceMm))
                                 .check([](const Cursor& at, interp::Rectangle& r) {
                                   if (at.clean() && !(r.width() > 0.0 && r.height() > 0.0)) {
                                     at.expect("a rectangle whose maxima lie above its minima");
                                   }
                                 });
  return record;
}

const Record<model::BedPoint>& place_record() {
  static const auto record = Record<model::BedPoint>("a point")
                                 .required("x_mm", &model::BedPoint::x_mm, number(kPlaceMm))
                                 .required("y_mm", &model::BedPoint::y_mm, number(kPlaceMm));
  return record;
}

const Record<model::SheetPlacement>& sheet_record() {
  static const auto record =
      Record<model::SheetPlacement>("a sheet's placement")
          .required("x_mm", &model::SheetPlacement::x_mm, number(kPlaceMm))
          .required("y_mm", &model::SheetPlacement::y_mm, number(kPlaceMm))
          .required(
              "rotation_rad", &model::SheetPlacement::rotation_rad, number({"rad", -7.0, 7.0}));
  return record;
}

const Record<SplinePart>& spline_record() {
  static const auto record =
      Record<SplinePart>("a residual surface")
          .required("rectangle_mm", &SplinePart::rectangle, object(rectangle_record()))
          .required("x_intervals", &SplinePart::x_intervals, integer(1, 1000))
          .required("y_intervals", &SplinePart::y_intervals, integer(1, 1000))
          .required("scale_left", &SplinePart::scale_left, number({"", -0.1, 0.1}))
          .required("scale_right", &SplinePart::scale_right, number({"", -0.1, 0.1}))
          .required("coefficients_left_mm", &SplinePart::left_mm, numbers())
          .required("coefficients_right_mm", &SplinePart::right_mm, numbers())
          .check([](const Cursor& at, SplinePart& part) {
            if (!at.clean()) return;
            const auto size =
                static_cast<std::size_t>((part.x_intervals + 3) * (part.y_intervals + 3));
            const std::string expected = fmt::format("{} coefficients, as the intervals say", size);
            if (part.left_mm.size() != size) at.child("coefficients_left_mm").expect(expected);
            if (part.right_mm.size() != size) at.child("coefficients_right_mm").expect(expected);
          });
  return record;
}

void check_model_part(const Cursor& at, ModelPart& part) {
  if (!at.clean()) return;
  const std::size_t unknowns = part.unknown_settings.size() + 2 + part.residual.left_mm.size() * 2;
  bool triangle = part.covariance_factor.size() == unknowns;
  for (std::size_t i = 0; triangle && i < unknowns; ++i)
    triangle = part.covariance_factor[i].size() == i + 1;
  if (!triangle) {
    at.child("covariance_factor")
        .expect(
            fmt::format("the {} rows of a lower triangle, of 1 to {} numbers", unknowns, unknowns));
  }
}

const Record<ModelPart>& model_part_record() {
  static const auto record = [] {
    std::vector<std::string> words;
    for (auto setting : model::kMachineSettings) words.emplace_back(model::name(setting));
    for (auto setting : model::kSheetSettings) words.emplace_back(model::name(setting));
    return Record<ModelPart>("a surface on a machine")
        .required("machine", &ModelPart::machine, object(machine_record()))
        .required("sheet", &ModelPart::sheet, object(sheet_record()))
        .required("unknown_settings", &ModelPart::unknown_settings, list(one_of(words)))
        .required("residual", &ModelPart::residual, object(spline_record()))
        .required("covariance_factor", &ModelPart::covariance_factor, list(numbers(1)))
        .check(check_model_part);
  }();
  return record;
}

Value<interp::EndCondition> end_condition() {
  return choice<interp::EndCondition>({{"not_a_knot", interp::EndCondition::kNotAKnot},
                                       {"natural", interp::EndCondition::kNatural},
                                       {"parabolic", interp::EndCondition::kParabolic},
                                       {"clamped", interp::EndCondition::kClamped}});
}

const Record<interp::AxisEnds>& axis_ends_record() {
  static const auto record = Record<interp::AxisEnds>("the conditions at both ends of an axis")
                                 .required("low", &interp::AxisEnds::low, end_condition())
                                 .required("high", &interp::AxisEnds::high, end_condition());
  return record;
}

const Record<interp::TensorEnds>& ends_record() {
  static const auto record = Record<interp::TensorEnds>("the conditions at the edges")
                                 .required("x", &interp::TensorEnds::x, object(axis_ends_record()))
                                 .required("y", &interp::TensorEnds::y, object(axis_ends_record()));
  return record;
}

bool rises(const Numbers& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) {
           return !(a < b);
         }) == values.end();
}

void check_direct_part(const Cursor& at, DirectPart& part) {
  if (!at.clean()) return;
  if (!rises(part.x_nodes_mm)) at.child("x_nodes_mm").expect("numbers that rise");
  if (!rises(part.y_nodes_mm)) at.child("y_nodes_mm").expect("numbers that rise");
  const auto shape = [&](const std::vector<Numbers>& values) {
    return values.size() == part.x_nodes_mm.size() &&
           std::all_of(values.begin(), values.end(), [&](const Numbers& column) {
             return column.size() == part.y_nodes_mm.size();
           });
  };
  const std::string expected = fmt::format("{} lists of {} lengths, one list for each x",
                                           part.x_nodes_mm.size(),
                                           part.y_nodes_mm.size());
  if (!shape(part.left_mm)) at.child("left_mm").expect(expected);
  if (!shape(part.right_mm)) at.child("right_mm").expect(expected);
}

const Record<DirectPart>& direct_part_record() {
  static const auto record =
      Record<DirectPart>("splines through the lengths")
          .required("x_nodes_mm", &DirectPart::x_nodes_mm, numbers(2))
          .required("y_nodes_mm", &DirectPart::y_nodes_mm, numbers(2))
          .required("left_mm", &DirectPart::left_mm, list(numbers(2), 2))
          .required("right_mm", &DirectPart::right_mm, list(numbers(2), 2))
          .required("ends", &DirectPart::ends, object(ends_record()))
          .required(
              "interpolation_sigma_mm", &DirectPart::interpolation_sigma_mm, number(kPositive))
          .check(check_direct_part);
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

void check_map(const Cursor& at, MapPart& map) {
  if (map.model.has_value() == map.direct.has_value()) {
    at.expect("either \"on_machine\" or \"direct\", the two kinds of surface, and not both");
  }
  if (!at.clean()) return;
  try {
    const MeasuredArea area(map.hull, map.edge_mm, map.domain);
  } catch (const std::invalid_argument&) {
    at.child("hull").expect("the corners of an area, counter-clockwise");
  }
}

const Record<MapPart>& map_record() {
  static const auto record =
      Record<MapPart>("a chaintrue_map file", "chaintrue_map")
          .optional("name", &MapPart::name, text())
          .optional("on_machine", &MapPart::model, object(model_part_record()))
          .optional("direct", &MapPart::direct, object(direct_part_record()))
          .required("domain_mm", &MapPart::domain, object(rectangle_record()))
          .required("hull", &MapPart::hull, list(object(place_record()), 3))
          .required("edge_mm", &MapPart::edge_mm, number(kPositive))
          .required("noise", &MapPart::noise, object(noise_record()))
          .required("accuracy", &MapPart::accuracy, object(accuracy_record()))
          .required("settings", &MapPart::settings, list(object(setting_record())))
          .required("points", &MapPart::points, list(object(point_record())))
          .optional("mirror", &MapPart::mirror, object(mirror_record()))
          .required("notes", &MapPart::notes, list(text()))
          .check(check_map);
  return record;
}

double seven_digits(double value) {
  const std::string digits = fmt::format("{:.7g}", value);
  double rounded = 0.0;
  std::from_chars(digits.data(), digits.data() + digits.size(), rounded);
  return rounded;
}

Numbers to_numbers(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

Eigen::VectorXd to_vector(const Numbers& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

ModelPart part_of(const ModelSurface& surface) {
  ModelPart part;
  part.machine = surface.machine;
  part.sheet = surface.sheet;
  for (auto setting : surface.settings) part.unknown_settings.emplace_back(model::name(setting));
  const interp::BsplineBasis& basis = surface.residual.basis;
  part.residual = {basis.rectangle(),
                   static_cast<int>(basis.columns_x()) - 3,
                   static_cast<int>(basis.columns_y()) - 3,
                   surface.residual.scale.left,
                   surface.residual.scale.right,
                   to_numbers(surface.residual.coefficients.left),
                   to_numbers(surface.residual.coefficients.right)};
  for (Eigen::Index i = 0; i < surface.covariance_factor.rows(); ++i) {
    Numbers row;
    for (Eigen::Index j = 0; j <= i; ++j)
      row.push_back(seven_digits(surface.covariance_factor(i, j)));
    part.covariance_factor.push_back(std::move(row));
  }
  return part;
}

ModelSurface surface_of(const ModelPart& part) {
  ModelSurface surface{
      part.machine,
      part.sheet,
      {interp::BsplineBasis(
           part.residual.rectangle, part.residual.x_intervals, part.residual.y_intervals),
       {part.residual.scale_left, part.residual.scale_right},
       {to_vector(part.residual.left_mm), to_vector(part.residual.right_mm)}},
      {},
      {},
      {}};
  for (const std::string& word : part.unknown_settings)
    surface.settings.push_back(*model::setting_from_name(word));
  surface.columns = {static_cast<Eigen::Index>(surface.settings.size()),
                     surface.residual.basis.size()};
  const Eigen::Index unknowns = surface.columns.total();
  surface.covariance_factor = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    const Numbers& row = part.covariance_factor[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j <= i; ++j)
      surface.covariance_factor(i, j) = row[static_cast<std::size_t>(j)];
  }
  return surface;
}

std::vector<Numbers> to_lists(const Eigen::MatrixXd& values) {
  std::vector<Numbers> lists;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    lists.push_back(to_numbers(values.row(i).transpose()));
  return lists;
}

Eigen::MatrixXd to_matrix(const std::vector<Numbers>& lists) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(lists.size()),
                         static_cast<Eigen::Index>(lists.front().size()));
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    values.row(i) = to_vector(lists[static_cast<std::size_t>(i)]).transpose();
  }
  return values;
}

MapPart part_of(const MapContents& map) {
  MapPart part{map.name,
               std::nullopt,
               std::nullopt,
               map.hull,
               map.edge_mm,
               map.domain,
               map.noise,
               map.accuracy,
               map.settings,
               map.points,
               map.mirror,
               map.notes};
  if (const auto* model = std::get_if<ModelSurface>(&map.surface)) {
    part.model = part_of(*model);
  } else {
    const auto& direct = std::get<DirectSurface>(map.surface);
    part.direct = DirectPart{direct.x_nodes_mm,
                             direct.y_nodes_mm,
                             to_lists(direct.lengths_mm.left),
                             to_lists(direct.lengths_mm.right),
                             direct.ends,
                             direct.interpolation_sigma_mm};
  }
  return part;
}

MapContents contents_of(const MapPart& part) {
  MapContents map;
  map.name = part.name;
  if (part.model) {
    map.surface = surface_of(*part.model);
  } else {
    map.surface = DirectSurface{part.direct->x_nodes_mm,
                                part.direct->y_nodes_mm,
                                {to_matrix(part.direct->left_mm), to_matrix(part.direct->right_mm)},
                                part.direct->ends,
                                part.direct->interpolation_sigma_mm};
  }
  map.hull = part.hull;
  map.edge_mm = part.edge_mm;
  map.domain = part.domain;
  map.noise = part.noise;
  map.accuracy = part.accuracy;
  map.settings = part.settings;
  map.points = part.points;
  map.mirror = part.mirror;
  map.notes = part.notes;
  return map;
}

}  // namespace

CompensationMap parse_map(const std::string& text, const std::string& file) {
  return CompensationMap(contents_of(read_document(map_record(), text, file)));
}

CompensationMap read_map(const std::filesystem::path& path) {
  return parse_map(read_whole_file(path), name_in_messages(path));
}

std::string write_map(const CompensationMap& map) {
  return write_document(map_record(), part_of(map.contents()));
}

}  // namespace chaintrue::grid::files
