// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/machine_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/files/groundcontrol_settings.hpp"
#include "grid/files/machine_checks.hpp"
#include "grid/files/names.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Uncertainty;

RECORD_OF(Bed, "a bed")
REQUIRED(width_mm, "Width of the sheet that the machine can cut.", kMillimetres)
REQUIRED(height_mm,
         "Height of that sheet. The origin of all coordinates is "
         "its middle, x to the right, y up.",
         kMillimetres)
END_RECORD;

RECORD_OF(model::MotorPosition, "a motor's position")
FIELD(place, "x of the motor's axis, from the middle of the bed to the right.",
      "y of the motor's axis, up from the middle of the bed.", kMillimetres)
END_RECORD;

RECORD_OF(PerSide<model::MotorPosition>, "the motors")
REQUIRED(left, "The left motor.")
REQUIRED(right, "The right motor.")
END_RECORD;

RECORD_OF(model::Sprocket, "a sprocket")
REQUIRED(teeth, "Number of teeth of a sprocket.", integer(1, 1000))
REQUIRED(pitch_mm, "The chain's pitch, one link.", kMillimetres)
OPTIONAL(radius_mm, "Radius of the chain on the sprocket; default: pitch times teeth over 2 pi.",
         kMillimetres)
END_RECORD;

auto ring_record() {
  RECORD(Ring, "a ring")
  FIELD(constant, "kind", "A ring or a linkage: both chains point at the bit.", "ring")
  REQUIRED(radius_mm,
           "From the bit to a chain's end; 0 if the chains end at the bit, otherwise at "
           "least 20 mm.",
           kMillimetres);
}

auto brackets_record() {
  RECORD(model::Brackets, "a pair of brackets")
  FIELD(constant, "kind", "The chains end at two brackets of the sled.", "brackets")
  REQUIRED(spacing_mm, "Distance between the ends of the two chains.", kMillimetres)
  REQUIRED(height_mm, "Height of the chains' ends above the bit.", kMillimetres)
  REQUIRED(cg_below_bit_mm, "Distance of the sled's centre of gravity below the bit.",
           kMillimetres);
}

using Attachment = decltype(Machine::attachment);

std::optional<Attachment> read_attachment(const Cursor& at) {
  if (!at.json().is_object()) {
    at.expect(R"(an object with "kind": "ring" or "brackets")");
  } else if (!at.has("kind")) {
    at.child("kind").missing(R"("ring" or "brackets")");
  } else if (const auto kind = one_of({"ring", "brackets"}).read(at.child("kind"))) {
    if (*kind == "ring") return ring_record().read(at);
    return brackets_record().read(at);
  }
  return std::nullopt;
}

Json write_attachment(const Attachment& attachment) {
  if (const auto* ring = std::get_if<Ring>(&attachment)) return ring_record().write(*ring);
  return brackets_record().write(std::get<model::Brackets>(attachment));
}

Value<Attachment> attachment_value() {
  return {
      read_attachment,
      write_attachment,
      {"a ring or brackets", {{"oneOf", {ring_record().schema(), brackets_record().schema()}}}}};
}

RECORD_OF(model::Chain, "a chain")
REQUIRED(mass_kg_per_m, "Mass of a metre of chain.", number_in("kg/m"))
REQUIRED(compliance_per_n, "Strain of the chain per newton; 0: none.", number_in("1/N"))
END_RECORD;

auto chain_zero_record() {
  RECORD(ChainLengths, "the chain zeros")
  OPTIONAL(left_mm, "Added to every reading of the left chain.", kMillimetres)
  OPTIONAL(right_mm, "Added to every reading of the right chain.", kMillimetres);
}

RECORD_OF(model::Sled, "a sled")
REQUIRED(mass_kg, "Mass of the sled with its router.", number_in("kg"))
END_RECORD;

RECORD_OF(model::Frame, "a frame")
REQUIRED(tilt_from_vertical_deg, "Angle by which the frame leans back; 0: upright.",
         number_in("degrees"))
END_RECORD;

RECORD_OF(Uncertainty, "the uncertainties")
OPTIONAL(motor_position_mm, "Uncertainty of each coordinate of a motor, 1 sigma.", kMillimetres)
OPTIONAL(chain_zero_mm, "Uncertainty of each chain's zero, 1 sigma.", kMillimetres)
OPTIONAL(ring_radius_mm, "Uncertainty of the ring's radius, 1 sigma.", kMillimetres)
    .check([](const Cursor& at, Uncertainty&) {
      for (const char* key : {"motor_position_mm", "chain_zero_mm", "ring_radius_mm"}) {
        if (at.is_null(key)) at.child(key).warn("missing; its default is assumed");
      }
    }) END_RECORD;

RECORD_OF(model::Controller, "a controller")
REQUIRED(kind,
         "The firmware, whose kinematics converts commands into chain lengths. ideal "
         "uses the machine file as it is.",
         in_order<ControllerKind>(kControllerKinds))
OPTIONAL(settings, "The firmware's settings, by GroundControl's names.",
         controller_settings_record())
END_RECORD;

