// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Thrown by a verb that cannot do its task with valid input: a sentence for the user, and
/// the reason by a name that stays the same if sentences change.
///
/// \code
///   const grid::Check check = value_of(grid::check_map(map, points), file.name);
/// \endcode
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "tools/cli/arguments.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::grid {
enum class BeltsFitReason;
enum class CheckReason;
enum class FitReason;
enum class PlanReason;
namespace diagnosis {
enum class DiagnosisReason;
}
}  // namespace chaintrue::grid

namespace chaintrue::cli {

/// The enumerator's own name: "no_machine".
std::string_view name_of(grid::BeltsFitReason reason);
std::string_view name_of(grid::CheckReason reason);
std::string_view name_of(grid::FitReason reason);
std::string_view name_of(grid::PlanReason reason);
std::string_view name_of(diagnosis::DiagnosisReason reason);

struct Failed : std::runtime_error {
  Failed(std::string file, std::string_view why, const std::string& sentence,
         int exit_code = kBadInput)
      : std::runtime_error(sentence), about(std::move(file)), reason(why), code(exit_code) {}
  /// \param failure a Failure of one of the reasons above
  template <class Failure>
  Failed(std::string file, const Failure& failure, int exit_code = kBadInput)
      : Failed(std::move(file), name_of(failure.reason), failure.sentence(), exit_code) {}

  /// The file, or the command, that the message begins with; empty: it was printed.
  std::string about;
  std::string reason;
  int code;
};

/// \throws Failed as above without a result
template <class T, class Failure>
T value_of(tl::expected<T, Failure> result, std::string about, int code = kBadInput) {
  if (!result) throw Failed(std::move(about), result.error(), code);
  return *std::move(result);
}

}  // namespace chaintrue::cli
