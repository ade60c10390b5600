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
[[nodiscard]] std::string_view name_of(grid::BeltsFitReason reason);
[[nodiscard]] std::string_view name_of(grid::CheckReason reason);
[[nodiscard]] std::string_view name_of(grid::FitReason reason);
[[nodiscard]] std::string_view name_of(grid::PlanReason reason);
[[nodiscard]] std::string_view name_of(diagnosis::DiagnosisReason reason);

class Failed : public std::runtime_error {
 public:
  /// \param about the file, or the command, that the message begins with; empty: it was printed
  Failed(std::string about,
         std::string_view reason,
         const std::string& sentence,
         int code = kBadInput)
      : std::runtime_error(sentence), about_(std::move(about)), reason_(reason), code_(code) {}
  /// \param failure a Failure of one of the reasons above
  template <class Failure>
  Failed(std::string about, const Failure& failure, int code = kBadInput)
      : Failed(std::move(about), name_of(failure.reason), failure.sentence(), code) {}

  [[nodiscard]] const std::string& about() const { return about_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] int code() const { return code_; }

 private:
  std::string about_;
  std::string reason_;
  int code_;
};

/// \throws Failed as above without a result
template <class T, class Failure>
T value_of(tl::expected<T, Failure> result, std::string about, int code = kBadInput) {
  if (!result) throw Failed(std::move(about), result.error(), code);
  return *std::move(result);
}

}  // namespace chaintrue::cli
