// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/belts_record.hpp"

#include <fmt/format.h>

#include <tuple>

#include "grid/containers.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"

namespace chaintrue::grid::files {
namespace {

struct StatedAnchor {
  std::optional<double> x_mm;
  std::optional<double> y_mm;
  std::optional<double> z_mm;
};

RECORD_OF(StatedAnchor, "an anchor")
OPTIONAL(x_mm,
         "x of the point where the belt leaves the frame, to the right of the bottom "
         "left anchor. Given for all four anchors or for none.",
         kMillimetres)
OPTIONAL(y_mm, "y of that point, up from the bottom left anchor; 0 for the bottom right anchor.",
         kMillimetres)
OPTIONAL(z_mm, "Its height above the bed; default: the firmware's.", kMillimetres)
END_RECORD;

auto four_anchors_record() {
  RECORD(PerBelt<StatedAnchor>, "four anchors")
  REQUIRED(tl, "Top left.")
  REQUIRED(tr, "Top right.")
  REQUIRED(bl, "Bottom left, the origin.")
  REQUIRED(br, "Bottom right, on the x axis.");
}

void read_anchors(const Cursor& at, BeltMachine& machine) {
  const auto stated = four_anchors_record().read(at);
  if (!stated) return;
  int known = 0;
  for (const Belt belt : kBelts) {
    const StatedAnchor& anchor = (*stated)[belt];
    model::Anchor& own = machine.anchors[belt];
    own = {anchor.x_mm.value_or(0.0), anchor.y_mm.value_or(0.0), anchor.z_mm.value_or(own.z_mm)};
    known += (anchor.x_mm ? 1 : 0) + (anchor.y_mm ? 1 : 0);
  }
  machine.anchors_known = known == 8;
  if (known != 0 && known != 8 && at.clean()) {
    at.report(fmt::format("{} of eight coordinates", known), ProblemKind::missing,
              "x_mm and y_mm of all four anchors, or of none if they are not known yet");
  }
}

Json written_anchors(const BeltMachine& machine) {
  PerBelt<StatedAnchor> stated;
  for (const Belt belt : kBelts) {
    const model::Anchor& own = machine.anchors[belt];
    stated[belt].z_mm = own.z_mm;
    if (!machine.anchors_known) continue;
    stated[belt].x_mm = own.x_mm;
    stated[belt].y_mm = own.y_mm;
  }
  return four_anchors_record().write(stated);
}

auto belt_record() {
  RECORD(BeltMachine, "a belt")
  NAMED(optional, "turn_mm", belt_turn_mm, "Belt length for one turn of the encoder.",
        kMillimetres);
}

constexpr Range kPull{"", 1e-3, 1e6};

/// One key for each unit.
void add_pull(Record<BeltPoint>& record) {
  using Unit = BeltPull::Unit;
  constexpr std::tuple<const char*, const char*, Unit> kKeys[] = {
      {"pull_n", "Tension of the pulled belts, N; given for all places or for none.", Unit::newton},
      {"pull_ma", "Current of the motors instead, mA; the force is assumed proportional to it.",
       Unit::milliampere},
      {"pull",
       "Relative tension, if neither is known. Sizes of a stretch and of a yielding anchor refer "
       "to "
       "the lowest.",
       Unit::relative}};
  for (const auto& [key, meaning, unit] : kKeys) {
    const Unit own = unit;
    record.custom(
        key, meaning, false, number(kPull).expected,
        [own](const Cursor& at, BeltPoint& point) {
          const auto value = number(kPull).read(at);
          if (!value) return;
          if (point.pull) at.expect("one of pull_n, pull_ma and pull");
          point.pull = BeltPull{*value, own};
        },
        [own](const BeltPoint& point) {
          return point.pull && point.pull->unit == own ? Json(point.pull->value) : kLeftOut;
        });
  }
}

using ThrownAway = PerBelt<std::vector<double>>;

RECORD_OF(ThrownAway, "lengths of each belt")
NAMED(sparse, "tl_mm", tl, "Top left.", list(kLengthMm))
NAMED(sparse, "tr_mm", tr, "Top right.", list(kLengthMm))
NAMED(sparse, "bl_mm", bl, "Bottom left.", list(kLengthMm))
NAMED(sparse, "br_mm", br, "Bottom right.", list(kLengthMm))
END_RECORD;

void add_lengths(Record<BeltPoint>& record) {
  using Lengths = PerBelt<double>;
  const auto length = [&](const char* key, const char* meaning, double Lengths::*belt) {
    record.required(key, meaning, path(&BeltPoint::lengths_mm, belt), kLengthMm);
  };
  length("tl_mm",
         "Length of the top left belt as the controller prints it; the machine's lengths defines "
         "its meaning.",
         &Lengths::tl);
  length("tr_mm", "Length of the top right belt.", &Lengths::tr);
  length("bl_mm", "Length of the bottom left belt.", &Lengths::bl);
  length("br_mm", "Length of the bottom right belt.", &Lengths::br);
}

constexpr int kMostReadings = 400000;

void add_command(Record<BeltPoint>& record) {
  record.optional("commanded_x_mm", "Commanded x, from the crossing of the frame's diagonals.",
                  path(&BeltPoint::commanded, &BedPoint::x_mm), kCoordinateMm);
  record.optional("commanded_y_mm", "Commanded y, up from there.",
                  path(&BeltPoint::commanded, &BedPoint::y_mm), kCoordinateMm);
  record.check([](const Cursor& at, BeltPoint&) {
    if (at.has("commanded_x_mm") == at.has("commanded_y_mm")) return;
    const char* lacking = at.has("commanded_x_mm") ? "commanded_y_mm" : "commanded_x_mm";
    at.child(lacking).missing("both coordinates of the command, or none");
  });
}

RECORD_OF(BeltPoint, "a place")
ALSO(add_lengths)
ALSO(add_command)
OPTIONAL(order, "Number of the visit. Either all places have one, all different, or none has.",
         integer(0, 1000000))
FIELD(
    computed, "pulled",
    "Belts that a motor tensioned at the reading while the others held; default: those for the "
    "frame's orientation.",
    false, list(belt_word()),
    [](BeltPoint& p, const std::vector<Belt>& found) {
      p.pulled.emplace();
      for (const Belt belt : kBelts) {
        if (contains(found, belt)) p.pulled->push_back(belt);
      }
    },
    &BeltPoint::pulled)
ALSO(add_pull)
NAMED(sparse, "thrown_away", thrown_away_mm, "Single readings that the controller discarded here.")
END_RECORD;

auto hole_place_record() {
  RECORD(BedPoint, "where a hole was commanded")
  FIELD(place, "Commanded x, to the right of the crossing of the frame's diagonals.",
        "Commanded y, up from there.", kCoordinateMm);
}

Value<BeltEnd> end_of_distance() {
  const std::string expected =
      "a point's number, an anchor (tl, tr, bl, br), or a hole as {\"x_mm\": .., \"y_mm\": ..}";
  return {[expected](const Cursor& at) -> std::optional<BeltEnd> {
            constexpr int kMostPoints = 100000;
            if (at.json().is_number()) return index_number(0, kMostPoints).read(at);
            if (at.json().is_object()) {
              const auto hole = hole_place_record().read(at);
              return hole ? std::optional<BeltEnd>(CutHole{*hole}) : std::nullopt;
            }
            const auto belt = at.json().is_string()
                                  ? model::belt_of(at.json().get_ref<const std::string&>())
                                  : std::nullopt;
            if (!belt) at.expect(expected);
            return belt;
          },
          [](const BeltEnd& end) -> Json {
            if (const auto* index = std::get_if<std::size_t>(&end)) return *index;
            if (const auto* belt = std::get_if<Belt>(&end)) return name(*belt);
            return hole_place_record().write(std::get<CutHole>(end).commanded);
          },
          {expected,
           {{"oneOf",
             {{{"type", "integer"}, {"minimum", 0}},
              belt_word().expected.schema,
              hole_place_record().schema()}}}}};
}

RECORD_OF(BeltDistance, "a taped distance")
REQUIRED(from, "A place by its number from 0, an anchor, or a hole cut by the machine.",
         end_of_distance())
REQUIRED(to, "The other end, in the same form.", end_of_distance())
REQUIRED(distance_mm, "The tape reading.", kLengthMm)
OPTIONAL(sigma_mm, "Noise of this reading, 1 sigma.", kTapeSigmaMm)
END_RECORD;

}  // namespace

constexpr Range kMisfit{"mm", 0.0, 10000.0};
RECORD_OF(FirmwareFit, "the machine's own words of its fit")
REQUIRED(rms_mm, "Its rms, as it prints it.", kMisfit)
REQUIRED(max_mm, "Its largest misfit.", kMisfit)
END_RECORD;

RECORD_OF(BeltPrediction, "what was predicted")
REQUIRED(readings, "Number of predicted readings of lower belts.", index_number(0, kMostReadings))
REQUIRED(rms_mm, "Rms of reading minus prediction.", kSigmaMm)
REQUIRED(largest_mm, "Largest difference.", kSigmaMm)
END_RECORD;

RECORD_OF(BeltScale, "a scale")
REQUIRED(factor, "True length divided by the belts' length.", {"", 0.1, 10.0})
REQUIRED(sigma, "Its uncertainty, 1 sigma.", {"", 0.0, 10.0})
REQUIRED(residuals_mm, "Taped minus fitted, for each distance.", list(kMillimetres))
END_RECORD;

Record<BeltMachine> belt_machine_record() {
  RECORD(BeltMachine, "a machine with four belts")
  OPTIONAL(name, "Name of the machine in messages and pages.")
  FIELD(custom, "anchors", "Where the belts leave the frame; absent: not known yet.", false,
        four_anchors_record().expected(), read_anchors, written_anchors)
  FIELD(part, "belt", "The belts.", false, belt_record())
  OPTIONAL(arm_mm, "From the tool to the point where a belt's end is attached.", kMillimetres)
  OPTIONAL(end_extension_mm, "Length of the belt's end, from its last tooth to the arm.",
           kMillimetres)
  OPTIONAL(surface_mm,
           "Thickness of spoilboard and work together, added to the heights of the anchors.",
           kMillimetres)
  OPTIONAL(orientation, "How the frame stands, which decides which belts are pulled.",
           by_name_to(Orientation::flat))
  OPTIONAL(lengths,
           "What a printed length includes: the belt, the belt with extension and arm, or the "
           "level span from anchor to tool.",
           by_name_to(model::BeltLengths::span))
  OPTIONAL(scale_x, "The controller's factor for commands along x.", number_in(""))
  OPTIONAL(scale_y, "The controller's factor for commands along y.", number_in(""))
  OPTIONAL(setting_names,
           "Names of the firmware's settings: /kinematics/MaslowKinematics/tlX, or /Maslow_tlX at "
           "the top level, as before July 2025.",
           in_order<model::SettingNames>({"in_kinematics", "top_level"}))
      .check([](const Cursor& at, BeltMachine& own) { report_impossible(at, problems_of(own)); });
}

FILE_RECORD(belts, MeasuredBelts, "a chaintrue_belts file", kBeltsFormat)
SPARSE(name, "Name of the set.")
OPTIONAL(machine, "The machine with its settings in force.", belt_machine_record())
REQUIRED(points, "The places, in any order.")
SPARSE(distances, "Taped distances; without one the scale is unknown.")
OPTIONAL(firmware_fit, "The machine's report of its own fit.")
END_FILE_RECORD;

}  // namespace chaintrue::grid::files
