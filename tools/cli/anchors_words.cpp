// SPDX-License-Identifier: GPL-3.0-or-later
// A fit of four belts in words.

#include <fmt/format.h>

#include "grid/belts/scale_by_tape.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "model/belts/belt_effects.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

/// "0.23 +- 0.06 %", of a share.
std::string share_in_words(double share, double sigma) {
  return fmt::format("{:.2f} +- {:.2f} %", 100.0 * share, 100.0 * sigma);
}

/// Words for a cause; empty if it is not in the belts' table.
std::string sized(const grid::CauseInAnchorFit& cause) {
  const Effect* effect = effects::find_effect(model::belts::belt_effects(), cause.effect);
  if (effect == nullptr) return {};
  diagnosis::CauseId id{effect};
  for (const EffectSide side : id.effect->sides) {
    if (effects::name(side) == cause.side) id.side = side;
  }
  const std::string size(id.effect->parameters.front().name);
  return fmt::format("{}{} ({}; {})", id.effect->cause, side_words(id),
                     in_workshop_units(id, {size, cause.parameters.at(size), cause.sigma}),
                     diagnosis::percent(cause.probability));
}

/// Yielding under the pull, which every frame shows, and other causes that are more likely than not.
void list_causes(const BeltsFit& fit, Section& section) {
  constexpr double kLikely = 0.5;
  if (fit.causes.empty()) return;
  Words others;
  for (const grid::CauseInAnchorFit& cause : fit.causes) {
    if (cause.effect == model::belts::anchor_flex.id) {
      section.say(
          "The anchors yield by {:.2f} +- {:.2f} mm at the motors' pull; the fit "
          "allows for this.",
          cause.parameters.at("give_mm"), cause.sigma);
    } else if (cause.effect == model::belts::belt_stretch.id) {
      section.say(
          "At the motors' pull the belts are {} longer than counted; the fit allows for this.",
          share_in_words(cause.parameters.at("elongation"), cause.sigma));
    } else if (cause.probability > kLikely) {
      if (std::string text = sized(cause); !text.empty()) others.push_back(std::move(text));
    }
  }
  if (!others.empty()) {
    section.say("Included in these anchors: {}. chaintrue diagnose shows what to inspect.",
                diagnosis::joined(others, "and"));
  }
  section.say(
      "The anchors' sigmas allow for other causes of usual size, such as a belt with a wrong zero.",
      Detail::verbose);
}

void list_left_out(const BeltsFit& fit, Section& section) {
  if (fit.one_left_out.readings == 0) return;
  std::string text = fmt::format(
      "Lower belts predicted from the upper two, at places left out one by one: {:.2f} mm rms, "
      "{:.2f} mm at worst",
      fit.one_left_out.rms_mm, fit.one_left_out.largest_mm);
  if (fit.half_left_out) {
    text += fmt::format("; each half of the places from the other: {:.2f} and {:.2f} mm",
                        fit.half_left_out->rms_mm, fit.half_left_out->largest_mm);
  }
  section.say(text + ".", Detail::verbose);
}

/// From 1, as in the file of the belts.
std::size_t number_of(const FittedBelts& fitted, std::size_t point) {
  return 1 + grid::index_in_file(fitted.indices, point);
}

void say_bad_readings(const FittedBelts& fitted, Section& section) {
  const BeltsFit& fit = fitted.fit;
  const double turn_mm = fit.machine.belt_turn_mm;
  for (const grid::BadBeltReading& bad : fit.bad) {
    const double turns = bad.residual_mm / turn_mm;
    // To within a twentieth of a turn, which a bad reading reaches by chance one time in ten.
    const bool is_whole = std::abs(turns) > 0.5 && std::abs(turns - std::round(turns)) < 0.05;
    section.say("Left out: the {} belt at point {}, {:.1f} mm {} than predicted by all others{}.",
                words(bad.belt), number_of(fitted, bad.point), std::abs(bad.residual_mm),
                bad.residual_mm > 0.0 ? "longer" : "shorter",
                is_whole
                    ? fmt::format(", {:.0f} whole turn{} of the encoder",
                                  std::abs(std::round(turns)), std::abs(turns) < 1.5 ? "" : "s")
                    : "");
  }
  for (const std::size_t point : fit.bad_points) {
    section.say(
        "Point {} is unusable: fewer than three of its readings agree. Measure "
        "it again or leave it out.",
        number_of(fitted, point));
  }
}

std::string what_tells_the_scale(const FittedBelts& fitted) {
  const auto best = fitted.belts ? distance_for_scale(*fitted.belts, fitted.fit) : std::nullopt;
  if (!best) {
    return "Tape one long distance, between two anchors or two holes that were cut, and add it to "
           "the file's \"distances\".";
  }
  return fmt::format(
      "Tape the distance from {} to {}, about {:.0f} mm, and add it to the file's \"distances\".",
      words_of(best->distance.from, fitted.indices), words_of(best->distance.to, fitted.indices),
      best->distance.distance_mm);
}

