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
///   RECORD_OF(Hole, "a hole")
///   REQUIRED(name, "Its name.")
///   REQUIRED(x_mm, "Commanded x.", kCoordinate)
///   REQUIRED(y_mm, "Commanded y, up.", kCoordinate)
///   OPTIONAL(sigma_mm, "1 sigma on each axis.", {"mm", 0, 50})
///   END_RECORD;
///
///   FILE_RECORD(holes, Holes, "a chaintrue_holes file", kHolesFormat)  // holes_record(), holes_schema()
///   SPARSE(name, "Name in messages.")
///   REQUIRED(holes, "The holes.")
///       .check([](const Cursor& at, Holes& holes) {  // even where fields were wrong
///         if (at.clean() && names_repeat(holes)) at.child("holes").expect("names that differ");
///       })
///   END_FILE_RECORD;
///
///   Holes parse_holes(const std::string& text, const std::string& file) {
///     return read_document(holes_record(), text, file);
///   }
///   std::string write_holes(const Holes& holes) { return write_document(holes_record(), holes); }
/// \endcode
///
/// Each field says what it means: schemas and reference pages (docs/formats) are made of these
/// sentences. Kinds of fields:
///   required   must be there, as null for an empty std::optional; always written
///   optional   may be absent or null. A plain member keeps its default and is always written; a
///              std::optional member is empty, and written only when it holds a value
///   sparse     may be absent or null; written only when it is not empty (texts, lists,
///              dictionaries) or is not that of a new object (anything else)
///   nullable   may be absent or null; written as null when it is empty
/// path(&Plan::bed, &Bed::width_mm) is a member of a member, and of one that a std::optional holds
/// for optional and nullable. place(&Hole::commanded, ...) stands for its x_mm and its y_mm.
///
/// Values: a Range, or its braces, for a number, a Record for an object or a list of objects,
/// integer, in_order and by_name (an enum by its names), one_of (a text from a list), list,
/// dictionary, a pair of functions for a variant; a std::string, a bool, an index and a list of them
/// need none, nor does a type with a RECORD_OF above or in a header. `Record::computed` sets and gets
/// a key that is no member; `Record::custom` takes a pair of functions for any other value (a list
/// that notes which of its elements were wrong). Keys are written in the order they are declared.
/// "comment" is allowed in every object and not kept.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/files/formats.hpp"
#include "grid/files/json_member.hpp"

namespace chaintrue::grid::files {

/// The part of a record that does not depend on the object's type: its keys and its fields. Objects
/// are passed by address; Record has their type. A field finds its member by an offset from the
/// object: a class for each member type dominated the compile time of grid/files.
class RecordTable {
 public:
  RecordTable(std::string noun, const Format* format, const void* blank)
      : noun_(std::move(noun)), format_(format), blank_(blank) {}

  /// The schema of an object; for a file's record, a reference to that file's schema.
  Expected expected() const;
  /// Schema of the object itself, also for a file's record.
  Json schema() const;

 protected:
  struct Field {
    std::string key;
    std::string meaning;
    bool is_required = false;
    std::size_t offset = 0;  ///< of the member in its object
    Json schema{};
    SharedCodec codec{};
    Json unless = kLeftOut;     ///< a value that counts as none
    Json otherwise = kLeftOut;  ///< what is written for none
  };
  /// The field has the schema of its codec.
  Field& add(Field field, const SharedCodec& codec);
  /// The field of a default-constructed object, as JSON.
  Json written_default(const Field& field) const;
  /// The default becomes part of the schema if it is a number, a choice, a boolean or a non-empty
  /// list of these. Texts have no default.
  void state_default(Field& field) const;

  friend SharedCodec object_codec(const RecordTable& record, void (*reset)(void*));
  /// Calls `reset`, unless it is null, as soon as the value is known to be an object.
  bool read_fields(const Cursor& at, void* object, bool is_root,
                   void (*reset)(void*) = nullptr) const;
  Json write_fields(const void* object) const;

  std::vector<Field> fields_;
  std::vector<std::function<void(const Cursor&, void*)>> checks_;
  std::vector<Json> rules_;

 private:
  /// False, and reported, if this is not an object or is a file of another type or version.
  bool open(const Cursor& at, bool is_root) const;
  /// Reports unknown keys; returns the known keys for which one of them is probably a typing error.
  Words report_unknown_keys(const Cursor& at) const;
  Words keys() const;

  std::string noun_;
  const Format* format_;
  const void* blank_;  ///< a new object
};

/// `reset` makes a new object of the old before it is read; null keeps it. The codec has the record's
/// table for itself.
SharedCodec object_codec(const RecordTable& record, void (*reset)(void*));

template <class T>
class Record : public RecordTable {
  using Text = std::string_view;
  /// Only the member determines the type, so a range or a record may be given for its value.
  template <class M>
  using PathOf = decltype(path_in<T>(std::declval<M>()));
  template <class M>
  using ValueOf = Value<typename PathOf<M>::Type>;
  template <class M>
  static ValueOf<M> value_of() {
    return value_of_type<typename PathOf<M>::Type>();
  }

