// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whole containers as arguments of the standard algorithms, and positions between the standard library,
/// whose are unsigned, and Eigen, whose are signed. (std::ranges is missing in the library with which the
/// page is built.) Counts enter formulas as doubles. The extremes of nothing are a broken precondition.
///
/// \code
///   if (contains(members, cause)) ...
///   stable_sort(models, descending(&CandidateModel::log_weight));
///   for (const auto k : each_index(columns)) design.col(as_index(k)) = columns[k];
/// \endcode
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <numeric>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "grid/precondition.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// Texts in a list: names, sentences, words of a command line.
using Words = std::vector<std::string>;
/// Positions in a list, of rows in a matrix and of its columns; a flag for each of a list.
using Indices = std::vector<std::size_t>;
using Rows = std::vector<Index>;
using ColumnSet = std::vector<Index>;
using Flags = std::vector<bool>;

/// A whole number, or an enumerator by its place in the list of its enumeration.
template <class T>
concept Countable = std::integral<T> || std::is_enum_v<T>;
constexpr std::size_t as_size(Countable auto position) {
  return static_cast<std::size_t>(position);
}
constexpr Index as_index(Countable auto position) { return static_cast<Index>(position); }
constexpr int as_int(Countable auto count) { return static_cast<int>(count); }
constexpr double as_double(std::integral auto count) { return static_cast<double>(count); }
/// The word of an enumerator, from those of its enumeration in their order.
constexpr std::string_view word_of(Countable auto one,
                                   std::initializer_list<std::string_view> words) {
  return words.begin()[as_size(one)];
}

template <class Container, class Value>
bool contains(const Container& all, const Value& one) {
  return std::find(std::begin(all), std::end(all), one) != std::end(all);
}
/// Makes a predicate from a member or a function of the elements: any_of(points, &MeasuredPoint::order)
/// is true if any point has an order.
template <class Predicate>
auto holding(Predicate holds) {
  return [=](const auto& one) { return static_cast<bool>(std::invoke(holds, one)); };
}

template <class Container, class Predicate>
bool any_of(const Container& all, Predicate holds) {
  return std::any_of(std::begin(all), std::end(all), holding(holds));
}
template <class Container, class Predicate>
bool all_of(const Container& all, Predicate holds) {
  return std::all_of(std::begin(all), std::end(all), holding(holds));
}
template <class Container, class Predicate>
bool none_of(const Container& all, Predicate holds) {
  return !any_of(all, holds);
}

template <class Container, class Predicate>
std::size_t count_where(const Container& all, Predicate holds) {
  return as_size(std::count_if(std::begin(all), std::end(all), holding(holds)));
}
template <class Container, class Value>
std::size_t count_equal(const Container& all, const Value& one) {
  return as_size(std::count(std::begin(all), std::end(all), one));
}

/// A member or a function of each element: mapped(points, &MeasuredPoint::mark).
template <class Container, class Function>
auto mapped(const Container& all, Function of) {
  std::vector<std::decay_t<decltype(std::invoke(of, *std::begin(all)))>> found;
  for (const auto& one : all) found.push_back(std::invoke(of, one));
  return found;
}

template <class Container, class... Less>
void sort(Container& all, Less... less) {
  std::sort(std::begin(all), std::end(all), less...);
}
template <class Container, class... Less>
void stable_sort(Container& all, Less... less) {
  std::stable_sort(std::begin(all), std::end(all), less...);
}

/// The first element that satisfies the predicate; null if none does.
template <class Container, class Predicate>
auto* find_where(Container& all, Predicate holds) {
  const auto found = std::find_if(std::begin(all), std::end(all), holding(holds));
  return found != std::end(all) ? &*found : nullptr;
}

/// Whether a member or a function of an element is equal to the value: find_where(crosses,
/// having(&DrawnCross::name, name)).
template <class Key, class Value>
auto having(Key key, Value value) {
  return [=](const auto& one) { return std::invoke(key, one) == value; };
}

/// Orders by a member or by a function of each element: stable_sort(models,
/// descending(&CandidateModel::log_weight)).
template <class Key>
auto ascending(Key key) {
  return [key](const auto& a, const auto& b) { return std::invoke(key, a) < std::invoke(key, b); };
}
template <class Key>
auto descending(Key key) {
  return [key](const auto& a, const auto& b) { return std::invoke(key, a) > std::invoke(key, b); };
}

/// 0, 1, ... below `count`.
template <class Integer = std::size_t>
std::vector<Integer> numbers_below(std::integral auto count) {
  std::vector<Integer> all(as_size(count));
  std::iota(all.begin(), all.end(), Integer{0});
  return all;
}

/// The same to walk over, without a list of them.
template <std::integral Integer>
class Below {
 public:
  struct Iterator {
    Integer at;
    constexpr Integer operator*() const { return at; }
    constexpr Iterator& operator++() { return ++at, *this; }
    constexpr bool operator!=(Iterator other) const { return at != other.at; }
  };
  constexpr explicit Below(Integer count) : count_(std::max(count, Integer{0})) {}
  constexpr Iterator begin() const { return {0}; }
  constexpr Iterator end() const { return {count_}; }

 private:
  Integer count_;
};
constexpr auto each_below(std::integral auto count) { return Below(count); }
/// The positions in a list.
constexpr auto each_index(const auto& all) { return each_below(std::size(all)); }

/// Each value once, in ascending order.
template <class Container>
void sort_unique(Container& all) {
  sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
}
template <class Container, class Other>
void append_all(Container& all, const Other& more) {
  all.insert(all.end(), std::begin(more), std::end(more));
}

/// \throws std::invalid_argument if the container is empty.
template <class Container>
void require_some(const Container& all) {
  if (std::size(all) == 0) throw precondition("the largest or the smallest of {} values", 0);
}
template <class Container, class... Less>
auto max_element(const Container& all, Less... less) {
  require_some(all);
  return std::max_element(std::begin(all), std::end(all), less...);
}
template <class Container, class... Less>
auto min_element(const Container& all, Less... less) {
  require_some(all);
  return std::min_element(std::begin(all), std::end(all), less...);
}
template <class Container, class... Less>
auto minmax_element(const Container& all, Less... less) {
  require_some(all);
  return std::minmax_element(std::begin(all), std::end(all), less...);
}

}  // namespace chaintrue::grid
