// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A check on every printed number: NaN and infinity are not printed.
///
/// In grid/ and tools/ <fmt/format.h> includes this file (grid/printing/ comes first on their
/// include path), and fmt::format, fmt::format_to and fmt::print in namespace chaintrue are the
/// functions below: they call fmt's own, and throw std::logic_error where a number is not finite.
/// Such a number is a bug; throwing here keeps it out of files, tables, pages and sentences. The
/// JSON writer (grid/files/json_text.hpp) and the charts (tools/report/render.cpp) have the same
/// check.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>

namespace chaintrue::fmt {

using namespace ::fmt;  // NOLINT(google-build-using-namespace): replaces it

namespace gate {

[[noreturn]] inline void refuse() {
  throw std::logic_error("a number that is none, or infinite, was about to be printed");
}

template <class T>
void pass(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) refuse();
  }
}
template <class Iterator, class Sentinel>
void pass(const ::fmt::join_view<Iterator, Sentinel, char>& values) {
  for (auto at = values.begin; at != values.end; ++at) pass(*at);
}

}  // namespace gate

template <class... Args>
std::string format(::fmt::format_string<Args...> text, Args&&... args) {
  (gate::pass(args), ...);
  return ::fmt::format(text, std::forward<Args>(args)...);
}

/// Formats to a string first: otherwise fmt compiles all of its formatting once more for every kind
/// of output.
template <class Output, class... Args>
Output format_to(Output output, ::fmt::format_string<Args...> text, Args&&... args) {
  const std::string whole = fmt::format(text, std::forward<Args>(args)...);
  return std::copy(whole.begin(), whole.end(), std::move(output));
}

template <class... Args>
void print(::fmt::format_string<Args...> text, Args&&... args) {
  (gate::pass(args), ...);
  ::fmt::print(text, std::forward<Args>(args)...);
}

/// A message that cannot be written (standard error is full or closed) is no reason to stop.
template <class... Args>
void print(std::FILE* file, ::fmt::format_string<Args...> text, Args&&... args) {
  (gate::pass(args), ...);
  const std::string whole = ::fmt::format(text, std::forward<Args>(args)...);
  const bool is_written = std::fwrite(whole.data(), 1, whole.size(), file) == whole.size();
  if (!is_written && file != stderr)
    throw std::system_error(errno, std::generic_category(), "standard output");
}

}  // namespace chaintrue::fmt
