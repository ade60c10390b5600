// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/machine_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/files/effect_record.hpp"
#include "grid/files/machine_checks.hpp"
#include "grid/files/machine_record.hpp"
#include "grid/files/names.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/schemas.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Bed;
using model::Brackets;
using model::Chain;
using model::ChainLengths;
using model::Controller;
using model::ControllerSettings;
using model::Feed;
using model::Frame;
using model::Machine;
using model::MotorPosition;
using model::PerSide;
using model::Ring;
using model::Sled;
using model::Sprocket;
using model::Uncertainty;

auto bed_record() {
  return Record<Bed>("a bed")
      .required(
          "width_mm", "Width of the sheet that the machine can cut.", &Bed::width_mm, kMillimetres)
      .required("height_mm",
                "Height of that sheet. The origin of all coordinates is "
                "its middle, x to the right, y up.",
                &Bed::height_mm,
                kMillimetres);
}

auto motor_record() {
  return Record<MotorPosition>("a motor's position")
      .place("x of the motor's axis, from the middle of the bed to the right.",
             "y of the motor's axis, up from the middle of the bed.",
             kMillimetres);
}

auto motors_record() {
  using Motors = PerSide<MotorPosition>;
  return Record<Motors>("the motors")
      .required("left", "The left motor.", &Motors::left, motor_record())
      .required("right", "The right motor.", &Motors::right, motor_record());
}

auto sprocket_record() {
  return Record<Sprocket>("a sprocket")
      .required("teeth", "Number of teeth of a sprocket.", &Sprocket::teeth, integer(1, 1000))
      .required("pitch_mm", "The chain's pitch, one link.", &Sprocket::pitch_mm, kMillimetres)
      .optional("radius_mm",
                "Radius of the chain on the sprocket; default: pitch times teeth over 2 pi.",
                &Sprocket::radius_mm,
                kMillimetres);
}

auto ring_record() {
  return Record<Ring>("a ring")
      .constant("kind", "A ring or a linkage: both chains point at the bit.", "ring")
      .required("radius_mm",
                "From the bit to a chain's end; 0 if the chains end at the bit, otherwise at "
                "least 20 mm.",
                &Ring::radius_mm,
                kMillimetres);
}

auto brackets_record() {
  return Record<Brackets>("a pair of brackets")
      .constant("kind", "The chains end at two brackets of the sled.", "brackets")
      .required("spacing_mm",
                "Distance between the ends of the two chains.",
                &Brackets::spacing_mm,
                kMillimetres)
      .required("height_mm",
                "Height of the chains' ends above the bit.",
                &Brackets::height_mm,
                kMillimetres)
      .required("cg_below_bit_mm",
                "Distance of the sled's centre of gravity below the bit.",
                &Brackets::cg_below_bit_mm,
                kMillimetres);
}

void read_attachment(const Cursor& at, Machine& machine) {
  if (!at.json().is_object()) return at.expect(R"(an object with "kind": "ring" or "brackets")");
  const Cursor kind = at.child("kind");
  if (!at.has("kind")) return kind.missing(R"("ring" or "brackets")");
  const auto name = one_of({"ring", "brackets"}).read(kind);
  if (name == "ring") {
    if (const auto ring = ring_record().read(at)) machine.attachment = *ring;
  } else if (name) {
    if (const auto brackets = brackets_record().read(at)) machine.attachment = *brackets;
  }
}

Json write_attachment(const Machine& machine) {
  if (const auto* ring = std::get_if<Ring>(&machine.attachment)) return ring_record().write(*ring);
  return brackets_record().write(std::get<Brackets>(machine.attachment));
}

auto chain_record() {
  return Record<Chain>("a chain")
      .required(
          "mass_kg_per_m", "Mass of a metre of chain.", &Chain::mass_kg_per_m, number_in("kg/m"))
      .required("compliance_per_n",
                "Strain of the chain per newton; 0: none.",
                &Chain::compliance_per_n,
                number_in("1/N"));
}

auto chain_zero_record() {
  return Record<ChainLengths>("the chain zeros")
      .optional("left_mm",
                "Added to every reading of the left chain.",
                &ChainLengths::left_mm,
                kMillimetres)
      .optional("right_mm",
                "Added to every reading of the right chain.",
                &ChainLengths::right_mm,
                kMillimetres);
}

auto sled_record() {
  return Record<Sled>("a sled").required(
      "mass_kg", "Mass of the sled with its router.", &Sled::mass_kg, number_in("kg"));
}

auto frame_record() {
  return Record<Frame>("a frame").required("tilt_from_vertical_deg",
                                           "Angle by which the frame leans back; 0: upright.",
                                           &Frame::tilt_from_vertical_deg,
                                           number_in("degrees"));
}

