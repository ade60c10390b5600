// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One value of a JSON document: its place, how it is read, checked and written, and what is
/// expected of it, in words and as a JSON Schema. json_reader.hpp builds formats from these.
/// Private to grid/files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/json_text.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {

/// A place in the document: the value, its pointer, and the list for problems. Must not outlive its
/// parents.
class Cursor {
 public:
  Cursor(const Json& root, Problems& problems) : json_(&root), problems_(&problems) {}

  const Json& json() const { return *json_; }
  std::string pointer() const;
  Problems& problems() const { return *problems_; }
  /// The whole document.
  const Json& root() const { return parent_ == nullptr ? *json_ : parent_->root(); }
  /// A key that is absent reads as null.
  Cursor child(std::string_view key) const;
  Cursor element(std::size_t index) const;
  bool has(std::string_view key) const;
  /// It is absent, too.
  bool is_null(std::string_view key) const { return child(key).json().is_null(); }
  /// Nothing was reported here or below so far.
  bool clean() const { return !problems_->any() || !problems_->at_or_below(pointer()); }

  /// Reports that this value is not the expected one; `missing` reports that it is absent.
  std::nullopt_t expect(std::string expected, ProblemKind kind = ProblemKind::unexpected) const;
  void missing(std::string expected) const;
  /// As above, for something found inside the value, such as a wrong number of elements.
  void report(std::string_view found, ProblemKind kind, std::string expected) const {
    problems_->add(pointer(), found, kind, std::move(expected));
  }
  /// Adds a warning, a complete sentence, about this place; reading continues.
  void warn(std::string sentence) const { problems_->warn(pointer(), std::move(sentence)); }

 private:
  Cursor(const Json& json, const Cursor* parent, std::string_view key, std::size_t index)
      : json_(&json), problems_(parent->problems_), parent_(parent), key_(key), index_(index) {}

  const Json* json_;
  Problems* problems_;
  const Cursor* parent_ = nullptr;
  std::string_view key_;
  std::size_t index_ = 0;
};

/// The expectation of a value: in words for messages, and as a JSON Schema for editors and the
/// reference pages (format_pages.hpp).
struct Expected {
  std::string words;
  Json schema;
};

inline const Json kLeftOut(Json::value_t::discarded);

/// Reads values of one type into memory and writes them from it. Tables of formats hold codecs, so that
/// their own code is compiled once and not once for each type.
struct Codec {
  Expected expected;
  /// False, and reported, if the value is wrong; the memory is then unchanged.
  std::function<bool(const Cursor&, void*)> read;
  /// A discarded value omits a field's key.
  std::function<Json(const void*)> write;
};
using SharedCodec = std::shared_ptr<const Codec>;
inline SharedCodec shared_codec(Codec codec) { return std::make_shared<Codec>(std::move(codec)); }

template <class V>
struct Value;
Value<double> number(Range range);
Value<bool> boolean();
Value<std::string> text();
/// A seed of random numbers.
Value<std::uint64_t> seed_number();

/// A codec with its type. `expected` may be replaced for a custom field. Ranges and records
/// (json_reader.hpp) may be given for the values that they describe.
template <class V>
struct Value {
  Value(const Range& range)  // NOLINT: tables name the range alone
      requires std::is_same_v<V, double> : Value(number(range)) {}
  Value(std::string_view unit, double least, double most) requires std::is_same_v<V, double>
      : Value(number({unit, least, most})) {}
  explicit Value(SharedCodec own) : codec(std::move(own)), expected(codec->expected) {}
  /// `read` returns the whole value, or nothing.
  Value(std::function<std::optional<V>(const Cursor&)> read, std::function<Json(const V&)> write,
        Expected in_words)
      : Value(shared_codec({std::move(in_words),
                            [own = std::move(read)](const Cursor& at, void* value) {
                              std::optional<V> result = own(at);
                              if (result) *static_cast<V*>(value) = std::move(*result);
                              return result.has_value();
                            },
                            [own = std::move(write)](const void* value) {
                              return own(*static_cast<const V*>(value));
                            }})) {}

  std::optional<V> read(const Cursor& at) const {
    V value{};
    return codec->read(at, &value) ? std::optional<V>(std::move(value)) : std::nullopt;
  }
  Json write(const V& value) const { return codec->write(&value); }
  operator Value<std::vector<V>>() const { return list(*this); }

  SharedCodec codec;
  Expected expected;
};

/// A value that sets some members of an object and leaves the others as they are.
template <class T>
Value<T> partial(Expected expected, std::function<void(const Cursor&, T&)> read,
                 std::function<Json(const T&)> write) {
  return Value<T>(shared_codec({std::move(expected),
                                [own = std::move(read)](const Cursor& at, void* object) {
                                  own(at, *static_cast<T*>(object));
                                  return true;
                                },
                                [own = std::move(write)](const void* object) {
                                  return own(*static_cast<const T*>(object));
                                }}));
}

