// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/belts_record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/ranges.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/schemas.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Anchor;
using model::Belt;
using model::BeltMachine;
using model::kBelts;
using model::PerBelt;

std::string key_of(Belt belt, std::string_view unit = "") {
  return fmt::format("{}{}", name(belt), unit);
}

struct StatedAnchor {
  std::optional<double> x_mm;
  std::optional<double> y_mm;
  std::optional<double> z_mm;
};

const Record<StatedAnchor>& anchor_record() {
  static const auto record = Record<StatedAnchor>("an anchor")
                                 .optional("x_mm", &StatedAnchor::x_mm, number_in("mm"))
                                 .optional("y_mm", &StatedAnchor::y_mm, number_in("mm"))
                                 .optional("z_mm", &StatedAnchor::z_mm, number_in("mm"));
  return record;
}

const Record<PerBelt<StatedAnchor>>& anchors_record() {
  using Anchors = PerBelt<StatedAnchor>;
  static const auto record = Record<Anchors>("four anchors")
                                 .required("tl", &Anchors::tl, object(anchor_record()))
                                 .required("tr", &Anchors::tr, object(anchor_record()))
                                 .required("bl", &Anchors::bl, object(anchor_record()))
                                 .required("br", &Anchors::br, object(anchor_record()));
  return record;
}

void read_anchors(const Cursor& at, BeltMachine& machine) {
  const auto stated = anchors_record().read(at);
  if (!stated) return;
  int known = 0;
  for (const Belt belt : kBelts) {
    const StatedAnchor& anchor = (*stated)[belt];
    Anchor& own = machine.anchors[belt];
    own = {anchor.x_mm.value_or(0.0), anchor.y_mm.value_or(0.0), anchor.z_mm.value_or(own.z_mm)};
    known += (anchor.x_mm ? 1 : 0) + (anchor.y_mm ? 1 : 0);
  }
  machine.anchors_known = known == 8;
  if (known != 0 && known != 8 && at.clean()) {
    at.problems().add(at.pointer(),
                      fmt::format("{} of eight coordinates", known),
                      "x_mm and y_mm of all four anchors, or of none where they are not known yet",
                      ProblemKind::missing);
  }
}

std::optional<Json> written_anchors(const BeltMachine& machine) {
  PerBelt<StatedAnchor> stated;
  for (const Belt belt : kBelts) {
    const Anchor& own = machine.anchors[belt];
    stated[belt].z_mm = own.z_mm;
    if (!machine.anchors_known) continue;
    stated[belt].x_mm = own.x_mm;
    stated[belt].y_mm = own.y_mm;
  }
  return anchors_record().write(stated);
}

struct StatedBelt {
  double turn_mm = BeltMachine{}.belt_turn_mm;
};

const Record<StatedBelt>& belt_record() {
  static const auto record =
      Record<StatedBelt>("a belt").optional("turn_mm", &StatedBelt::turn_mm, number_in("mm"));
  return record;
}

void check_machine(const Cursor& at, BeltMachine& machine) {
  for (const model::MachineProblem& problem : model::problems_of(machine)) {
    const std::string place = at.pointer() + problem.parameter;
    // A field that could not be read keeps its default, which needs no check.
    if (!at.problems().at_or_below(place)) at.problems().add(place, problem);
  }
}

std::optional<std::vector<Belt>> read_pulled(const Cursor& at) {
  static const Value<std::vector<std::string>> belts = list(one_of({"tl", "tr", "bl", "br"}));
  const auto found = belts.read(at);
  if (!found) return std::nullopt;
  std::vector<Belt> pulled;
  for (const Belt belt : kBelts) {
    if (std::find(found->begin(), found->end(), name(belt)) != found->end()) pulled.push_back(belt);
  }
  return pulled;
}

Json written_pulled(const std::vector<Belt>& pulled) {
  Json words = Json::array();
  for (const Belt belt : pulled) words.push_back(std::string(name(belt)));
  return words;
}

constexpr Range kPull{"", 1e-3, 1e6};

/// One key for each unit.
void add_pull(Record<BeltPoint>& record) {
  using Unit = BeltPull::Unit;
  constexpr std::pair<const char*, Unit> kKeys[] = {
      {"pull_n", Unit::newton}, {"pull_ma", Unit::milliampere}, {"pull", Unit::relative}};
  for (const auto& [key, unit] : kKeys) {
    const Unit own = unit;
    record.custom(
        key,
        false,
        {kPull.expected(), [] { return number_schema(kPull); }},
        [own](const Cursor& at, BeltPoint& point) {
          const auto value = at.number(kPull);
          if (!value) return;
          if (point.pull) at.expect("one of pull_n, pull_ma and pull");
          point.pull = BeltPull{*value, own};
        },
        [own](const BeltPoint& point) {
          return point.pull && point.pull->unit == own ? std::optional<Json>(point.pull->value)
                                                       : std::nullopt;
        });
  }
}

using ThrownAway = PerBelt<std::vector<double>>;