auto uncertainty_record() {
  return Record<Uncertainty>("the uncertainties")
      .optional("motor_position_mm",
                "Uncertainty of each coordinate of a motor, 1 sigma.",
                &Uncertainty::motor_position_mm,
                kMillimetres)
      .optional("chain_zero_mm",
                "Uncertainty of each chain's zero, 1 sigma.",
                &Uncertainty::chain_zero_mm,
                kMillimetres)
      .optional("ring_radius_mm",
                "Uncertainty of the ring's radius, 1 sigma.",
                &Uncertainty::ring_radius_mm,
                kMillimetres)
      .check([](const Cursor& at, Uncertainty&) {
        for (const char* key : {"motor_position_mm", "chain_zero_mm", "ring_radius_mm"}) {
          const Cursor value = at.child(key);
          if (!at.has(key) || value.json().is_null()) value.warn("missing; its default is assumed");
        }
      });
}

auto controller_record() {
  return Record<Controller>("a controller")
      .required("kind",
                "The firmware, whose kinematics converts commands into chain lengths. ideal "
                "uses the machine file as it is.",
                &Controller::kind,
                choice(kControllerKinds))
      .optional("settings",
                "The firmware's settings, by GroundControl's names.",
                &Controller::settings,
                controller_settings_record());
}

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
  if (!at.has("uncertainty") || at.child("uncertainty").json().is_null()) {
    const Uncertainty& assumed = machine.uncertainty;
    at.child("uncertainty")
        .warn(fmt::format("missing; assumed: motor positions within {} mm, chain zeros within {} "
                          "mm and the ring's radius within {} mm (1 sigma)",
                          assumed.motor_position_mm,
                          assumed.chain_zero_mm,
                          assumed.ring_radius_mm));
  }
  if (is_in_other_unit(machine)) {
    const OtherUnit unit = other_unit(machine.bed.width_mm);
    const auto size = [](double width, double height) {
      return fmt::format("{:.6g} x {:.6g}", width, height);
    };
    at.problems().explain(
        at.pointer(),
        ProblemKind::other_unit,
        fmt::format("these look like {}: multiply all lengths by {:g}. The bed is then {} mm; it "
                    "is {} now.",
                    unit.word,
                    unit.mm,
                    size(machine.bed.width_mm * unit.mm, machine.bed.height_mm * unit.mm),
                    size(machine.bed.width_mm, machine.bed.height_mm)));
    return;
  }
  report_impossible(at, model::problems_of(machine));
  // The sums of effects and machine are checked only if the machine itself is valid.
  if (!at.clean()) return;
  check_declared_on_bed(at.child("declared_effects"), machine);
  for (const model::MachineProblem& problem : model::effects::problems_of_effects(machine)) {
    at.problems().add(at.pointer() + problem.parameter, problem);
  }
}

/// An object without keys is probably a question about the required keys: list them all.
void refuse_emptiness(const std::string& text, Problems& problems) {
  if (text.find_first_not_of(" \t\r\n{}") != std::string::npos ||
      text.find('{') == std::string::npos)
    return;
  problems.add("",
               "an empty machine",
               ProblemKind::missing,
               "a machine; chaintrue start writes one to fill in, with every key explained");
  problems.throw_if_any();
}

}  // namespace

