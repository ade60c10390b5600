// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/belt_holes_record.hpp"

#include <fmt/format.h>

#include "grid/belts/belt_holes.hpp"
#include "grid/files/belts_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kPositiveMm{"mm", 1e-9, 1e6};
constexpr Range kFactor{"", 1e-3, 1e3};
constexpr Range kAngle{"rad", -1.0, 1.0};
constexpr int kMostSets = 1000;

/// A coordinate of a point that is a member of the object.
template <class T, class Point>
void add_coordinate(Record<T>& record, const char* key, Point T::*point, double Point::*member) {
  record.custom(
      key,
      true,
      {kMillimetres.expected(), [] { return number_schema(kMillimetres); }},
      [point, member](const Cursor& at, T& object) {
        if (const auto value = at.number(kMillimetres)) object.*point.*member = *value;
      },
      [point, member](const T& object) { return std::optional<Json>(object.*point.*member); });
}

const Record<BeltHole>& belt_hole_record() {
  static const auto record = [] {
    Record<BeltHole> hole("a fitted hole");
    hole.required("name", &BeltHole::name, text());
    add_coordinate(hole, "x_mm", &BeltHole::commanded, &model::BedPoint::x_mm);
    add_coordinate(hole, "y_mm", &BeltHole::commanded, &model::BedPoint::y_mm);
    add_coordinate(hole, "mark_x_mm", &BeltHole::mark, &model::MarkPoint::x_mm);
    add_coordinate(hole, "mark_y_mm", &BeltHole::mark, &model::MarkPoint::y_mm);
    return hole;
  }();
  return record;
}

const Record<BeltTapedDistance>& taped_distance_record() {
  static const auto record =
      Record<BeltTapedDistance>("a fitted distance")
          .custom(
              "set",
              true,
              {"a set's number", integer(0, kMostSets).expected.schema},
              [](const Cursor& at, BeltTapedDistance& distance) {
                if (const auto set = at.integer(0, kMostSets))
                  distance.set = static_cast<std::size_t>(*set);
              },
              [](const BeltTapedDistance& distance) { return std::optional<Json>(distance.set); })
          .required("between", &BeltTapedDistance::words, text())
          .required("measured_mm", &BeltTapedDistance::measured_mm, number(kMillimetres))
          .required("off_mm", &BeltTapedDistance::residual_mm, number(kMillimetres))
          .required("left_out_mm", &BeltTapedDistance::left_out_mm, number(kMillimetres))
          .required("left_out_sigma_mm", &BeltTapedDistance::left_out_sigma_mm, number(kSigmaMm))
          .required("set_aside", &BeltTapedDistance::rejected, boolean());
  return record;
}

struct StatedDisplacement {
  double size_mm = 0.0;
  double reach_mm = 1.0;
  std::vector<std::vector<double>> places;
};

/// x, y, and the tool's offset in x and y.
constexpr std::size_t kNumbersOfAPlace = 4;

const Record<StatedDisplacement>& displacement_record() {
  static const auto record =
      Record<StatedDisplacement>("a displacement of the tool")
          .required("size_mm", &StatedDisplacement::size_mm, number(kPositiveMm))
          .required("reach_mm", &StatedDisplacement::reach_mm, number(kPositiveMm))
          .required("places",
                    &StatedDisplacement::places,
                    list(list(number(kMillimetres), kNumbersOfAPlace), 1))
          .check([](const Cursor& at, StatedDisplacement& stated) {
            for (const auto& place : stated.places) {
              if (place.size() != kNumbersOfAPlace && at.clean())
                at.child("places").expect("four numbers of each place");
            }
          });
  return record;
}

std::optional<DisplacementParts> read_displacement(const Cursor& at) {
  const auto stated = displacement_record().read(at);
  if (!stated || !at.clean()) return std::nullopt;
  DisplacementParts parts{stated->size_mm, stated->reach_mm, {}, {}};
  parts.at_mm.resize(2 * static_cast<Eigen::Index>(stated->places.size()));
  for (const auto& place : stated->places) {
    const auto row = 2 * static_cast<Eigen::Index>(parts.places.size());
    parts.places.push_back({place[0], place[1]});
    parts.at_mm.segment<2>(row) << place[2], place[3];
  }
  return parts;
}

