// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The kind of a problem of an input: a name that is stable when its sentence changes.
#pragma once

#include <string_view>

namespace chaintrue::grid {

enum class ProblemKind {
#define CHAINTRUE_PROBLEM_KIND(name) name,
#include "grid/problem_kinds.def"
#undef CHAINTRUE_PROBLEM_KIND
};

constexpr std::string_view name_of(ProblemKind kind) {
  constexpr std::string_view kNames[] = {
#define CHAINTRUE_PROBLEM_KIND(name) #name,
#include "grid/problem_kinds.def"
#undef CHAINTRUE_PROBLEM_KIND
  };
  return kNames[static_cast<int>(kind)];
}

}  // namespace chaintrue::grid