Record<ControllerSettings> controller_settings_record() {
  using Settings = ControllerSettings;
  return Record<Settings>("the controller's settings, named as GroundControl names them,")
      .optional("bedwidth", "GroundControl's bedwidth.", &Settings::bed_width_mm, kMillimetres)
      .optional("bedheight", "GroundControl's bedheight.", &Settings::bed_height_mm, kMillimetres)
      .optional("motorspacingx",
                "Distance between the motors' axes.",
                &Settings::motor_spacing_mm,
                kMillimetres)
      .optional("motoroffsety",
                "Height of the motors above the bed's upper edge.",
                &Settings::motor_offset_y_mm,
                kMillimetres)
      .optional("rotationradius",
                "Distance from the bit to a chain's end.",
                &Settings::rotation_radius_mm,
                kMillimetres)
      .optional("sledwidth",
                "For a sled on brackets: distance between the brackets.",
                &Settings::sled_width_mm,
                kMillimetres)
      .optional("sledheight",
                "For a sled on brackets: height of the brackets above the bit.",
                &Settings::sled_height_mm,
                kMillimetres)
      .optional("sledcg",
                "For a sled on brackets: distance of its centre of gravity below the bit.",
                &Settings::sled_cg_mm,
                kMillimetres)
      .optional("chainsagcorrection",
                "Factor of the firmware's parabola for the chain's sag.",
                &Settings::chain_sag_correction,
                number_in("1e-12 / mm^2"))
      .optional("leftchaintolerance",
                "Excess length of the left chain's links.",
                &Settings::left_chain_tolerance_percent,
                number_in("percent"))
      .optional("rightchaintolerance",
                "Excess length of the right chain's links.",
                &Settings::right_chain_tolerance_percent,
                number_in("percent"))
      .optional(
          "topbeamtilt", "Tilt of the beam.", &Settings::top_beam_tilt_deg, number_in("degrees"))
      .optional("chainpitch", "Length of a link.", &Settings::chain_pitch_mm, kMillimetres)
      .optional(
          "gearteeth", "Number of teeth of a sprocket.", &Settings::gear_teeth, number_in("teeth"))
      .optional("chainoversprocket",
                "Side of the sprocket over which the chain leaves.",
                &Settings::chain_over_sprocket_top,
                choice<bool>({{"Top", true}, {"Bottom", false}}))
      .optional("sledweight", "Weight of the sled.", &Settings::sled_weight_n, number_in("N"))
      .optional("chainelongationfactor",
                "Stretch of the chain per newton.",
                &Settings::chain_elongation_per_n,
                number_in("1/N"));
}

Record<model::AppliedEffect> effect_record() {
  using model::AppliedEffect;
  return Record<AppliedEffect>("an effect")
      .required("effect", "Its name, as chaintrue effects lists them.", &AppliedEffect::effect)
      .sparse("side",
              "Where it acts; none for effects without a side.",
              &AppliedEffect::side,
              one_of({"left", "right", "both", "x", "y"}))
      .required("parameters",
                "Its size and other parameters, by name.",
                &AppliedEffect::parameters,
                dictionary(number_in("")))
      .optional("probability",
                "Its probability, if a diagnosis added it; otherwise absent.",
                &AppliedEffect::probability,
                kShare);
}

const Record<Machine>& machine_record() {
  static const auto record =
      Record<Machine>("a machine", kMachineFormat)
          .optional("name", "Name of the machine in messages and pages.", &Machine::name)
          .required("bed", "The sheet that the machine can cut.", &Machine::bed, bed_record())
          .required("motors", "Positions of the motors' axes.", &Machine::motors, motors_record())
          .required("sprocket", "The sprocket on a motor.", &Machine::sprocket, sprocket_record())
          .required("feed",
                    "Side of the sprocket over which the chain leaves.",
                    &Machine::feed,
                    choice(kFeeds))
          .custom("attachment",
                  "How the chains are attached to the sled.",
                  true,
                  {"a ring or brackets",
                   [] {
                     return Json{{"oneOf", {ring_record().schema(), brackets_record().schema()}}};
                   }},
                  read_attachment,
                  write_attachment)
          .required("chain", "The chain's mass and stretch.", &Machine::chain, chain_record())
          .optional("chain_zero",
                    "Added to every reading of a chain.",
                    &Machine::chain_zero,
                    chain_zero_record())
          .required("sled", "The sled.", &Machine::sled, sled_record())
          .required("frame", "The frame that carries everything.", &Machine::frame, frame_record())
          .optional("uncertainty",
                    "How accurately motors, zeros and ring were measured, 1 sigma. Missing values "
                    "are assumed and reported.",
                    &Machine::uncertainty,
                    uncertainty_record())
          .sparse(
              "controller",
              "The firmware and its settings; default: an ideal one that uses the machine file as "
              "it is.",
              &Machine::controller,
              controller_record())
          .custom(
              "declared_effects",
              "User-declared effects that may act on it, each with the keys of a chaintrue_effect "
              "file.",
              false,
              declared_expected(),
              [](const Cursor& at, Machine& machine) { read_declared(at, machine.declared); },
              [](const Machine& machine) { return write_declared(machine.declared); })
          .sparse("effects",
                  "Known causes of error, part of the machine.",
                  &Machine::effects,
                  effect_record())
          .check(check_machine);
  return record;
}

ReadMachine parse_machine(const std::string& text, const std::string& file) {
  Problems problems(file);
  refuse_emptiness(text, problems);
  Machine machine = read_document(machine_record(), text, problems);
  return {std::move(machine), problems.warnings()};
}

std::string write_machine(const Machine& machine, const std::vector<std::string>& comments) {
  Json json = machine_record().write(machine);
  if (!comments.empty()) json["comment"] = comments;
  return print_json(json);
}

Json machine_schema() { return machine_record().schema(); }

}  // namespace chaintrue::grid::files
