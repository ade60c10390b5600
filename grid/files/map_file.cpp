// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/machine_record.hpp"
#include "grid/files/names.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/schemas.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

// The surfaces of a map in a chaintrue_map file. Private to grid/files.

using Numbers = std::vector<double>;

struct SplinePart {
  interp::Rectangle rectangle;
  int x_intervals = 0;
  int y_intervals = 0;
  model::PerSide<double> scale;
  model::PerSide<Eigen::VectorXd> coefficients_mm;
};

/// A ModelSurface as its file has it: the basis by its intervals, and the triangle alone of the
/// covariance.
struct ModelPart {
  model::Machine machine;
  model::SheetPlacement sheet;
  std::vector<model::Setting> settings;
  SplinePart residual;
  std::vector<Numbers> covariance_factor;
  std::optional<LatticeResidual> lattice;
};

using model::PerSide;

Record<interp::Rectangle> rectangle_record() {
  return Record<interp::Rectangle>("a rectangle in mm")
      .required("x_min", "Left edge.", &interp::Rectangle::x_min, kPlaceMm)
      .required("x_max", "Right edge.", &interp::Rectangle::x_max, kPlaceMm)
      .required("y_min", "Lower edge.", &interp::Rectangle::y_min, kPlaceMm)
      .required("y_max", "Upper edge.", &interp::Rectangle::y_max, kPlaceMm)
      .check([](const Cursor& at, interp::Rectangle& r) {
        if (at.clean() && !(r.width() > 0.0 && r.height() > 0.0)) {
          at.expect("a rectangle whose maxima exceed its minima");
        }
      });
}

Record<model::SheetPlacement> sheet_placement_record() {
  return Record<model::SheetPlacement>("a sheet's placement")
      .required(
          "x_mm", "x of the marks' origin on the bed.", &model::SheetPlacement::x_mm, kPlaceMm)
      .required(
          "y_mm", "y of the marks' origin on the bed, up.", &model::SheetPlacement::y_mm, kPlaceMm)
      .required("rotation_rad",
                "Rotation of the marks, counter-clockwise.",
                &model::SheetPlacement::rotation_rad,
                number({"rad", -7.0, 7.0}));
}

Record<SplinePart> spline_record() {
  return Record<SplinePart>("a residual surface")
      .required("rectangle_mm",
                "Where the splines are defined.",
                &SplinePart::rectangle,
                rectangle_record())
      .required(
          "x_intervals", "Equal intervals along x.", &SplinePart::x_intervals, integer(1, 1000))
      .required(
          "y_intervals", "Equal intervals along y.", &SplinePart::y_intervals, integer(1, 1000))
      .required("scale_left",
                "Correction of the left chain per mm of length.",
                path(&SplinePart::scale, &PerSide<double>::left),
                number({"", -0.1, 0.1}))
      .required("scale_right",
                "Correction of the right chain per mm of length.",
                path(&SplinePart::scale, &PerSide<double>::right),
                number({"", -0.1, 0.1}))
      .required("coefficients_left_mm",
                "Coefficients of cubic B-splines for the left chain, y varying fastest: "
                "(x_intervals + 3) (y_intervals + 3) values.",
                path(&SplinePart::coefficients_mm, &PerSide<Eigen::VectorXd>::left),
                vector_of_numbers())
      .required("coefficients_right_mm",
                "Coefficients for the right chain, in the same order.",
                path(&SplinePart::coefficients_mm, &PerSide<Eigen::VectorXd>::right),
                vector_of_numbers())
      .check([](const Cursor& at, SplinePart& part) {
        if (!at.clean()) return;
        const Eigen::Index size = (part.x_intervals + 3) * (part.y_intervals + 3);
        const std::string expected = fmt::format("{} coefficients, as the intervals require", size);
        const auto& [left, right] = part.coefficients_mm;
        if (left.size() != size) at.child("coefficients_left_mm").expect(expected);
        if (right.size() != size) at.child("coefficients_right_mm").expect(expected);
      });
}

void check_model_part(const Cursor& at, ModelPart& part) {
  if (!at.clean()) return;
  const std::size_t unknowns =
      part.settings.size() + 2 + as_size(part.residual.coefficients_mm.left.size()) * 2;
  bool triangle = part.covariance_factor.size() == unknowns;
  for (std::size_t i = 0; triangle && i < unknowns; ++i)
    triangle = part.covariance_factor[i].size() == i + 1;
  if (!triangle) {
    at.child("covariance_factor")
        .expect(
            fmt::format("the {} rows of a lower triangle, of 1 to {} numbers", unknowns, unknowns));
  }
}