 public:
  /// `noun` with its article, for messages such as "expected a sprocket".
  explicit Record(std::string noun) : RecordTable(std::move(noun), nullptr, &blank<T>()) {}
  /// A file's record begins with its type and version; inside another file both may be left out.
  /// The format must outlive the record.
  Record(std::string noun, const Format& format)
      : RecordTable(std::move(noun), &format, &blank<T>()) {}

  template <class M>
  Record& required(Text key, Text meaning, M member, const ValueOf<M>& value = value_of<M>()) {
    Field& own = add_member(key, meaning, true, member, value);
    if constexpr (PathOf<M>::kIsOptional) own.otherwise = nullptr;
    return *this;
  }

  template <class M>
  Record& optional(Text key, Text meaning, M member, const ValueOf<M>& value = value_of<M>()) {
    Field& own = add_member(key, meaning, false, member, value);
    if constexpr (!PathOf<M>::kIsOptional) state_default(own);
    return *this;
  }

  template <class M>
  Record& sparse(Text key, Text meaning, M member, const ValueOf<M>& value = value_of<M>()) {
    Field& own = add_member(key, meaning, false, member, value);
    own.unless = written_default(own);
    return *this;
  }

  template <class M>
  Record& nullable(Text key, Text meaning, M member, const ValueOf<M>& value = value_of<M>()) {
    sparse(key, meaning, member, value);
    fields_.back().otherwise = nullptr;
    return *this;
  }

  /// The required x_mm and y_mm of a member.
  template <class P>
  Record& place(P T::*member, Text x, Text y, const Value<double>& value) {
    return required("x_mm", x, path(member, &P::x_mm), value)
        .required("y_mm", y, path(member, &P::y_mm), value);
  }
  /// The required x_mm and y_mm of the object itself.
  Record& place(Text x, Text y, const Value<double>& value) {
    return required("x_mm", x, &T::x_mm, value).required("y_mm", y, &T::y_mm, value);
  }

  /// `write` returns a discarded value if the key is left out.
  Record& custom(Text key, Text meaning, bool is_required, Expected expected,
                 std::function<void(const Cursor&, T&)> read, std::function<Json(const T&)> write) {
    return custom(key, meaning, is_required,
                  partial<T>(std::move(expected), std::move(read), std::move(write)));
  }
  /// The same, of a value that leaves the rest of the object as it is.
  Record& custom(Text key, Text meaning, bool is_required, const Value<T>& value) {
    add(field(key, meaning, is_required, 0), value.codec);
    return *this;
  }

  /// A value that is not a member: `set(object, value)` stores a valid one, `get(object)` returns
  /// it, or nothing if the key is left out; or it returns what is written. Either may be a member.
  template <class V, class Set, class Get>
  Record& computed(Text key, Text meaning, bool is_required, const Value<V>& value, Set set,
                   Get get) {
    return custom(
        key, meaning, is_required, value.expected,
        [value, set](const Cursor& at, T& object) {
          if (auto read = value.read(at); read && at.clean()) {
            if constexpr (std::is_member_pointer_v<Set>) {
              object.*set = *std::move(read);
            } else {
              set(object, *std::move(read));
            }
          }
        },
        [value, get](const T& object) -> Json {
          const auto own = std::invoke(get, object);
          if constexpr (std::is_same_v<decltype(own), const Json>) {
            return own;
          } else {
            const std::optional<V> held = own;
            return held ? value.write(*held) : kLeftOut;
          }
        });
  }

  /// An object in the file whose fields are members of this object.
  Record& part(Text key, Text meaning, bool is_required, const Record& fields) {
    return custom(key, meaning, is_required, Value<T>(object_codec(fields, nullptr)));
  }

  /// A key of the file, not of the object: read and checked, and `written` whatever the object is.
  template <class V>
  Record& beside(Text key, Text meaning, bool is_required, const Value<V>& value,
                 const Json& written = kLeftOut) {
    return custom(
        key, meaning, is_required, value.expected,
        [value](const Cursor& at, T&) { (void)value.read(at); },
        [written](const T&) { return written; });
  }

  /// A key with a constant value, such as the kind in a variant.
  Record& constant(Text key, Text meaning, const std::string& word) {
    return beside(key, meaning, true, one_of({word}), word);
  }

  /// The keys that `add(record)` adds.
  template <class Add>
  Record& with(const Add& add) {
    add(*this);
    return *this;
  }

