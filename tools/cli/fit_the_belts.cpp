// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/fit_the_belts.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <vector>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/anchors_document.hpp"
#include "tools/cli/anchors_sections.hpp"
#include "tools/cli/belts_wish.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {

namespace {

/// The measurements of one four-belt machine.
struct BeltFiles {
  grid::PointIndices indices;  ///< of the points of `belts` in their file
  std::optional<MeasuredBelts> belts;
  std::vector<grid::BeltHoles> holes;
};

void read_belts_file(const InputFile& file,
                     const std::vector<std::size_t>& without,
                     BeltFiles& all) {
  if (all.belts) {
    throw InputError({{file.name,
                       "",
                       "a second file of belts",
                       "one file of belts and any number of chaintrue_holes; each session has its "
                       "own fit"}});
  }
  all.belts = load_belts(file, "a fit", without).belts;
  all.indices = files::indices_without(all.belts->points.size(), without);
}

void read_holes_file(const InputFile& file, const files::TapeOptions& tape, BeltFiles& all) {
  require_kind(file,
               {FileKind::belts, FileKind::holes, FileKind::belt_holes},
               "a single file of belts is fitted");
  files::ReadHoles read = files::parse_holes(file.text, file.name, {.tape = tape});
  print_warnings(read.warnings);
  if (!read.belt_machine && all.belts && all.belts->machine.anchors_known && !read.holes.machine)
    read.belt_machine = all.belts->machine;
  if (!read.belt_machine) {
    throw InputError({{file.name,
                       "/machine",
                       read.holes.machine ? "a machine on two chains" : "",
                       "the machine on four belts that cut the holes, with x_mm and y_mm of the "
                       "anchors then in force"}});
  }
  all.holes.push_back({*std::move(read.belt_machine), std::move(read.holes)});
}

/// Belts first, whatever their position: holes may use their machine.
BeltFiles read_all(const BeltsFitCommand& command) {
  BeltFiles all;
  for (const auto& file : command.files) {
    if (file.kind == FileKind::belts) read_belts_file(file, command.without, all);
  }
  for (const auto& file : command.files) {
    if (file.kind != FileKind::belts) read_holes_file(file, command.tape, all);
  }
  return all;
}

tl::expected<files::FittedAnchors, grid::BeltsFitFailure> fitted(const BeltFiles& all) {
  if (all.holes.empty()) {
    return diagnosis::fit_with_causes(*all.belts).map([&](BeltsFit fit) {
      return files::FittedAnchors{all.belts->name, std::move(fit)};
    });
  }
  MeasuredBelts belts;
  belts.machine = all.holes.front().machine;
  belts.name = all.holes.front().set.name;
  if (all.belts) belts = *all.belts;
  return diagnosis::fit_with_causes_and_holes(belts, all.holes)
      .map([&](grid::BeltsAndHolesFit fit) {
        return files::FittedAnchors{belts.name, std::move(fit.belts), std::move(fit.holes)};
      });
}

/// Bad points with their numbers in the file of the belts, where others were left out.
files::FittedAnchors with_file_numbers(files::FittedAnchors found, const BeltFiles& all) {
  for (grid::BadBeltReading& bad : found.fit.bad)
    bad.point = grid::index_in_file(all.indices, bad.point);
  for (std::size_t& point : found.fit.bad_points) point = grid::index_in_file(all.indices, point);
  return found;
}

}  // namespace

bool is_of_four_belts(const InputFile& file) {
  return file.kind == FileKind::belts || file.kind == FileKind::belt_holes;
}

int fit_the_belts(const BeltsFitCommand& command) {
  const BeltFiles all = read_all(command);
  const auto found = fitted(all);
  if (!found) throw Failed(command.files.front().name, found.error());
  const std::string text =
      files::write_anchors(with_file_numbers(*found, all), made_by(command.verb));
  std::vector<files::OutputFile> outputs = {{command.output, text}};
  if (command.json) outputs.push_back({"-", text});
  write_outputs(outputs);
  const MeasuredBelts belts = all.belts.value_or(MeasuredBelts{});
  const grid::HolesWithBelts* holes = found->holes ? &*found->holes : nullptr;
  const auto error = grid::error_of_belts(found->fit, holes);
  Document document =
      anchors_document({found->fit, holes, &belts, all.indices}, found->name, command.output);
  if (command.wish_mm) {
    auto& remarks = document.remarks.blocks;
    remarks.insert(
        remarks.begin(),
        Paragraph{belts_wish_sentence(belts, all.holes, *found, error, *command.wish_mm)});
  }
  fmt::print(stderr,
             "{}",
             report::render_text(document, command.verbose ? Detail::verbose : Detail::always));
  if (!not_to_paste(found->fit, error).empty()) return kCheckFailed;
  say_next({"export", "maslow4", command.output});
  return kDone;
}

}  // namespace chaintrue::cli