Record<interp::AxisEnds> axis_ends_record() {
  return Record<interp::AxisEnds>("the conditions at both ends of an axis")
      .required("low", "At the smaller end.", &interp::AxisEnds::low, choice(kEndConditions))
      .required("high", "At the larger end.", &interp::AxisEnds::high, choice(kEndConditions));
}

Record<interp::TensorEnds> ends_record() {
  return Record<interp::TensorEnds>("the conditions at the edges")
      .required("x", "Along x.", &interp::TensorEnds::x, axis_ends_record())
      .required("y", "Along y.", &interp::TensorEnds::y, axis_ends_record());
}

bool rises(const Numbers& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) {
           return !(a < b);
         }) == values.end();
}

struct NodeValues {
  const char* key;
  const Eigen::MatrixXd* values;
};

/// Checks that nodes increase, and that there are as many values as nodes.
template <class Surface>
void check_nodes(const Cursor& at,
                 const Surface& surface,
                 std::initializer_list<NodeValues> values) {
  if (!at.clean()) return;
  if (!rises(surface.x_nodes_mm)) at.child("x_nodes_mm").expect("increasing numbers");
  if (!rises(surface.y_nodes_mm)) at.child("y_nodes_mm").expect("increasing numbers");
  const std::size_t columns = surface.x_nodes_mm.size();
  const std::size_t rows = surface.y_nodes_mm.size();
  for (const NodeValues& own : values) {
    if (as_size(own.values->rows()) != columns || as_size(own.values->cols()) != rows)
      at.child(own.key).expect(
          fmt::format("{} lists of {} lengths, one list for each x", columns, rows));
  }
}

/// The nodes, and the chains at each of them.
template <class Surface>
void node_keys(Record<Surface>& record, model::PerSide<Eigen::MatrixXd> Surface::*chains) {
  const auto values = matrix_of_numbers(kAnyNumber, 2);
  record
      .required(
          "x_nodes_mm", "Nodes along x, increasing.", &Surface::x_nodes_mm, list(kAnyNumber, 2))
      .required(
          "y_nodes_mm", "Nodes along y, increasing.", &Surface::y_nodes_mm, list(kAnyNumber, 2))
      .required("left_mm",
                "Left chain at every node: one list for each x.",
                path(chains, &PerSide<Eigen::MatrixXd>::left),
                values)
      .required("right_mm",
                "Right chain at every node.",
                path(chains, &PerSide<Eigen::MatrixXd>::right),
                values);
}

constexpr const char* kBetweenNodes = "Error of the splines between nodes, 1 sigma.";

Record<LatticeResidual> lattice_record() {
  Record<LatticeResidual> lattice("splines through the residuals at every node");
  node_keys(lattice, &LatticeResidual::values_mm);
  return lattice
      .required("doubt_mm",
                "Uncertainty of the value at each node.",
                &LatticeResidual::doubt_mm,
                matrix_of_numbers(kNotNegative, 2))
      .required("interpolation_sigma_mm",
                kBetweenNodes,
                &LatticeResidual::interpolation_sigma_mm,
                kNotNegative)
      .check([](const Cursor& at, LatticeResidual& own) {
        check_nodes(at,
                    own,
                    {{"left_mm", &own.values_mm.left},
                     {"right_mm", &own.values_mm.right},
                     {"doubt_mm", &own.doubt_mm}});
      });
}

double seven_digits(double value) { return number_of(fmt::format("{:.7g}", value)).value(); }

Record<ModelPart> model_part_record() {
  return Record<ModelPart>("a surface on a machine")
      .required("machine", "The calibrated machine.", &ModelPart::machine, machine_record())
      .required(
          "sheet", "Placement of the marks' sheet.", &ModelPart::sheet, sheet_placement_record())
      .required("unknown_settings",
                "The settings that were calibrated, in the order of the covariance.",
                &ModelPart::settings,
                list(setting_word()))
      .required("residual",
                "Correction added to the machine's lengths.",
                &ModelPart::residual,
                spline_record())
      .required("covariance_factor",
                "Triangular root of the covariance of settings, scales and coefficients; lower "
                "triangle, row by row.",
                &ModelPart::covariance_factor,
                list(list(kAnyNumber, 1)))
      .optional("lattice",
                "For a full grid of marks: splines through the residuals at every node.",
                &ModelPart::lattice,
                lattice_record())
      .check(check_model_part);
}

