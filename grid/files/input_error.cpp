// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/input_error.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "grid/containers.hpp"

namespace chaintrue::grid::files {

std::string InputProblem::message() const {
  const std::string where = place.empty() ? file : fmt::format("{}: {}", file, place);
  if (!sentence.empty()) return file.empty() ? sentence : fmt::format("{}: {}", where, sentence);
  if (value.empty()) return fmt::format("{}: missing, expected {}", where, expected);
  return fmt::format("{}: found {}, expected {}", where, value, expected);
}

std::string_view InputProblem::name() const {
  const bool is_missing = kind == ProblemKind::unexpected && value.empty() && sentence.empty();
  return name_of(is_missing ? ProblemKind::missing : kind);
}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(
          fmt::format("{}", fmt::join(mapped(problems, &InputProblem::message), "\n"))),
      problems_(std::move(problems)) {}

void refuse(std::string file, std::string place, std::string found, std::string expected,
            ProblemKind kind) {
  throw InputError(
      {{std::move(file), std::move(place), std::move(found), std::move(expected), {}, kind}});
}

void refuse(std::string file, std::string found, std::string expected, ProblemKind kind) {
  refuse(std::move(file), "", std::move(found), std::move(expected), kind);
}

std::string system_words(int error_number) {
  return std::error_code(error_number, std::generic_category()).message();
}

}  // namespace chaintrue::grid::files
