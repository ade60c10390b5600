// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A file format as a table. Private to grid/files; a format declares its fields once, and reading,
/// checking and writing follow from that: missing and unknown keys (with the nearest known one),
/// wrong types, values out of range and keys that occur twice are reported together, each by its
/// JSON pointer; the same object gives the same bytes.
///
/// \code
///   struct Hole {
///     std::string name;
///     double x_mm = 0, y_mm = 0;
///     std::optional<double> sigma_mm;
///   };
///   struct Holes {
///     std::string name;
///     std::vector<Hole> holes;
///   };
///
///   constexpr Range kCoordinate{"mm", -20000, 20000};
///   Record<Hole> hole_record() {
///     return Record<Hole>("a hole")
///         .required("name", "Its name.", &Hole::name)
///         .required("x_mm", "Commanded x.", &Hole::x_mm, kCoordinate)
///         .required("y_mm", "Commanded y, up.", &Hole::y_mm, kCoordinate)
///         .optional("sigma_mm", "1 sigma on each axis.", &Hole::sigma_mm, Range{"mm", 0, 50});
///   }
///   const Record<Holes>& holes_record() {  // static: each file is read by the same table
///     static const auto record = Record<Holes>("a chaintrue_holes file", kHolesFormat)
///         .sparse("name", "Name in messages.", &Holes::name)
///         .required("holes", "The holes.", &Holes::holes, list(hole_record(), 2))
///         .check([](const Cursor& at, Holes& holes) {  // even where fields were wrong
///           if (at.clean() && names_repeat(holes)) at.child("holes").expect("names that differ");
///         });
///     return record;
///   }
///   Holes parse_holes(const std::string& text, const std::string& file) {
///     return read_document(holes_record(), text, file);
///   }
///   std::string write_holes(const Holes& holes) { return write_document(holes_record(), holes); }
/// \endcode
///
/// Each field says what it means: schemas and reference pages (docs/formats) are made of these
/// sentences. Kinds of fields:
///   required   must be there; always written
///   optional   may be absent or null. A plain member keeps its default and is always written; a
///              std::optional member is empty, and written only when it holds a value
///   sparse     may be absent or null; written only when it is not empty (texts, lists,
///              dictionaries)
///   nullable   may be absent or null; written as null when it is empty
/// path(&Plan::bed, &Bed::width_mm) is a member of a member.
///
/// Values: a Range for a number, a Record for an object, integer, choice (an enum by its names),
/// one_of (a text from a list), list, dictionary; a std::string and a bool need none. `Record::computed` sets and gets what is not a member;
/// `Record::custom` takes a pair of functions for whatever does not fit (a variant, a list that
/// notes which of its elements were wrong). Keys are written in the order they are declared.
/// "comment" is allowed in every object and not kept.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "grid/files/formats.hpp"
#include "grid/files/json_value.hpp"

namespace chaintrue::grid::files {

/// Access to a std::optional whose value type the table does not know.
struct OptionalAccess {
  void* (*emplace)(void* member);
  void (*reset)(void* member);
  const void* (*value)(const void* member);
};
template <class V>
inline constexpr OptionalAccess kOptionalAccess = {
    [](void* member) -> void* { return &static_cast<std::optional<V>*>(member)->emplace(); },
    [](void* member) { static_cast<std::optional<V>*>(member)->reset(); },
    [](const void* member) -> const void* {
      return &**static_cast<const std::optional<V>*>(member);
    }};

/// How an empty member is written. `is_empty` is null for a type that cannot be empty.
struct IfEmpty {
  enum As { absent, null };
  bool (*is_empty)(const void* member) = nullptr;
  As as = absent;
};

/// A member of T, of a base, or of one of its members.
template <class T, class V>
struct MemberPath {
  using Type = V;
  [[nodiscard]] V& of(T& object) const {
    return *reinterpret_cast<V*>(reinterpret_cast<std::byte*>(&object) + offset);
  }
  [[nodiscard]] const V& of(const T& object) const { return of(const_cast<T&>(object)); }
  std::size_t offset = 0;
};
/// T itself has the member, or a base of it.
template <class T, class B, class V>
[[nodiscard]] MemberPath<T, V> path_in(V B::*member) {
  static const T object{};
  return {static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&(object.*member)) -
                                   reinterpret_cast<const std::byte*>(&object))};
}
template <class T, class V>
[[nodiscard]] MemberPath<T, V> path_in(MemberPath<T, V> member) {
  return member;
}
template <class T, class V>
[[nodiscard]] MemberPath<T, V> path(V T::*member) {
  return path_in<T>(member);
}
template <class T, class M, class V>
[[nodiscard]] MemberPath<T, V> path(M T::*outer, V M::*inner) {
  return {path_in<T>(outer).offset + path_in<M>(inner).offset};
}

/// What a member holds, which may be a std::optional.
template <class V>
struct Held {
  using Type = V;
  static constexpr bool kIsOptional = false;
};
template <class V>
struct Held<std::optional<V>> {
  using Type = V;
  static constexpr bool kIsOptional = true;
};