Record<DirectSurface> direct_surface_record() {
  Record<DirectSurface> direct("splines through the lengths");
  node_keys(direct, &DirectSurface::lengths_mm);
  return direct
      .required("ends", "End conditions of the splines.", &DirectSurface::ends, ends_record())
      .required("interpolation_sigma_mm",
                kBetweenNodes,
                &DirectSurface::interpolation_sigma_mm,
                kNotNegative)
      .check([](const Cursor& at, DirectSurface& own) {
        check_nodes(
            at, own, {{"left_mm", &own.lengths_mm.left}, {"right_mm", &own.lengths_mm.right}});
      });
}

ModelPart part_of(const ModelSurface& surface) {
  const auto& [basis, scale, coefficients] = surface.residual;
  ModelPart part{surface.machine,
                 surface.sheet,
                 surface.settings,
                 {basis.rectangle(),
                  static_cast<int>(basis.columns_x()) - 3,
                  static_cast<int>(basis.columns_y()) - 3,
                  scale,
                  coefficients},
                 {},
                 surface.lattice};
  for (Eigen::Index i = 0; i < surface.covariance_factor.rows(); ++i) {
    Numbers& row = part.covariance_factor.emplace_back();
    for (Eigen::Index j = 0; j <= i; ++j)
      row.push_back(seven_digits(surface.covariance_factor(i, j)));
  }
  return part;
}

ModelSurface surface_of(const ModelPart& part) {
  const SplinePart& own = part.residual;
  const interp::BsplineBasis basis(own.rectangle, own.x_intervals, own.y_intervals);
  const FitColumns columns{as_index(part.settings.size()), basis.size()};
  ModelSurface surface{part.machine,
                       part.sheet,
                       {basis, own.scale, own.coefficients_mm},
                       columns,
                       part.settings,
                       Eigen::MatrixXd::Zero(columns.total(), columns.total()),
                       part.lattice};
  for (std::size_t i = 0; i < part.covariance_factor.size(); ++i) {
    const Numbers& row = part.covariance_factor[i];
    surface.covariance_factor.row(as_index(i)).head(as_index(row.size())) =
        Eigen::Map<const Eigen::RowVectorXd>(row.data(), as_index(row.size()));
  }
  return surface;
}

constexpr Range kErrorMm{"mm", -1e5, 1e5};
constexpr Range kSigmaFactor{"", 1.0, 1e6};

Record<model::MarkPoint> mark_record() {
  return Record<model::MarkPoint>("a point")
      .required("x_mm",
                "x of the tool. Null in a list that is not filled in yet.",
                &model::MarkPoint::x_mm,
                kPlaceMm)
      .required("y_mm",
                "y of the tool, up. Null in a list that is not filled in yet.",
                &model::MarkPoint::y_mm,
                kPlaceMm);
}

Record<OutsideRule> outside_record() {
  return Record<OutsideRule>("behaviour outside the measured part")
      .required(
          "way", "Behaviour outside the measured part.", &OutsideRule::way, choice(kOutsideWays))
      .optional("fade_width_mm",
                "For fade: distance over which the correction goes to zero.",
                &OutsideRule::fade_width_mm,
                kFadeWidthMm);
}

Record<MapNoise> map_noise_record() {
  return Record<MapNoise>("the noise used by the fit")
      .required(
          "length_mm", "Noise of a chain reading, 1 sigma.", &MapNoise::length_mm, kNotNegative)
      .required("position_mm",
                "Noise of a position, 1 sigma on each axis.",
                &MapNoise::position_mm,
                kNotNegative)
      .required(
          "source",
          "Where it comes from.",
          &MapNoise::source,
          by_name(
              {NoiseSource::stated, NoiseSource::repeats, NoiseSource::fit, NoiseSource::assumed}))
      .required("factor_found",
                "Scatter of the points relative to this noise.",
                &MapNoise::factor_found,
                kNotNegative);
}

