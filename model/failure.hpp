// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Why something has no result: the error of every tl::expected of model and of what uses it, with the reason
/// for a program and the sentence for a person. Failures of interp have the same shape.
///
/// \code
///   const auto pose = kinematics->inverse({100.0, -200.0});
///   if (!pose && pose.error() == PoseReason::slack) ...
///   if (!pose) fmt::print("{}\n", pose.error().sentence());
/// \endcode
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <utility>

namespace chaintrue {

/// The place of a failure that concerns no place.
struct Nowhere {
  friend bool operator==(const Nowhere&, const Nowhere&) = default;
};

/// `ReasonType` is a scoped enum or, if mechanisms differ in their reasons, model::MechanismReason.
/// `PlaceType` says which of many points, visits or marks. A failure by its reason alone allocates
/// nothing.
template <typename ReasonType, typename PlaceType = Nowhere>
struct Failure {
  using Reason = ReasonType;

  /// The sentence is sentence_of(reason).
  constexpr Failure(Reason why)
      : reason(std::move(why)) {}  // NOLINT: an error is made of its reason
  /// With its own sentence, for a whole task.
  Failure(Reason why, std::string words) : reason(std::move(why)), text(std::move(words)) {}

  Failure(Reason why, PlaceType where) : reason(std::move(why)), place(std::move(where)) {}

  /// As above, at a place.
  template <typename OtherPlace>
  [[nodiscard]] Failure<Reason, OtherPlace> at(OtherPlace where) const {
    Failure<Reason, OtherPlace> there(reason, text);
    there.cause = cause;
    there.place = std::move(where);
    return there;
  }
  /// As above, with the sentence of the underlying failure; `below` has static lifetime.
  [[nodiscard]] Failure because_of(std::string_view below) const {
    Failure more = *this;
    more.cause = below;
    return more;
  }

  std::string sentence() const {
    if constexpr (requires(const Reason& why) { sentence_of(why); }) {
      if (text.empty()) {
        std::string words(sentence_of(reason));
        return cause.empty() ? words : words.append(": ").append(cause);
      }
    }
    return text;
  }

  Reason reason;
  PlaceType place{};
  /// The sentence of the underlying failure of a pose; may be empty.
  std::string_view cause;
  /// Empty: use the sentence of the reason.
  std::string text;

  friend bool operator==(const Failure&, const Failure&) = default;
  friend bool operator==(const Failure& failure, const Reason& why) {
    return failure.reason == why;
  }
};

namespace model {

/// A reason with its words. Both strings have static lifetime.
struct MechanismReason {
  std::string_view name;   ///< stable, for programs: "outside_verticals"
  std::string_view words;  ///< for a person
  friend bool operator==(const MechanismReason&, const MechanismReason&) = default;
};
inline std::string_view sentence_of(const MechanismReason& reason) { return reason.words; }

/// An enum of reasons with a function named(reason).
template <class Reason>
concept NamedReason = requires(Reason reason) {
  { named(reason) } -> std::same_as<MechanismReason>;
};
std::string_view name(NamedReason auto reason) { return named(reason).name; }
std::string_view sentence_of(NamedReason auto reason) { return named(reason).words; }

}  // namespace model

}  // namespace chaintrue