Json written_displacement(const DisplacementParts& parts) {
  StatedDisplacement stated{parts.size_mm, parts.reach_mm, {}};
  for (std::size_t i = 0; i < parts.places.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    stated.places.push_back(
        {parts.places[i].x_mm, parts.places[i].y_mm, parts.at_mm[row], parts.at_mm[row + 1]});
  }
  return displacement_record().write(stated);
}

struct StatedSheet {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double rotation_rad = 0.0;
};

const Record<StatedSheet>& stated_sheet_record() {
  static const auto record =
      Record<StatedSheet>("where the sheet lies")
          .required("x_mm", &StatedSheet::x_mm, number(kMillimetres))
          .required("y_mm", &StatedSheet::y_mm, number(kMillimetres))
          .required("rotation_rad", &StatedSheet::rotation_rad, number(kAngle));
  return record;
}

void read_holes_covariance(const Cursor& at, HolesWithBelts& holes) {
  const auto rows = list(list(number(kAnyNumber))).read(at);
  if (!rows || !at.clean()) return;
  const auto size = static_cast<Eigen::Index>(rows->size());
  holes.covariance.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto& row = (*rows)[static_cast<std::size_t>(i)];
    if (static_cast<Eigen::Index>(row.size()) != size) return at.expect("as many numbers as rows");
    for (Eigen::Index k = 0; k < size; ++k)
      holes.covariance(i, k) = row[static_cast<std::size_t>(k)];
  }
}

std::optional<Json> written_holes_covariance(const HolesWithBelts& holes) {
  Json rows = Json::array();
  for (const auto& row : holes.covariance.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

void check_together(const Cursor& at, const HolesWithBelts& holes) {
  if (!at.clean()) return;
  constexpr std::size_t kFewestHoles = 3;
  if (holes.holes.size() < kFewestHoles) at.child("holes").expect("three holes at least");
  if (!holes.machine.anchors_known)
    at.child("machine").expect("the anchors in force when the holes were cut");
  const Eigen::Index moved = holes.displacement ? holes.displacement->at_mm.size() : 0;
  if (holes.covariance.rows() != belts::kFrameUnknowns + moved) {
    at.child("covariance")
        .expect(fmt::format("{} rows: six, and two for each place of the displacement",
                            belts::kFrameUnknowns + moved));
  }
}

}  // namespace

const Record<HolesWithBelts>& holes_with_belts_record() {
  static const auto record =
      Record<HolesWithBelts>("what holes add to belts")
          .required("machine", &HolesWithBelts::machine, object(belt_machine_record()))
          .required("holes", &HolesWithBelts::holes, list(object(belt_hole_record())))
          .required(
              "distances", &HolesWithBelts::distances, list(object(taped_distance_record())))
          .required("noise_factor", &HolesWithBelts::noise_factor, number(kFactor))
          .required("left_out_rms_mm", &HolesWithBelts::left_out_rms_mm, number(kSigmaMm))
          .custom(
              "displacement",
              false,
              displacement_record().expected(),
              [](const Cursor& at, HolesWithBelts& holes) {
                holes.displacement = read_displacement(at);
              },
              [](const HolesWithBelts& holes) {
                return holes.displacement
                           ? std::optional<Json>(written_displacement(*holes.displacement))
                           : std::nullopt;
              })
          .custom(
              "sheet",
              false,
              stated_sheet_record().expected(),
              [](const Cursor& at, HolesWithBelts& holes) {
                if (const auto sheet = stated_sheet_record().read(at))
                  holes.sheet = Eigen::Vector3d(sheet->x_mm, sheet->y_mm, sheet->rotation_rad);
              },
              [](const HolesWithBelts& holes) -> std::optional<Json> {
                if (!holes.sheet) return std::nullopt;
                return stated_sheet_record().write(
                    {holes.sheet->x(), holes.sheet->y(), holes.sheet->z()});
              })
          .custom("covariance",
                  true,
                  {"rows of numbers", list(list(number(kAnyNumber))).expected.schema},
                  read_holes_covariance,
                  written_holes_covariance)
          .check([](const Cursor& at, HolesWithBelts& holes) { check_together(at, holes); });
  return record;
}

}  // namespace chaintrue::grid::files