/// The part of a record that does not depend on the object's type: its keys and its fields. Objects
/// are passed by address; Record has their type. A field finds its member by an offset from the
/// object: a class for each member type dominated the compile time of grid/files.
class RecordTable {
 public:
  RecordTable(std::string noun, const Format* format) : noun_(std::move(noun)), format_(format) {}

  [[nodiscard]] const std::string& noun() const { return noun_; }
  /// The schema of an object; for a file's record, a reference to that file's schema.
  [[nodiscard]] Expected expected() const;
  /// Schema of the object itself, also for a file's record.
  [[nodiscard]] Json schema() const;

 protected:
  struct Field {
    std::string key;
    std::string meaning;
    bool is_required = false;
    std::size_t offset = 0;  ///< of the member in its object
    Expected expected = "";
    std::shared_ptr<const Codec> codec{};
    IfEmpty empty{};
  };
  using Check = std::function<void(const Cursor&, void*)>;
  /// Makes a new default object.
  using Make = std::shared_ptr<void> (*)();

  /// Adds to the field what its codec expects.
  void add(Field field, std::shared_ptr<const Codec> codec, IfEmpty empty = {});
  /// An optional field with a default, which becomes part of the schema.
  void add_defaulted(Field field, std::shared_ptr<const Codec> codec, Make make);
  void add_check(Check check) { checks_.push_back(std::move(check)); }
  void add_rule(Json rule) { rules_.push_back(std::move(rule)); }

  friend class ObjectCodec;
  /// Calls `reset`, unless it is null, as soon as the value is known to be an object.
  bool read_fields(const Cursor& at,
                   void* object,
                   bool is_root,
                   void (*reset)(void*) = nullptr) const;
  [[nodiscard]] Json write_fields(const void* object) const;

 private:
  /// False, and reported, if this is not an object or is a file of another type or version.
  [[nodiscard]] bool open(const Cursor& at, bool is_root) const;
  /// Reports unknown keys; returns the known keys for which one of them is probably a typing error.
  [[nodiscard]] std::vector<std::string> report_unknown_keys(const Cursor& at) const;
  [[nodiscard]] bool has_key(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> keys() const;
  [[nodiscard]] Json schema_of_keys() const;

  std::string noun_;
  const Format* format_;
  std::vector<Field> fields_;
  std::vector<Check> checks_;
  std::vector<Json> rules_;
};

/// For a std::optional with a value.
[[nodiscard]] std::shared_ptr<const Codec> optional_codec(std::shared_ptr<const Codec> value,
                                                          const OptionalAccess& access);

/// `reset` makes a new object of the old before it is read; null keeps it. The codec has the record's
/// table for itself.
[[nodiscard]] std::shared_ptr<const Codec> object_codec(const RecordTable& record,
                                                        void (*reset)(void*));

template <class T>
class Record : public RecordTable {
  using Text = std::string_view;
  /// Only the member determines the type, so a range or a record may be given for its value.
  template <class M>
  using MemberOf = typename decltype(path_in<T>(std::declval<M>()))::Type;
  template <class M>
  using HeldBy = typename Held<MemberOf<M>>::Type;

 public:
  /// `noun` with its article, for messages such as "expected a sprocket".
  explicit Record(std::string noun) : RecordTable(std::move(noun), nullptr) {}
  /// A file's record begins with its type and version; inside another file both may be left out.
  /// The format must outlive the record.
  Record(std::string noun, const Format& format) : RecordTable(std::move(noun), &format) {}

  template <class M>
  Record& required(Text key,
                   Text meaning,
                   M member,
                   const Value<MemberOf<M>>& value = value_of_type<MemberOf<M>>()) {
    add(field(key, meaning, true, path_in<T>(member).offset), value.codec);
    return *this;
  }

  template <class M>
  Record& optional(Text key,
                   Text meaning,
                   M member,
                   const Value<HeldBy<M>>& value = value_of_type<HeldBy<M>>()) {
    if constexpr (Held<MemberOf<M>>::kIsOptional)
      return add_if_empty(key, meaning, member, value, IfEmpty::absent);
    add_defaulted(field(key, meaning, false, path_in<T>(member).offset), value.codec, &make);
    return *this;
  }

  template <class M>
  Record& sparse(Text key,
                 Text meaning,
                 M member,
                 const Value<HeldBy<M>>& value = value_of_type<HeldBy<M>>()) {
    return add_if_empty(key, meaning, member, value, IfEmpty::absent);
  }

  template <class M>
  Record& nullable(Text key,
                   Text meaning,
                   M member,
                   const Value<HeldBy<M>>& value = value_of_type<HeldBy<M>>()) {
    return add_if_empty(key, meaning, member, value, IfEmpty::null);
  }

  /// `write` returns nothing if the key is left out.
  Record& custom(Text key,
                 Text meaning,
                 bool is_required,
                 Expected expected,
                 std::function<void(const Cursor&, T&)> read,
                 std::function<std::optional<Json>(const T&)> write) {
    add(field(key, meaning, is_required, 0),
        std::make_shared<CustomCodec>(std::move(expected), std::move(read), std::move(write)));
    return *this;
  }

