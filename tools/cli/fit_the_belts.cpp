// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/fit.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/random.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// Compares the tool error that an owner of four belts wishes for with the expected one. To reach
// it, compensated programs and two to four times as many visits, in a session simulated from the
// fit, are tried.

/// Four times as many places is the most that is practical.
constexpr std::size_t kMostTimes = 4;
/// A fit of this many places takes a second (docs/reliability.md).
constexpr std::size_t kMostTried = 400;

/// A session simulated from the fit, with each place visited `times` times and the noise found.
/// Points keep their indices, which distances refer to; further visits of them follow. Its noise is
/// the same in every run.
MeasuredBelts measured_again(const MeasuredBelts& belts, const BeltsFit& fit, std::size_t times) {
  constexpr std::uint64_t kSeed = 31;
  grid::Random random(kSeed, times);
  MeasuredBelts result = belts;
  result.points.clear();
  const int factor = as_int(times);
  for (int visit = 0; visit < factor; ++visit) {
    for (const auto k : each_index(belts.points)) {
      grid::BeltPoint point = belts.points[k];
      for (const Belt belt : kBelts) {
        point.lengths_mm[belt] +=
            fit.residual_sigma_mm * random.normal() - fit.places[k].belts[belt].residual_mm;
      }
      if (point.order) point.order = factor * *point.order + visit;
      result.points.push_back(std::move(point));
    }
  }
  return result;
}

/// Holes are fitted together with the belts.
tl::expected<FittedAnchors, grid::BeltsFitFailure> fitted(const MeasuredBelts& belts,
                                                          const std::vector<grid::BeltHoles>& cut) {
  if (cut.empty()) {
    return diagnosis::fit_with_causes(belts).map([&](BeltsFit fit) {
      return FittedAnchors{belts.name, std::move(fit)};
    });
  }
  return diagnosis::fit_with_causes_and_holes(belts, cut).map([&](grid::BeltsAndHolesFit fit) {
    return FittedAnchors{belts.name, std::move(fit.belts), std::move(fit.holes)};
  });
}

/// The error to expect of such a session. The noise that its fit finds is a sample of the simulated
/// noise, and the error scales with it, so it is corrected for that. Empty without a fit.
std::optional<double> expected_of_places(const MeasuredBelts& belts,
                                         const std::vector<grid::BeltHoles>& cut, double noise_mm) {
  const auto again = fitted(belts, cut);
  if (!again || !(again->fit.residual_sigma_mm > 0.0)) return std::nullopt;
  const auto error = error_of_belts(again->fit, holes_of(*again));
  if (!error) return std::nullopt;
  return error->expected.rms_mm * noise_mm / again->fit.residual_sigma_mm;
}

/// After compensating the displacement that the holes show; empty if none was found.
std::optional<double> expected_when_compensated(const FittedAnchors& found) {
  if (!found.holes || !found.holes->displacement) return std::nullopt;
  HolesWithBelts level = *found.holes;
  level.displacement.reset();
  const auto error = error_of_belts(found.fit, &level);
  return error ? std::optional(error->expected.rms_mm) : std::nullopt;
}

/// `belts` (without points if only holes were fitted) and `cut` are the input of `found`; `error`
/// is its error_of_belts(). `wish_mm` is the rms error of the tool over the measured part.
std::string belts_wish_sentence(const MeasuredBelts& belts, const std::vector<grid::BeltHoles>& cut,
                                const FittedAnchors& found, const std::optional<BeltsError>& error,
                                double wish_mm) {
  const std::string wish = fmt::format("Your target is {:g} mm: ", wish_mm);
  if (!error) return wish + "these readings do not show whether it is reached.";
  if (error->expected.rms_mm <= wish_mm)
    return wish +
           (found.fit.scale ? "reached." : "reached. Only a taped distance shows the scale.");
  const auto compensated = expected_when_compensated(found);
  if (compensated && *compensated <= wish_mm)
    return wish +
           "not reached with anchors alone. Compensated programs (gcode compensate) reach it.";
  const std::size_t places = belts.points.size();
  if (places == 0)
    return wish + "not reached. More distances or a better tape would reduce the error.";
  const double noise_mm = found.fit.residual_sigma_mm;
  const auto once = expected_of_places(measured_again(belts, found.fit, 1), cut, noise_mm);
  if (!once || 2 * places > kMostTried)
    return wish +
           "not reached. The number of places needed was not computed, because there are too many "
           "already.";
  std::size_t tried = 0;
  for (std::size_t times = 2; times <= kMostTimes && times * places <= kMostTried; ++times) {
    tried = times * places;
    const auto then = expected_of_places(measured_again(belts, found.fit, times), cut, noise_mm);
    if (then && error->expected.rms_mm * *then <= wish_mm * *once) {
      return wish +
             fmt::format(
                 "not reached. About {} places measured as accurately as these would reach it.",
                 tried);
    }
  }
  return wish + fmt::format(
                    "not reached, not even with {} places measured as accurately as these. To look "
                    "for other causes, run chaintrue diagnose on the same belts.",
                    tried);
}

