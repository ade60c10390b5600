// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_files.hpp"

#include <fmt/format.h>

#include <vector>

#include "grid/containers.hpp"
#include "grid/diagnosis/law_declaration.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/map/corrected_data.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::cli {

std::string corrected_grid_text(const Diagnosis& found, MeasuredGrid measured, bool order_assumed) {
  measured.machine = found.extended_machine;
  grid::append_all(measured.machine->effects, found.data_corrections);
  auto corrected = grid::corrected_data(measured);
  if (!corrected) throw InputError({{"corrected grid", "", "", "", corrected.error().sentence()}});
  for (auto& point : corrected->grid.points) {
    if (order_assumed) point.order.reset();
  }
  return files::write_grid(corrected->grid);
}

std::string extended_machine_text(const Diagnosis& found, const std::string& source) {
  std::vector<std::string> in_here;
  for (const auto& effect : found.extended_machine.effects) {
    if (effect.probability) in_here.push_back(cause_title(effect));
  }
  std::vector<std::string> comments = {
      fmt::format("Made by chaintrue diagnose from {}: calibrated settings, with the causes {}.",
                  source,
                  in_here.empty() ? "none" : fmt::format("{}", fmt::join(in_here, "; ")))};
  for (const auto& cause : causes_left_out(found))
    comments.push_back(fmt::format("Named but not included here: {}.", cause_title(cause.cause)));
  for (const auto& correction : found.data_corrections) {
    comments.push_back(
        fmt::format("Not included here, because it belongs to the data: {}.", cause_title(correction)));
  }
  return files::write_machine(found.extended_machine, comments);
}

tl::expected<std::string, std::string> law_text(const Diagnosis& found) {
  const std::vector<diagnosis::Law> none;
  const auto declaration = diagnosis::declaration_of(
      found.unexplained ? found.unexplained->laws : none, found.extended_machine.bed);
  if (!declaration) return tl::unexpected(declaration.error());
  return files::write_effect(*declaration);
}

}  // namespace chaintrue::cli
