// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The four belts of a Maslow 4, and one value for each of them.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace chaintrue::model {

/// Named after the frame corner that the belt comes from.
enum class Belt { tl, tr, bl, br };

inline constexpr std::array kBelts = {Belt::tl, Belt::tr, Belt::bl, Belt::br};

/// One value for each belt, addressed by it: `lengths_mm[Belt::tl]`.
template <class T>
struct PerBelt {
  T tl{};
  T tr{};
  T bl{};
  T br{};
  constexpr T& operator[](Belt belt) {
    return belt == Belt::tl ? tl : belt == Belt::tr ? tr : belt == Belt::bl ? bl : br;
  }
  constexpr const T& operator[](Belt belt) const {
    return belt == Belt::tl ? tl : belt == Belt::tr ? tr : belt == Belt::bl ? bl : br;
  }
  friend bool operator==(const PerBelt&, const PerBelt&) = default;
};

/// Identifier in files: tl, tr, bl, br.
std::string_view name(Belt belt);
/// For messages: top left, ...
std::string_view words(Belt belt);
std::optional<Belt> belt_of(std::string_view word);

/// The firmware computes the tool's position from the upper two.
constexpr bool is_upper(Belt belt) { return belt == Belt::tl || belt == Belt::tr; }

}  // namespace chaintrue::model

/// Exported: these names are used throughout chaintrue.
namespace chaintrue {
using model::Belt;
using model::kBelts;
using model::PerBelt;
}  // namespace chaintrue