void say_the_scale(const FittedBelts& fitted, Section& section) {
  const BeltsFit& fit = fitted.fit;
  if (!fit.scale) {
    section.say("Scale: unknown, because belts do not show it. " + what_tells_the_scale(fitted));
    section.say(fmt::format("Until then anchors and parts are only as accurate as the assumption "
                            "that an encoder turn is {:g} mm of belt.",
                            fit.machine.belt_turn_mm),
                Detail::verbose);
    return;
  }
  section.say(
      "Scale: true lengths are {:.5f} +- {:.5f} times the belts' lengths "
      "according to the tape, {:.1f} mm per metre.",
      fit.scale->factor, fit.scale->sigma, 1000.0 * (fit.scale->factor - 1.0));
  if (fitted.belts == nullptr) return;
  List taped;
  for (const auto i : each_index(fitted.belts->distances)) {
    const grid::BeltDistance& distance = fitted.belts->distances[i];
    taped.items.push_back(
        {fmt::format("{} to {}: taped {:.1f} mm, {:+.2f} mm from the fit",
                     words_of(distance.from, fitted.indices), words_of(distance.to, fitted.indices),
                     distance.distance_mm, fit.scale->residuals_mm[i])});
  }
  section.blocks.emplace_back(std::move(taped));
}

void say_the_holes(const HolesWithBelts& holes, Section& section) {
  section.say("Holes: {} distances, which agree with each other to about {} mm.",
              holes.distances.size(), about_mm(holes.left_out_rms_mm));
  section.say(fmt::format("Each distance is predicted from all others to {:.2f} mm rms; tape and "
                          "holes have {:.2g} times the error that you entered.",
                          holes.left_out_rms_mm, holes.noise_factor),
              Detail::verbose);
  for (const auto& distance : holes.distances) {
    if (!distance.rejected) continue;
    section.say(
        "Left out: the distance {}, taped {:.1f} mm {} than predicted by all others; "
        "tape it again.",
        distance.words, std::abs(distance.left_out_mm),
        distance.left_out_mm > 0.0 ? "longer" : "shorter");
  }
  if (!holes.displacement) {
    return section.say("The holes show no further displacement of the tool over the sheet.");
  }
  double largest = 0.0;
  const auto& at = holes.displacement->at_mm;
  for (Eigen::Index i = 0; i + 1 < at.size(); i += 2)
    largest = std::max(largest, std::hypot(at[i], at[i + 1]));
  section.say(
      "The tool is up to {:.1f} mm from the position given by its upper two "
      "belts; this changes over about {:.0f} mm of the sheet. gcode compensate "
      "corrects it, no setting does.",
      largest, holes.displacement->reach_mm);
}

double least_known_mm(const BeltsFit& fit) {
  return max_element(fit.coordinates, grid::ascending(&grid::AnchorCoordinate::sigma_mm))->sigma_mm;
}

}  // namespace

std::string not_to_paste(const BeltsFit& fit, const std::optional<BeltsError>& error) {
  const double left_mm = error ? error->expected.rms_mm : least_known_mm(fit);
  if (!(left_mm > kMostToCutWithMm)) return {};
  return fmt::format(
      "Do not paste these anchors: {} {} mm, and {:g} mm is too much. Measure more places, farther "
      "apart, and check the readings that were left out.",
      error ? "with them the tool is still off by" : "they are known to", about_mm(left_mm),
      kMostToCutWithMm);
}

std::string headline_of(const BeltsFit& fit, const std::optional<BeltsError>& error) {
  if (const std::string why = not_to_paste(fit, error); !why.empty()) return why;
  if (!error)
    return fmt::format("These anchors are accurate to about {} mm.", about_mm(least_known_mm(fit)));
  return misses_sentence(error->today, error->expected.rms_mm, {"these anchors", "new anchors"}) +
         (fit.scale ? "" : " The error of the scale, which only a tape shows, is additional.");
}

Section agreement_section(const FittedBelts& fitted, const std::optional<BeltsError>& error) {
  const BeltsFit& fit = fitted.fit;
  const std::size_t readings = 4 * fit.places.size();
  Section section{"How well the belts agree"};
  if (error) {
    section.say(
        worst_sentence(error->worst_at.x_mm, error->worst_at.y_mm, error->expected.maximum_mm));
  }
  list_causes(fit, section);
  if (fit.places.empty()) return section;
  section.say(
      fmt::format("{} places, {} readings: the error of one belt's reading is {:.2f} mm (one "
                  "sigma, {} degrees of freedom).",
                  fit.places.size(), readings, fit.residual_sigma_mm, fit.checks),
      Detail::verbose);
  section.say(
      fmt::format(
          "The machine's formula (Find Anchors fit: rms) gives {:.2f} mm, because it divides "
          "by all {} readings although places and anchors use {} degrees of freedom.",
          fit.rms_mm, readings, readings - as_size(fit.checks)),
      Detail::verbose);
  if (fitted.belts != nullptr && fitted.belts->firmware_fit) {
    section.say(fmt::format("The machine printed rms {:.2f} mm and max {:.2f} mm.",
                            fitted.belts->firmware_fit->rms_mm, fitted.belts->firmware_fit->max_mm),
                Detail::verbose);
  }
  return section;
}

Section tests_section(const FittedBelts& fitted) {
  Section section{.title = "What was left out, and the scale", .is_titled = false};
  if (!fitted.fit.places.empty()) {
    list_left_out(fitted.fit, section);
    say_bad_readings(fitted, section);
  }
  say_the_scale(fitted, section);
  if (fitted.holes != nullptr) say_the_holes(*fitted.holes, section);
  return section;
}

}  // namespace chaintrue::cli