Record<HeldOutError> held_out_record() {
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

Record<MapAccuracy> accuracy_record() {
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

Record<SettingResult> setting_record() {
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

Record<MapPoint> map_point_record() {
  using model::ChainLengths;
  using model::MarkPoint;
  return Record<MapPoint>("a measured point")
      .required("x_mm",
                "x, to the right of the bed's middle, or of the marks' origin.",
                path(&MapPoint::mark, &MarkPoint::x_mm),
                kPlaceMm)
      .required("y_mm",
                "y, up from the bed's middle, or from the marks' origin.",
                path(&MapPoint::mark, &MarkPoint::y_mm),
                kPlaceMm)
      .required(
          "left_mm", "The left chain.", path(&MapPoint::lengths, &ChainLengths::left_mm), kPlaceMm)
      .required("right_mm",
                "The right chain.",
                path(&MapPoint::lengths, &ChainLengths::right_mm),
                kPlaceMm)
      .required("bad", "True if the fit left it out.", &MapPoint::bad)
      .required("distance_sigmas",
                "Its distance from the prediction of the others, in sigmas.",
                &MapPoint::distance_sigmas,
                kNotNegative)
      .required("as_stated_mm",
                "Measured position minus that of the machine file.",
                &MapPoint::as_stated_mm,
                pair_of_numbers(kErrorMm))
      .required("sheet_placed_mm",
                "The same after the best placement of the sheet.",
                &MapPoint::sheet_placed_mm,
                pair_of_numbers(kErrorMm))
      .required(
          "mapped_mm", "The same with the map.", &MapPoint::mapped_mm, pair_of_numbers(kErrorMm))
      .required("left_out_mm",
                "The same with a map made without it.",
                &MapPoint::left_out_mm,
                pair_of_numbers(kErrorMm));
}

Record<MirrorTest> mirror_record() {
  return Record<MirrorTest>("comparison of mirrored chains")
      .required("points",
                "Number of points whose mirror image was measured.",
                &MirrorTest::points,
                index_number())
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

Record<DistancesUsed> distances_record() {
  constexpr int kMost = 1000000;
  return Record<DistancesUsed>("the distances between holes")
      .required("used", "Number of distances used.", &DistancesUsed::used, integer(0, kMost))
      .required(
          "set_aside", "Number of distances left out.", &DistancesUsed::rejected, integer(0, kMost))
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

/// Null if the map has the other kind of surface.
template <class Surface>
const Surface* surface_in(const MapContents& map) {
  return std::get_if<Surface>(&map.surface);
}

Record<MapContents> make_map_record() {
  Record<MapContents> record("a chaintrue_map file", kMapFormat);
  record.optional("name", "Name of the grid.", &MapContents::name);
  record
      .computed(
          "on_machine",
          "A calibrated machine with residual surfaces; or direct.",
          false,
          object(model_part_record()),
          [](MapContents& map, const ModelPart& part) { map.surface = surface_of(part); },
          [](const MapContents& map) {
            const auto* own = surface_in<ModelSurface>(map);
            return own != nullptr ? std::optional(part_of(*own)) : std::nullopt;
          })
      .computed(
          "direct",
          "Splines through the lengths, without a machine; or on_machine.",
          false,
          object(direct_surface_record()),
          [](MapContents& map, const DirectSurface& surface) { map.surface = surface; },
          [](const MapContents& map) {
            const auto* own = surface_in<DirectSurface>(map);
            return own != nullptr ? std::optional(*own) : std::nullopt;
          })
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
      .computed(
          "outside",
          "Behaviour outside the hull.",
          false,
          object(outside_record()),
          [](MapContents& map, const OutsideRule& rule) { map.outside = rule; },
          [](const MapContents& map) {
            return map.outside.way == OutsideRule{}.way ? std::nullopt : std::optional(map.outside);
          })
      .computed(
          "sigma_factor_beyond",
          "Factor on sigmas outside the measured part if causes were found, so that the larger "
          "error "
          "of the plain map applies there.",
          false,
          number(kSigmaFactor),
          [](MapContents& map, double factor) { map.sigma_factor_beyond = factor; },
          [](const MapContents& map) {
            return map.sigma_factor_beyond == MapContents{}.sigma_factor_beyond
                       ? std::nullopt
                       : std::optional(map.sigma_factor_beyond);
          })
      .required("noise", "The noise used by the fit.", &MapContents::noise, map_noise_record())
      .required("accuracy", "The map's own error.", &MapContents::accuracy, accuracy_record())
      .required("settings",
                "The machine's numbers, as in its file and calibrated.",
                &MapContents::settings,
                list(setting_record()))
      .required("points",
                "The points that the map was made from.",
                &MapContents::points,
                list(map_point_record()))
      .optional("mirror",
                "Whether one chain's surface is the other's, mirrored.",
                &MapContents::mirror,
                mirror_record())
      .optional("distances",
                "For a map from holes and a tape.",
                &MapContents::distances,
                distances_record())
      .required("notes", "Notes for the reader, in sentences.", &MapContents::notes, list(text()));
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

CompensationMap read_map(const std::filesystem::path& path) {
  return parse_map(read_whole_file(path), name_in_messages(path));
}

std::string write_map(const CompensationMap& map, const std::optional<Provenance>& made_by) {
  return print_with_hash(with_made_by(map_record().write(map.contents()), made_by));
}

Json map_schema() { return map_record().schema(); }

}  // namespace chaintrue::grid::files