const Record<ThrownAway>& thrown_away_record() {
  static const auto record = Record<ThrownAway>("lengths of each belt")
                                 .sparse("tl_mm", &ThrownAway::tl, list(number(kBeltLengthMm)))
                                 .sparse("tr_mm", &ThrownAway::tr, list(number(kBeltLengthMm)))
                                 .sparse("bl_mm", &ThrownAway::bl, list(number(kBeltLengthMm)))
                                 .sparse("br_mm", &ThrownAway::br, list(number(kBeltLengthMm)));
  return record;
}

void add_lengths(Record<BeltPoint>& record) {
  for (const Belt belt : kBelts) {
    record.custom(
        key_of(belt, "_mm"),
        true,
        {kBeltLengthMm.expected(), [] { return number_schema(kBeltLengthMm); }},
        [belt](const Cursor& at, BeltPoint& point) {
          if (const auto value = at.number(kBeltLengthMm)) point.lengths_mm[belt] = *value;
        },
        [belt](const BeltPoint& point) { return std::optional<Json>(point.lengths_mm[belt]); });
  }
}

constexpr Range kSpreadMm{"mm", 0.0, 1e6};
constexpr Range kMisfitMm{"mm", -1e6, 1e6};
constexpr int kMostReadings = 400000;
constexpr Range kCommand{"mm", -20000.0, 20000.0};

void add_command(Record<BeltPoint>& record) {
  const auto coordinate = [&](const char* key, double model::BedPoint::*member) {
    record.custom(
        key,
        false,
        {kCommand.expected(), [] { return number_schema(kCommand); }},
        [member](const Cursor& at, BeltPoint& point) {
          const auto value = at.number(kCommand);
          if (!value) return;
          if (!point.commanded) point.commanded = model::BedPoint{};
          (*point.commanded).*member = *value;
        },
        [member](const BeltPoint& point) {
          return point.commanded ? std::optional<Json>((*point.commanded).*member) : std::nullopt;
        });
  };
  coordinate("commanded_x_mm", &model::BedPoint::x_mm);
  coordinate("commanded_y_mm", &model::BedPoint::y_mm);
  record.check([](const Cursor& at, BeltPoint&) {
    if (at.has("commanded_x_mm") == at.has("commanded_y_mm")) return;
    const char* lacking = at.has("commanded_x_mm") ? "commanded_y_mm" : "commanded_x_mm";
    at.child(lacking).missing("both coordinates of the command, or none");
  });
}

const Record<BeltPoint>& belt_point_record() {
  static const auto record = [] {
    Record<BeltPoint> point("a place");
    add_lengths(point);
    add_command(point);
    point.optional("order", &BeltPoint::order, integer(0, 1000000));
    point.custom(
        "pulled",
        false,
        {"a list of belts that were pulled, of tl, tr, bl, br",
         [] {
           return list(one_of({"tl", "tr", "bl", "br"})).expected.schema();
         }},
        [](const Cursor& at, BeltPoint& p) { p.pulled = read_pulled(at); },
        [](const BeltPoint& p) {
          return p.pulled ? std::optional<Json>(written_pulled(*p.pulled)) : std::nullopt;
        });
    add_pull(point);
    point.custom(
        "thrown_away",
        false,
        thrown_away_record().expected(),
        [](const Cursor& at, BeltPoint& p) {
          if (auto found = thrown_away_record().read(at)) p.thrown_away_mm = std::move(*found);
        },
        [](const BeltPoint& p) {
          return p.thrown_away_mm == ThrownAway{}
                     ? std::nullopt
                     : std::optional<Json>(thrown_away_record().write(p.thrown_away_mm));
        });
    return point;
  }();
  return record;
}

const Record<model::BedPoint>& hole_place_record() {
  static const auto record =
      Record<model::BedPoint>("where a hole was commanded")
          .required("x_mm", &model::BedPoint::x_mm, number({"mm", -20000.0, 20000.0}))
          .required("y_mm", &model::BedPoint::y_mm, number({"mm", -20000.0, 20000.0}));
  return record;
}

void add_end(Record<BeltDistance>& record, const std::string& key, BeltEnd BeltDistance::*member) {
  const std::string expected =
      "a point's number, an anchor (tl, tr, bl, br), or a hole as {\"x_mm\": .., \"y_mm\": ..}";
  record.custom(
      key,
      true,
      {expected,
       [] {
         const auto anchor = one_of({"tl", "tr", "bl", "br"});
         return Json{{"oneOf",
                      {{{"type", "integer"}, {"minimum", 0}},
                       anchor.expected.schema(),
                       hole_place_record().schema()}}};
       }},
      [member, expected](const Cursor& at, BeltDistance& distance) {
        constexpr int kMostPoints = 100000;
        if (at.json().is_number()) {
          if (const auto index = at.integer(0, kMostPoints))
            distance.*member = static_cast<std::size_t>(*index);
        } else if (at.json().is_object()) {
          if (const auto hole = hole_place_record().read(at)) distance.*member = CutHole{*hole};
        } else {
          const auto belt = at.json().is_string()
                                ? model::belt_of(at.json().get_ref<const std::string&>())
                                : std::nullopt;
          if (!belt) return at.expect(expected);
          distance.*member = *belt;
        }
      },
      [member](const BeltDistance& distance) -> std::optional<Json> {
        const BeltEnd& end = distance.*member;
        if (const auto* index = std::get_if<std::size_t>(&end)) return Json(*index);
        if (const auto* belt = std::get_if<Belt>(&end)) return Json(std::string(name(*belt)));
        return hole_place_record().write(std::get<CutHole>(end).commanded);
      });
}

