// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/python/core/bind.hpp"

namespace chaintrue::python {

void check_pairs(const Pairs& pairs, const char* name) {
  if (pairs.ndim() != 2 || pairs.shape(1) != 2) {
    throw std::invalid_argument(
        fmt::format("{} must have the shape (n, 2), not {} dimensions", name, pairs.ndim()));
  }
  const double* numbers = pairs.data();
  for (py::ssize_t i = 0; i < pairs.size(); ++i) {
    if (!std::isfinite(numbers[i]))
      throw std::invalid_argument(
          fmt::format("{}: row {} holds a number that is none, or infinite", name, i / 2));
  }
}

Pairs new_rows(std::size_t count, std::size_t columns) {
  Pairs rows({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(columns)});
  std::fill_n(rows.mutable_data(), count * columns, 0.0);
  return rows;
}

std::vector<std::string> sentences_of(const std::vector<grid::files::Warning>& warnings) {
  std::vector<std::string> sentences;
  for (const grid::files::Warning& warning : warnings) sentences.push_back(warning.message());
  return sentences;
}

Sources pairs_of(const std::vector<grid::SourceFile>& files) {
  Sources sources;
  for (const grid::SourceFile& file : files) sources.emplace_back(file.name, file.sha256);
  return sources;
}

std::optional<grid::Provenance> provenance_of(const MadeBy& made_by) {
  if (!made_by) return std::nullopt;
  const auto& [version, verb, options, sources] = *made_by;
  grid::Provenance found{version, verb, options, {}};
  for (const auto& [name, sha256] : sources) found.inputs.push_back({name, sha256});
  return found;
}

}  // namespace chaintrue::python