  /// A value that is not a member: `set(object, value)` stores a valid one, `get(object)` returns
  /// it, or nothing if the key is left out.
  template <class V, class Set, class Get>
  Record& computed(
      Text key, Text meaning, bool is_required, const Value<V>& value, Set set, Get get) {
    return custom(
        key,
        meaning,
        is_required,
        value.expected,
        [value, set](const Cursor& at, T& object) {
          if (auto read = value.read(at); read && at.clean()) set(object, *std::move(read));
        },
        [value, get](const T& object) {
          const std::optional<V> own = get(object);
          return own ? std::optional<Json>(value.write(*own)) : std::nullopt;
        });
  }

  /// An object in the file whose fields are members of this object.
  Record& part(Text key, Text meaning, bool is_required, const Record& fields) {
    add(field(key, meaning, is_required, 0), object_codec(fields, nullptr));
    return *this;
  }

  /// A key with a constant value, such as the kind in a variant.
  Record& constant(Text key, Text meaning, const std::string& word) {
    const Value<std::string> value = one_of({word});
    return custom(
        key,
        meaning,
        true,
        value.expected,
        [value](const Cursor& at, T&) { (void)value.read(at); },
        [word](const T&) { return std::optional<Json>(word); });
  }

  /// Runs after the fields, even if some were wrong; see Cursor::clean.
  Record& check(std::function<void(const Cursor&, T&)> check) {
    add_check([own = std::move(check)](const Cursor& at, void* object) {
      own(at, *static_cast<T*>(object));
    });
    return *this;
  }

  /// Additional rules of the schema: `{"not": {"required": ["machine", "machine_file"]}}`.
  Record& schema_also(Json rule) {
    add_rule(std::move(rule));
    return *this;
  }

  /// Empty if this is not an object; otherwise the object, with what could be read.
  [[nodiscard]] std::optional<T> read(const Cursor& at, bool is_root = false) const {
    T object{};
    if (!read_fields(at, &object, is_root)) return std::nullopt;
    return object;
  }

  [[nodiscard]] Json write(const T& object) const { return write_fields(&object); }

  operator Value<T>() const { return object(*this); }  // NOLINT: tables name the record alone

 private:
  /// Of the whole object.
  class CustomCodec : public Codec {
   public:
    CustomCodec(Expected expected,
                std::function<void(const Cursor&, T&)> read,
                std::function<std::optional<Json>(const T&)> write)
        : Codec(std::move(expected)), read_(std::move(read)), write_(std::move(write)) {}
    bool read(const Cursor& at, void* object) const override {
      read_(at, *static_cast<T*>(object));
      return true;
    }
    [[nodiscard]] Json write(const void* object) const override {
      return write_(*static_cast<const T*>(object)).value_or(Json::value_t::discarded);
    }

   private:
    std::function<void(const Cursor&, T&)> read_;
    std::function<std::optional<Json>(const T&)> write_;
  };

  static Field field(Text key, Text meaning, bool is_required, std::size_t offset) {
    return {std::string(key), std::string(meaning), is_required, offset};
  }
  template <class M>
  Record& add_if_empty(
      Text key, Text meaning, M member, const Value<HeldBy<M>>& value, IfEmpty::As written) {
    std::shared_ptr<const Codec> codec = value.codec;
    if constexpr (Held<MemberOf<M>>::kIsOptional)
      codec = optional_codec(std::move(codec), kOptionalAccess<HeldBy<M>>);
    add(field(key, meaning, false, path_in<T>(member).offset),
        std::move(codec),
        {&is_empty<MemberOf<M>>, written});
    return *this;
  }
  template <class V>
  static bool is_empty(const void* member) {
    if constexpr (Held<V>::kIsOptional)
      return !static_cast<const V*>(member)->has_value();
    else
      return static_cast<const V*>(member)->empty();
  }
  static std::shared_ptr<void> make() { return std::make_shared<T>(); }
};

template <class T>
[[nodiscard]] Value<T> object(const Record<T>& record) {
  return Value<T>(object_codec(record, [](void* value) { *static_cast<T*>(value) = T{}; }));
}
template <class T>
[[nodiscard]] Value<std::vector<T>> list(const Record<T>& record, std::size_t fewest = 0) {
  return list(object(record), fewest);
}

/// `problems` has the file's name and receives the warnings. \throws InputError with every problem
/// of the text.
template <class T>
[[nodiscard]] T read_document(const Record<T>& record,
                              const std::string& text,
                              Problems& problems) {
  const Json json = parse_json(text, problems);
  std::optional<T> object = record.read(Cursor(json, problems), true);
  problems.throw_if_any();
  return std::move(object.value());
}
template <class T>
[[nodiscard]] T read_document(const Record<T>& record,
                              const std::string& text,
                              const std::string& file) {
  Problems problems(file);
  return read_document(record, text, problems);
}

template <class T>
[[nodiscard]] std::string write_document(const Record<T>& record, const T& object) {
  return print_json(record.write(object));
}

}  // namespace chaintrue::grid::files