const Record<BeltDistance>& belt_distance_record() {
  static const auto record = [] {
    Record<BeltDistance> distance("a taped distance");
    add_end(distance, "from", &BeltDistance::from);
    add_end(distance, "to", &BeltDistance::to);
    distance.required("distance_mm", &BeltDistance::distance_mm, number(kBeltDistanceMm))
        .optional("sigma_mm", &BeltDistance::sigma_mm, number(kTapeSigmaMm));
    return distance;
  }();
  return record;
}

}  // namespace

const Record<FirmwareFit>& firmware_fit_record() {
  constexpr Range kMisfit{"mm", 0.0, 10000.0};
  static const auto record = Record<FirmwareFit>("the machine's own words of its fit")
                                 .required("rms_mm", &FirmwareFit::rms_mm, number(kMisfit))
                                 .required("max_mm", &FirmwareFit::max_mm, number(kMisfit));
  return record;
}

const Record<BeltPrediction>& prediction_record() {
  static const auto record =
      Record<BeltPrediction>("what was predicted")
          .custom(
              "readings",
              true,
              {"a whole number", integer(0, kMostReadings).expected.schema},
              [](const Cursor& at, BeltPrediction& f) {
                if (const auto count = at.integer(0, kMostReadings))
                  f.readings = static_cast<std::size_t>(*count);
              },
              [](const BeltPrediction& f) { return std::optional<Json>(f.readings); })
          .required("rms_mm", &BeltPrediction::rms_mm, number(kSpreadMm))
          .required("largest_mm", &BeltPrediction::largest_mm, number(kSpreadMm));
  return record;
}

const Record<BeltScale>& scale_record() {
  static const auto record =
      Record<BeltScale>("a scale")
          .required("factor", &BeltScale::factor, number({"", 0.1, 10.0}))
          .required("sigma", &BeltScale::sigma, number({"", 0.0, 10.0}))
          .required("residuals_mm", &BeltScale::residuals_mm, list(number(kMisfitMm)));
  return record;
}

const Record<BeltMachine>& belt_machine_record() {
  static const auto record = [] {
    Record<BeltMachine> machine("a machine with four belts");
    machine.optional("name", &BeltMachine::name, text())
        .custom("anchors", false, anchors_record().expected(), read_anchors, written_anchors)
        .custom(
            "belt",
            false,
            belt_record().expected(),
            [](const Cursor& at, BeltMachine& m) {
              if (const auto belt = object(belt_record()).read(at)) m.belt_turn_mm = belt->turn_mm;
            },
            [](const BeltMachine& m) {
              return std::optional<Json>(belt_record().write({m.belt_turn_mm}));
            })
        .optional("arm_mm", &BeltMachine::arm_mm, number_in("mm"))
        .optional("end_extension_mm", &BeltMachine::end_extension_mm, number_in("mm"))
        .optional("surface_mm", &BeltMachine::surface_mm, number_in("mm"))
        .optional("orientation",
                  &BeltMachine::orientation,
                  choice<model::Orientation>({{"upright", model::Orientation::upright},
                                              {"flat", model::Orientation::flat}}))
        .optional("lengths",
                  &BeltMachine::lengths,
                  choice<model::BeltLengths>({{"belt", model::BeltLengths::belt},
                                              {"belt_and_arm", model::BeltLengths::belt_and_arm},
                                              {"span", model::BeltLengths::span}}))
        .optional("scale_x", &BeltMachine::scale_x, number_in(""))
        .optional("scale_y", &BeltMachine::scale_y, number_in(""))
        .optional("setting_names",
                  &BeltMachine::setting_names,
                  choice<model::SettingNames>({{"in_kinematics", model::SettingNames::in_kinematics},
                                               {"top_level", model::SettingNames::top_level}}))
        .check(check_machine);
    return machine;
  }();
  return record;
}

const Record<MeasuredBelts>& belts_record() {
  static const auto record =
      Record<MeasuredBelts>("a chaintrue_belts file", kBeltsFormat)
          .sparse("name", &MeasuredBelts::name, text())
          .optional("machine", &MeasuredBelts::machine, object(belt_machine_record()))
          .required("points", &MeasuredBelts::points, list(object(belt_point_record())))
          .sparse("distances", &MeasuredBelts::distances, list(object(belt_distance_record())))
          .optional("firmware_fit", &MeasuredBelts::firmware_fit, object(firmware_fit_record()));
  return record;
}

Json belts_schema() { return belts_record().schema(); }

}  // namespace chaintrue::grid::files
