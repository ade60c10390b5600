// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Technical terms of the pages: listed at the end of a page, and as hover text where a term first
/// occurs in a paragraph.
#pragma once

#include <span>
#include <string_view>

#include "tools/report/document.hpp"

namespace chaintrue::report {

struct Term {
  std::string_view word;
  std::string_view meaning;
};
[[nodiscard]] std::span<const Term> terms();

/// A folded section with all of them.
[[nodiscard]] Section glossary();

}  // namespace chaintrue::report