/// No hanging router has a bed and motors below this in mm; in inches and centimetres all are below
/// it.
bool is_in_other_unit(const Machine& machine) {
  constexpr double kLongest = 250.0;
  constexpr double kShortest = 10.0;
  const auto is_small = [](double length, double longest) {
    return std::abs(length) <= longest && std::abs(length) >= kShortest;
  };
  return is_small(machine.bed.width_mm, kWidestOfOtherUnit) &&
         is_small(machine.bed.height_mm, kLongest) &&
         is_small(machine.motors.left.x_mm, kLongest) &&
         is_small(machine.motors.right.x_mm, kLongest);
}

void check_machine(const Cursor& at, Machine& machine) {
  // The struct's default name does not apply to this file's machine.
  if (!at.has("name")) machine.name.clear();
  if (at.is_null("uncertainty")) {
    const Uncertainty& assumed = machine.uncertainty;
    at.child("uncertainty")
        .warn(fmt::format("missing; assumed: motor positions within {} mm, chain zeros within {} "
                          "mm and the ring's radius within {} mm (1 sigma)",
                          assumed.motor_position_mm, assumed.chain_zero_mm,
                          assumed.ring_radius_mm));
  }
  if (is_in_other_unit(machine)) {
    const auto unit = other_unit(machine.bed.width_mm);
    const auto size = [](double width, double height) {
      return fmt::format("{:.6g} x {:.6g}", width, height);
    };
    at.problems().explain(
        at.pointer(), ProblemKind::other_unit,
        fmt::format("these look like {}: multiply all lengths by {:g}. The bed is then {} mm; it "
                    "is {} now.",
                    unit.word, unit.mm,
                    size(machine.bed.width_mm * unit.mm, machine.bed.height_mm * unit.mm),
                    size(machine.bed.width_mm, machine.bed.height_mm)));
    return;
  }
  report_impossible(at, problems_of(machine));
  // The sums of effects and machine are checked only if the machine itself is valid.
  if (!at.clean()) return;
  check_declared_on_bed(at.child("declared_effects"), machine);
  for (const MachineProblem& problem : model::effects::problems_of_effects(machine)) {
    at.problems().add(at.pointer() + problem.parameter, problem);
  }
}

/// An object without keys is probably a question about the required keys: list them all.
void refuse_emptiness(const std::string& text, Problems& problems) {
  if (text.find_first_not_of(" \t\r\n{}") != npos || !has(text, '{')) return;
  problems.add("", "an empty machine", ProblemKind::missing,
               "a machine; chaintrue start writes one to fill in, with every key explained");
  problems.throw_if_any();
}

}  // namespace

Record<ControllerSettings> controller_settings_record() {
  Record<ControllerSettings> settings(
      "the controller's settings, named as GroundControl names them,");
  for (const NumberKey& own : kNumberKeys) {
    // The only setting in words has its place among them.
    if (own.setting == &ControllerSettings::sled_weight_n) {
      settings.optional("chainoversprocket", "Side of the sprocket over which the chain leaves.",
                        &ControllerSettings::chain_over_sprocket_top,
                        choice_of<bool>({{"Top", true}, {"Bottom", false}}));
    }
    settings.optional(own.key, own.meaning, own.setting, number_in(own.range.unit));
  }
  return settings;
}

RECORD_OF(AppliedEffect, "an effect")
REQUIRED(effect, "Its name, as chaintrue effects lists them.")
SPARSE(side, "Where it acts; none for effects without a side.",
       one_of({"left", "right", "both", "x", "y"}))
REQUIRED(parameters, "Its size and other parameters, by name.", dictionary(number_in("")))
OPTIONAL(probability, "Its probability, if a diagnosis added it; otherwise absent.", kShare)
END_RECORD;

FILE_RECORD(machine, Machine, "a machine", kMachineFormat)
OPTIONAL(name, "Name of the machine in messages and pages.")
REQUIRED(bed, "The sheet that the machine can cut.")
REQUIRED(motors, "Positions of the motors' axes.")
REQUIRED(sprocket, "The sprocket on a motor.")
REQUIRED(feed, "Side of the sprocket over which the chain leaves.", in_order<Feed>(kFeeds))
REQUIRED(attachment, "How the chains are attached to the sled.", attachment_value())
REQUIRED(chain, "The chain's mass and stretch.")
OPTIONAL(chain_zero, "Added to every reading of a chain.", chain_zero_record())
REQUIRED(sled, "The sled.")
REQUIRED(frame, "The frame that carries everything.")
OPTIONAL(uncertainty,
         "How accurately motors, zeros and ring were measured, 1 sigma. Missing values "
         "are assumed and reported.")
SPARSE(controller,
       "The firmware and its settings; default: an ideal one that uses the machine file as "
       "it is.")
NAMED(sparse, "declared_effects", declared,
      "User-declared effects that may act on it, each with the keys of a chaintrue_effect "
      "file.",
      declared_value())
SPARSE(effects, "Known causes of error, part of the machine.").check(check_machine) END_FILE_RECORD;

ReadMachine parse_machine(const std::string& text, const std::string& file) {
  Problems problems(file);
  refuse_emptiness(text, problems);
  Machine machine = read_document(machine_record(), text, problems);
  return {std::move(machine), problems.warnings()};
}

std::string write_machine(const Machine& machine, const Words& comments) {
  Json json = machine_record().write(machine);
  if (!comments.empty()) json["comment"] = comments;
  return print_json(json);
}

}  // namespace chaintrue::grid::files