/// The measurements of one four-belt machine.
struct BeltFiles {
  grid::PointIndices indices;  ///< of the points of `belts` in their file
  std::optional<MeasuredBelts> belts;
  std::vector<grid::BeltHoles> holes;
};

void read_belts_file(const InputFile& file, const std::vector<std::size_t>& without,
                     BeltFiles& all) {
  if (all.belts) {
    refuse(file.name, "a second file of belts",
           "one file of belts and any number of chaintrue_holes; each session has its own fit");
  }
  all.belts = load_belts(file, "a fit", without).belts;
  all.indices = files::indices_without(all.belts->points.size(), without);
}

void read_holes_file(const InputFile& file, const TapeOptions& tape, BeltFiles& all) {
  require_kind(file, {FileKind::belts, FileKind::holes, FileKind::belt_holes},
               "a single file of belts is fitted");
  files::ReadHoles read = files::parse_holes(file.text, file.name, {.tape = tape});
  print_warnings(read.warnings);
  if (!read.belt_machine && all.belts && all.belts->machine.anchors_known && !read.holes.machine)
    read.belt_machine = all.belts->machine;
  if (!read.belt_machine) {
    refuse(file.name, "/machine", read.holes.machine ? "a machine on two chains" : "",
           "the machine on four belts that cut the holes, with x_mm and y_mm of the anchors then "
           "in force");
  }
  all.holes.push_back({*std::move(read.belt_machine), std::move(read.holes)});
}

/// Belts first, whatever their position: holes may use their machine.
BeltFiles read_all(const FitCommand& command, const InputFiles& files) {
  BeltFiles all;
  for (const InputFile& file : files) {
    if (file.kind == FileKind::belts) read_belts_file(file, points_left_out(command.without), all);
  }
  for (const InputFile& file : files) {
    if (file.kind != FileKind::belts) read_holes_file(file, command.tape, all);
  }
  return all;
}

/// Without a file of belts: no points, and the machine that cut the first holes.
MeasuredBelts session_of(const BeltFiles& all) {
  if (all.belts) return *all.belts;
  MeasuredBelts belts;
  belts.machine = all.holes.front().machine;
  belts.name = all.holes.front().set.name;
  return belts;
}

/// Bad points with their numbers in the file of the belts, where others were left out.
FittedAnchors with_file_numbers(FittedAnchors found, const BeltFiles& all) {
  for (grid::BadBeltReading& bad : found.fit.bad)
    bad.point = grid::index_in_file(all.indices, bad.point);
  for (std::size_t& point : found.fit.bad_points) point = grid::index_in_file(all.indices, point);
  return found;
}

}  // namespace

int fit_the_belts(Verb verb, const FitCommand& command, const InputFiles& files) {
  const BeltFiles all = read_all(command, files);
  const FittedAnchors found = value_of(fitted(session_of(all), all.holes), files.front().name);
  const std::string text = files::write_anchors(with_file_numbers(found, all), made_by(verb));
  const MeasuredBelts belts = all.belts.value_or(MeasuredBelts{});
  const HolesWithBelts* holes = holes_of(found);
  const auto error = error_of_belts(found.fit, holes);
  Document document =
      anchors_document({found.fit, holes, &belts, all.indices}, found.name, command.output);
  if (command.wish_mm) {
    auto& remarks = document.remarks.blocks;
    remarks.insert(remarks.begin(), Paragraph{belts_wish_sentence(belts, all.holes, found, error,
                                                                  *command.wish_mm)});
  }
  write_fitted(command, text, text, document);
  if (!not_to_paste(found.fit, error).empty()) return kCheckFailed;
  say_next({"export", "maslow4", command.output});
  return kDone;
}

}  // namespace chaintrue::cli
