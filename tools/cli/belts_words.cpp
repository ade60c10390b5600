// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/belts_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "grid/belts/scale_by_tape.hpp"

namespace chaintrue::cli {
namespace {

using grid::BeltsFit;
using grid::MeasuredBelts;
using model::Belt;
using model::kBelts;

std::string spread_in_words(const MeasuredBelts& belts, const BeltsFit& fit) {
  const std::size_t places = fit.places.size();
  std::string text = fmt::format(
      "{} places, {} readings: one belt's reading is off by {:.2f} mm (one sigma, from {} checks "
      "that "
      "are left over).\n",
      places,
      4 * places,
      fit.spread_mm,
      fit.checks);
  fmt::format_to(
      std::back_inserter(text),
      "In the words of the machine (Find Anchors fit: rms) that is {:.2f} mm: it divides by "
      "all {} readings, though places and anchors have used up {} of them.\n",
      fit.rms_mm,
      4 * places,
      4 * places - static_cast<std::size_t>(fit.checks));
  if (belts.firmware_fit) {
    fmt::format_to(std::back_inserter(text),
                   "Its own message said rms {:.2f} mm and max {:.2f} mm.\n",
                   belts.firmware_fit->rms_mm,
                   belts.firmware_fit->max_mm);
  }
  return text;
}

std::string anchors_in_a_table(const BeltsFit& fit) {
  std::string text =
      "\nAnchor        fitted   sigma    stated  differs   rests on tl   tr   bl   br\n";
  for (const grid::AnchorCoordinate& c : fit.coordinates) {
    const std::string label = fmt::format("{} {}", c.name.substr(0, 2), c.name.substr(3, 1));
    fmt::format_to(
        std::back_inserter(text), "  {:<6}{:>12.2f}{:>8.2f}", label, c.fitted_mm, c.sigma_mm);
    if (c.stated_mm) {
      fmt::format_to(
          std::back_inserter(text), "{:>10.1f}{:>+9.1f}", *c.stated_mm, c.fitted_mm - *c.stated_mm);
    } else {
      fmt::format_to(std::back_inserter(text), "{:>10}{:>9}", "", "");
    }
    fmt::format_to(std::back_inserter(text), "{:>9}", "");
    for (const Belt belt : kBelts) {
      fmt::format_to(std::back_inserter(text), "{:>4.0f}%", 100.0 * c.rests_on[belt]);
    }
    text += "\n";
  }
  return text + "\n";
}

std::string foretold_in_words(const BeltsFit& fit) {
  if (fit.one_left_out.readings == 0) return {};
  std::string text = fmt::format(
      "Lower belts as the upper two foretell them, at places left out one by one: {:.2f} mm rms, "
      "{:.2f} "
      "mm at worst",
      fit.one_left_out.rms_mm,
      fit.one_left_out.largest_mm);
  if (fit.half_left_out) {
    fmt::format_to(std::back_inserter(text),
                   "; either half by the other: {:.2f} and {:.2f} mm",
                   fit.half_left_out->rms_mm,
                   fit.half_left_out->largest_mm);
  }
  return text + ".\n";
}

std::string bad_readings_in_words(const BeltsFit& fit) {
  std::string text;
  const double turn_mm = fit.machine.belt_turn_mm;
  for (const grid::BadBeltReading& bad : fit.bad) {
    const double turns = bad.off_mm / turn_mm;
    // To within a twentieth of a turn: a bad reading is that by chance one time in ten.
    const bool is_whole = std::abs(turns) > 0.5 && std::abs(turns - std::round(turns)) < 0.05;
    fmt::format_to(std::back_inserter(text),
                   "Set aside: the {} belt at point {}, {:.1f} mm {} than all others make it{}.\n",
                   model::words(bad.belt),
                   bad.point,
                   std::abs(bad.off_mm),
                   bad.off_mm > 0.0 ? "longer" : "shorter",
                   is_whole ? fmt::format(", {:.0f} whole turn{} of the encoder",
                                          std::abs(std::round(turns)),
                                          std::abs(turns) < 1.5 ? "" : "s")
                            : "");
  }
  for (const std::size_t point : fit.bad_points) {
    fmt::format_to(std::back_inserter(text),
                   "Point {} is bad as a whole: fewer than three of its readings agree. Measure it "
                   "again or leave it out.\n",
                   point);
  }
  return text;
}

std::string scale_in_words(const MeasuredBelts& belts, const BeltsFit& fit) {
  if (!fit.scale) {
    std::string text = fmt::format(
        "Scale: not known. Belts alone cannot tell it: anchors and parts are as true as a turn of "
        "the "
        "encoder is {:g} mm of belt. ",
        fit.machine.belt_turn_mm);
    const auto best = grid::distance_for_scale(belts, fit);
    if (!best) {
      return text +
             "Tape one long distance, between two anchors or two holes that were cut, and add "
             "it to the file's \"distances\".\n";
    }
    return text +
           fmt::format(
               "Tape the distance from {} to {}, about {:.0f} mm, and add it to the file's "
               "\"distances\": read to {:g} mm it tells the scale to {:.2g} %, better than any "
               "other.\n",
               words_of(best->distance.from),
               words_of(best->distance.to),
               best->distance.distance_mm,
               best->distance.sigma_mm,
               100.0 * best->sigma);
  }
  std::string text = fmt::format(
      "Scale: by the tape everything is {:.5f} +- {:.5f} times what the belts make it, {:.1f} mm "
      "in a "
      "metre.\n",
      fit.scale->factor,
      fit.scale->sigma,
      1000.0 * (fit.scale->factor - 1.0));
  for (std::size_t i = 0; i < belts.distances.size(); ++i) {
    const grid::BeltDistance& distance = belts.distances[i];
    fmt::format_to(std::back_inserter(text),
                   "  {} to {}: taped {:.1f} mm, {:+.2f} mm from the fit\n",
                   words_of(distance.from),
                   words_of(distance.to),
                   distance.distance_mm,
                   fit.scale->residuals_mm[i]);
  }
  return text;
}

}  // namespace

std::string belts_fit_in_words(const MeasuredBelts& belts, const BeltsFit& fit) {
  if (fit.places.empty()) return anchors_in_a_table(fit) + scale_in_words(belts, fit);
  return spread_in_words(belts, fit) + anchors_in_a_table(fit) + foretold_in_words(fit) +
         bad_readings_in_words(fit) + scale_in_words(belts, fit);
}

std::string holes_beside_belts_in_words(const grid::HolesBesideBelts& holes) {
  std::string text = fmt::format(
      "Holes: {} distances, each foretold by all others to {:.2f} mm rms; tape and holes err "
      "{:.2g} "
      "times what was stated.\n",
      holes.distances.size(),
      holes.left_out_rms_mm,
      holes.noise_factor);
  for (const auto& distance : holes.distances) {
    if (!distance.set_aside) continue;
    fmt::format_to(
        std::back_inserter(text),
        "Set aside: the distance {}, taped {:.1f} mm {} than all others make it; tape it "
        "again.\n",
        distance.words,
        std::abs(distance.left_out_mm),
        distance.left_out_mm > 0.0 ? "longer" : "shorter");
  }
  if (!holes.displacement)
    return text + "No bend of the tool's place over the sheet is left that the holes could show.\n";
  double largest = 0.0;
  const auto& at = holes.displacement->at_mm;
  for (Eigen::Index i = 0; i + 1 < at.size(); i += 2)
    largest = std::max(largest, std::hypot(at[i], at[i + 1]));
  return text + fmt::format(
                    "Beside its upper two belts the tool lies up to {:.1f} mm off, changing over "
                    "some {:.0f} mm of the sheet: gcode compensate takes that out, no number to "
                    "paste does.\n",
                    largest,
                    holes.displacement->reach_mm);
}

std::string taped_in_a_table(const grid::HolesBesideBelts& holes) {
  std::string text = "\nDistance          taped   off, mm   left out   sigma\n";
  for (const auto& distance : holes.distances) {
    fmt::format_to(std::back_inserter(text),
                   "  {:<14}{:>8.1f}{:>+10.2f}{:>+11.2f}{:>8.2f}{}\n",
                   distance.words,
                   distance.measured_mm,
                   distance.off_mm,
                   distance.left_out_mm,
                   distance.left_out_sigma_mm,
                   distance.set_aside ? " *" : "");
  }
  return text;
}

std::string places_in_a_table(const BeltsFit& fit) {
  std::string text =
      "\nPoint         x         y   read less fitted, mm:    tl      tr      bl      br\n";
  for (std::size_t k = 0; k < fit.places.size(); ++k) {
    const grid::FittedPlace& place = fit.places[k];
    fmt::format_to(std::back_inserter(text),
                   "{:>5}{:>10.1f}{:>10.1f}{:>22}",
                   k,
                   place.at.x_mm,
                   place.at.y_mm,
                   "");
    for (const Belt belt : kBelts) {
      fmt::format_to(std::back_inserter(text),
                     "{:>+7.2f}{}",
                     place.belts[belt].off_mm,
                     place.belts[belt].counts ? ' ' : '*');
    }
    text += "\n";
  }
  if (!fit.bad.empty()) text += "* set aside\n";
  return text;
}

}  // namespace chaintrue::cli
