// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "grid/belts/belts_error.hpp"
#include "grid/containers.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/drawing_file.hpp"
#include "grid/threads/use_threads.hpp"
#include "tools/cli/assumed_order.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"

namespace chaintrue::cli {

namespace {

void assume_order(const DiagnoseCommand& command, MeasuredGrid& measured) {
  if (command.assume_order.empty()) return;
  OptionProblems problems;
  if (grid::any_of(measured.points, [](const auto& point) { return point.order.has_value(); })) {
    problems.add("--assume-order",
                 command.assume_order,
                 "to be left out, because these points have the order of their visits",
                 ProblemKind::contradiction);
    problems.throw_if_any();
  }
  const auto numbers = grid::visit_numbers(measured.points, *order_from_word(command.assume_order));
  if (!numbers) {
    problems.add("--assume-order", command.assume_order, numbers.error(), ProblemKind::bad_syntax);
    problems.throw_if_any();
  }
  for (std::size_t i = 0; i < measured.points.size(); ++i) measured.points[i].order = (*numbers)[i];
}

template <class T>
T value_of(tl::expected<T, diagnosis::DiagnosisFailure> result, const std::string& path) {
  if (result) return *std::move(result);
  throw Failed(files::name_in_messages(path), result.error());
}

/// "28 points and 20 distances"
std::string counted(const grid::Measured& measured) {
  std::size_t points = 0;
  std::size_t distances = 0;
  for (const auto* own : measured.grids()) points += own->points.size();
  for (const auto* set : measured.holes()) distances += set->distances.size();
  if (distances == 0) return fmt::format("{} points", points);
  if (points == 0) return fmt::format("{} distances", distances);
  return fmt::format("{} points and {} distances", points, distances);
}

/// The cost grows with the square of the number and more (docs/reliability.md): these take half a
/// minute, and more would change no name.
constexpr std::size_t kMostDiagnosed = 1200;

void refuse_too_many_to_diagnose(const grid::Measured& measured, const std::string& path) {
  std::size_t units = 0;
  for (const auto* own : measured.grids()) units += own->points.size();
  for (const auto* set : measured.holes()) units += set->distances.size();
  if (units <= kMostDiagnosed) return;
  throw Failed(
      files::name_in_messages(path),
      "too_many",
      fmt::format("{} are more than a diagnosis accepts ({}): leave some out, evenly over the bed, "
                  "and keep those measured twice; chaintrue fit accepts them all",
                  counted(measured),
                  kMostDiagnosed));
}

/// Readings more accurate than the simulation over a bed.
void note_fine_readings(const grid::Measured& measured, Diagnosis& found) {
  constexpr double kFinestMm = 0.01;
  for (const auto* own : measured.grids()) {
    if (!own->noise || own->noise->length_mm >= kFinestMm) continue;
    found.notes.push_back(
        fmt::format("The reading error that you entered, {} mm, is below the numerical accuracy; "
                    "{} mm was used instead.",
                    own->noise->length_mm,
                    kFinestMm));
  }
}

diagnosis::DiagnosisOptions diagnosis_options(const DiagnoseCommand& command) {
  diagnosis::DiagnosisOptions options;
  options.seed = command.seed;
  options.order_assumed = !command.assume_order.empty();
  options.accept_class = command.accept_class;
  options.improvement = !command.without_gain;
  options.progress = shown_progress();
  return options;
}

/// With the file's name where the readings have none.
Diagnosis named(tl::expected<Diagnosis, diagnosis::DiagnosisFailure> result,
                const DiagnoseCommand& command) {
  Diagnosis found = value_of(std::move(result), command.input.grid);
  if (found.grid_name.empty()) found.grid_name = file_name(command.input.grid);
  return found;
}

/// The accuracy with which the result predicts the grid of --held-out.
diagnosis::Transfer held_out(const DiagnoseCommand& command,
                             const MeasuredGrid& measured,
                             const Diagnosis& found) {
  GridInput other = command.input;
  other.grid = command.held_out;
  const MeasuredGrid to = read_grid_input(other);
  auto transferred = value_of(diagnosis::transfer(measured, found, to), command.held_out);
  if (transferred.to.empty())
    transferred.to = to.name.empty() ? file_name(command.held_out) : to.name;
  return transferred;
}

/// The number in the first line of a fit of the same belts.
std::optional<grid::ErrorSummary> tool_today(const MeasuredBelts& belts) {
  const auto fit = diagnosis::fit_with_causes(belts);
  const auto error = fit ? grid::error_of_belts(*fit) : std::nullopt;
  return error ? error->today : std::nullopt;
}

}  // namespace

std::string file_name(const std::string& path) {
  return path == "-" ? "standard input" : std::filesystem::path(path).filename().string();
}

Diagnosis diagnosed(const DiagnoseCommand& command, grid::Measured& measured) {
  if (MeasuredGrid* own = measured.first_grid()) assume_order(command, *own);
  refuse_too_many_to_diagnose(measured, command.input.grid);
  grid::keep_freed_memory();
  Diagnosis found = named(diagnosis::diagnose(measured, diagnosis_options(command)), command);
  note_fine_readings(measured, found);
  if (!command.assume_order.empty()) {
    found.notes.insert(
        found.notes.begin(),
        fmt::format("The order of visits was not recorded. Assumed: {}, lines from the top left.",
                    command.assume_order));
  }
  if (!command.held_out.empty())
    found.transferred = held_out(command, *measured.first_grid(), found);
  return found;
}

Diagnosis diagnosed_belts(const DiagnoseCommand& command, const InputFile& file) {
  const std::vector<std::size_t> without = points_left_out(command.without);
  const files::ReadBelts read = load_belts(file, "a diagnosis", without);
  // Twice as many take four times as long (docs/maslow4.md).
  constexpr std::size_t kMostPlaces = 2000;
  if (read.belts.points.size() > kMostPlaces) {
    throw Failed(file.name,
                 "too_many",
                 fmt::format("{} places are more than a diagnosis accepts ({}): leave some out, "
                             "evenly over the sheet; chaintrue fit accepts them all",
                             read.belts.points.size(),
                             kMostPlaces));
  }
  Diagnosis found =
      named(diagnosis::diagnose(read.belts,
                                diagnosis_options(command),
                                files::indices_without(read.belts.points.size(), without)),
            command);
  found.tool_today = tool_today(read.belts);
  return found;
}

Diagnosis diagnosed_drawing(const DiagnoseCommand& command, const InputFile& file) {
  return named(
      diagnosis::diagnose(files::parse_drawing(file.text, file.name), diagnosis_options(command)),
      command);
}

}  // namespace chaintrue::cli