  /// Runs after the fields, even if some were wrong; see Cursor::clean.
  Record& check(std::function<void(const Cursor&, T&)> check) {
    checks_.push_back([own = std::move(check)](const Cursor& at, void* object) {
      own(at, *static_cast<T*>(object));
    });
    return *this;
  }

  /// Additional rules of the schema: `{"not": {"required": ["machine", "machine_file"]}}`.
  Record& schema_also(Json rule) {
    rules_.push_back(std::move(rule));
    return *this;
  }

  /// Empty if this is not an object; otherwise the object, with what could be read.
  std::optional<T> read(const Cursor& at, bool is_root = false) const {
    T object{};
    if (!read_fields(at, &object, is_root)) return std::nullopt;
    return object;
  }

  Json write(const T& object) const { return write_fields(&object); }

  operator Value<T>() const { return object(*this); }  // NOLINT: tables name the record alone
  operator Value<std::vector<T>>() const { return list(*this); }  // NOLINT

 private:
  static Field field(Text key, Text meaning, bool is_required, std::size_t offset) {
    return {std::string(key), std::string(meaning), is_required, offset};
  }
  template <class M>
  Field& add_member(Text key, Text meaning, bool is_required, M member, const ValueOf<M>& value) {
    const PathOf<M> path = path_in<T>(member);
    return add(field(key, meaning, is_required, path.offset), path.codec_for(value));
  }
};

/// Tables. RECORD_OF to END_RECORD is what members of a type expect; FILE_RECORD to END_FILE_RECORD
/// a format, made once, with its schema. RECORD begins the table of any other function, whose last
/// line ends in a semicolon; KEPT_RECORD makes `record` once. Each line adds keys: one that has the
/// name of its member is said once, NAMED has both, NESTED is of a member of a member; FIELD is any
/// other call of a Record, ALSO that of a function that takes the record.
#define RECORD(type, ...) \
  using Own = type;       \
  return Record<Own>(__VA_ARGS__)
#define KEPT_RECORD(type, ...) \
  using Own = type;            \
  static const auto record = Record<Own>(__VA_ARGS__)
#define RECORD_OF(type, noun)        \
  Record<type> record_of(Of<type>) { \
    RECORD(type, noun)
#define END_RECORD \
  ;                \
  }                \
  static_assert(true)
#define FILE_RECORD(name, type, noun, format)               \
  const Record<type>& name##_record();                      \
  Json name##_schema() { return name##_record().schema(); } \
  const Record<type>& name##_record() {                     \
    KEPT_RECORD(type, noun, format)
#define END_FILE_RECORD \
  ;                     \
  return record;        \
  }                     \
  static_assert(true)
#define EXPECTED_GIVEN(member, ...) __VA_ARGS__
#define EXPECTED_(member) record_of(Of<Element<Held<decltype(Own::member)>::Type>::Type>())
#define NAMED(kind, key, member, meaning, ...) \
  .kind(key, meaning, &Own::member, EXPECTED_##__VA_OPT__(GIVEN)(member __VA_OPT__(, ) __VA_ARGS__))
#define NESTED(kind, key, outer, inner, meaning, ...) \
  .kind(key, meaning, path(&Own::outer, &Held<decltype(Own::outer)>::Type::inner), __VA_ARGS__)
#define REQUIRED(member, ...) NAMED(required, #member, member, __VA_ARGS__)
#define OPTIONAL(member, ...) NAMED(optional, #member, member, __VA_ARGS__)
#define SPARSE(member, ...) NAMED(sparse, #member, member, __VA_ARGS__)
#define NULLABLE(member, ...) NAMED(nullable, #member, member, __VA_ARGS__)
#define FIELD(call, ...) .call(__VA_ARGS__)
#define ALSO(add, ...) .with([&](auto& own) { add(own __VA_OPT__(, ) __VA_ARGS__); })

template <class T>
Value<T> object(const Record<T>& record) {
  return Value<T>(object_codec(record, [](void* value) { *static_cast<T*>(value) = T{}; }));
}
template <class T>
Value<std::vector<T>> list(const Record<T>& record, std::size_t fewest = 0) {
  return list(object(record), fewest);
}

/// `problems` has the file's name and receives the warnings. \throws InputError with every problem
/// of the text.
template <class T>
T read_document(const Record<T>& record, const std::string& text, Problems& problems) {
  const Json json = parse_json(text, problems);
  std::optional<T> object = record.read(Cursor(json, problems), true);
  problems.throw_if_any();
  return std::move(object.value());
}
template <class T>
T read_document(const Record<T>& record, const std::string& text, const std::string& file) {
  Problems problems(file);
  return read_document(record, text, problems);
}

template <class T>
std::string write_document(const Record<T>& record, const T& object) {
  return print_json(record.write(object));
}

}  // namespace chaintrue::grid::files