/// A value that is kept as another type: `to` makes it of what was read without a problem, `back`
/// is its inverse.
template <class V, class From, class To, class Back>
Value<V> converted(const Value<From>& value, To to, Back back) {
  return {[value, to](const Cursor& at) -> std::optional<V> {
            const std::optional<From> read = value.read(at);
            if (!read || !at.clean()) return std::nullopt;
            return to(*read);
          },
          [value, back](const V& own) { return value.write(back(own)); }, value.expected};
}

/// Largest number of points, distances and positions.
inline constexpr int kMostNumbered = 1000000;
/// The number of a point, a distance or a position, from 0; or a count.
Value<std::size_t> index_number(int least = 0, int most = kMostNumbered);

inline constexpr Range kAnyNumber{"", -1e12, 1e12};
/// The expectation that follows from the type: any number, a text, true or false, an index, a list
/// of these.
template <class V>
Value<V> value_of_type() {
  if constexpr (std::is_same_v<V, double>) {
    return kAnyNumber;
  } else if constexpr (std::is_same_v<V, bool>) {
    return boolean();
  } else if constexpr (std::is_same_v<V, std::size_t>) {
    return index_number();
  } else if constexpr (std::is_same_v<V, std::string>) {
    return text();
  } else {
    return list(value_of_type<typename V::value_type>());
  }
}

/// A type by which record_of() finds what a member of that type expects: RECORD_OF of its own file
/// or of a header, or else value_of_type().
template <class T>
struct Of {};
/// The element type of a list; any other type is its own element.
template <class V>
struct Element {
  using Type = V;
};
template <class V>
struct Element<std::vector<V>> : Element<V> {};
template <class V>
Value<V> record_of(Of<V>) {
  return value_of_type<V>();
}

Value<int> integer(int least, int most);
Value<std::string> one_of(const Words& names);

/// A value by its name, such as an enum. One without a name is no choice: it stands for null.
template <class E>
Value<E> choice_of(const std::vector<std::pair<std::string, E>>& names) {
  using Named = std::pair<std::string, E>;
  Words words = mapped(names, &Named::first);
  std::erase(words, "");
  return converted<E>(
      one_of(words),
      [names](const std::string& word) {
        return find_where(names, having(&Named::first, word))->second;
      },
      [names](const E& value) {
        const auto* known = find_where(names, having(&Named::second, value));
        if (known == nullptr)
          throw std::logic_error("a JSON writer was given a value without a name");
        return known->first;
      });
}

/// One of words for the enumerators 0, 1, ...
template <class E>
Value<E> in_order(const Words& words) {
  std::vector<std::pair<std::string, E>> names;
  for (const auto i : each_index(words)) names.emplace_back(words[i], static_cast<E>(i));
  return choice_of<E>(names);
}

/// The same, with names from `name(value)`.
template <class E>
Value<E> by_name(const std::vector<E>& values) {
  std::vector<std::pair<std::string, E>> names;
  for (const E value : values) names.emplace_back(name(value), value);
  return choice_of<E>(names);
}
/// The values of an enum up to this one.
template <class E>
Value<E> by_name_to(E last) {
  std::vector<E> values;
  for (const auto i : each_below(as_size(last) + 1)) values.push_back(static_cast<E>(i));
  return by_name(values);
}

/// Access to a std::vector whose element type the codec does not know.
struct ListAccess {
  void (*clear)(void* list);
  void* (*append)(void* list);
  std::size_t (*size)(const void* list);
  const void* (*element)(const void* list, std::size_t index);
};
template <class V>
inline constexpr ListAccess kListAccess = {
    [](void* list) { static_cast<std::vector<V>*>(list)->clear(); },
    [](void* list) -> void* { return &static_cast<std::vector<V>*>(list)->emplace_back(); },
    [](const void* list) { return static_cast<const std::vector<V>*>(list)->size(); },
    [](const void* list, std::size_t index) -> const void* {
      return static_cast<const std::vector<V>*>(list)->data() + index;
    }};
SharedCodec list_codec(const SharedCodec& element, const ListAccess& access, std::size_t fewest);

/// Schema of a list of such elements.
Json list_schema(const Json& element, std::size_t fewest);

/// `fewest` elements at least.
template <class V>
Value<std::vector<V>> list(const Value<V>& element, std::size_t fewest = 0) {
  return Value<std::vector<V>>(list_codec(element.codec, kListAccess<V>, fewest));
}
inline Value<std::vector<double>> list(const Range& range, std::size_t fewest = 0) {
  return list(number(range), fewest);
}

/// The schema, with null allowed.
Json schema_or_null(Json schema);

/// Schema of an object whose keys are not known in advance.
Json dictionary_schema(const Json& element);

/// Numbers whose keys are not known in advance.
Value<std::map<std::string, double>> dictionary(const Value<double>& element);

}  // namespace chaintrue::grid::files
