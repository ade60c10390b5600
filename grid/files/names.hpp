// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names of values, the same in files and on the command line.
///
/// \code
///   const auto end = named(kEndConditions, "clamped");   // empty for a word that is none of them
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/visiting_order.hpp"
#include "model/kinematics.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

template <class E>
using Named = std::pair<std::string_view, E>;

inline constexpr Named<ControllerKind> kControllerKinds[] = {
    {"ideal", ControllerKind::ideal},
    {"maslow_classic", ControllerKind::maslow_classic},
    {"holey", ControllerKind::holey},
    {"fluidnc_wallplotter", ControllerKind::fluidnc_wallplotter}};
inline constexpr Named<Feed> kFeeds[] = {{"over_top", Feed::over_top},
                                         {"off_bottom", Feed::off_bottom}};
inline constexpr Named<Model> kModels[] = {
    {"straight", Model::straight},         {"wrap", Model::wrap},
    {"firmware", Model::firmware},         {"one_shot", Model::one_shot},
    {"inextensible", Model::inextensible}, {"elastic", Model::elastic},
    {"elastic_3d", Model::elastic_3d}};
inline constexpr Named<interp::EndCondition> kEndConditions[] = {
    {"not_a_knot", interp::EndCondition::not_a_knot},
    {"natural", interp::EndCondition::natural},
    {"parabolic", interp::EndCondition::parabolic},
    {"clamped", interp::EndCondition::clamped}};
/// What a map does beyond its points.
inline constexpr Named<Outside> kOutsideWays[] = {{"continued", Outside::continued},
                                                  {"refuse", Outside::refuse},
                                                  {"fade", Outside::fade},
                                                  {"linear", Outside::linear},
                                                  {"clamp", Outside::clamp}};
/// From the top left.
inline constexpr Named<VisitingOrder> kVisitingOrders[] = {
    {"rows", {.rows = true, .serpentine = false}},
    {"columns", {.rows = false, .serpentine = false}},
    {"serpentine_rows", {.rows = true, .serpentine = true}},
    {"serpentine_columns", {.rows = false, .serpentine = true}}};

template <class E, std::size_t n>
std::optional<E> named(const Named<E> (&names)[n], std::string_view word) {
  const auto* found = find_where(names, having(&Named<E>::first, word));
  return found != nullptr ? std::optional(found->second) : std::nullopt;
}

template <class E, std::size_t n>
std::vector<std::string> words_of(const Named<E> (&names)[n]) {
  return mapped(names, [](const Named<E>& one) { return std::string(one.first); });
}

}  // namespace chaintrue::grid::files
