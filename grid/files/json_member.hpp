// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Members of objects by their offsets, so that a table of fields needs no type of theirs:
/// path(&Plan::bed, &Bed::width_mm). Private to grid/files.
#pragma once

#include <cstddef>
#include <optional>

#include "grid/files/json_value.hpp"

namespace chaintrue::grid::files {

/// Access to a std::optional whose value type the table does not know.
struct OptionalAccess {
  void* (*emplace)(void* member);
  void (*reset)(void* member);
  const void* (*value)(const void* member);  ///< null if it is empty
};
template <class V>
inline constexpr OptionalAccess kOptionalAccess = {
    [](void* member) -> void* { return &static_cast<std::optional<V>*>(member)->emplace(); },
    [](void* member) { static_cast<std::optional<V>*>(member)->reset(); },
    [](const void* member) -> const void* {
      const auto& held = *static_cast<const std::optional<V>*>(member);
      return held ? &*held : nullptr;
    }};

/// For a std::optional, or for a member at this offset of what it holds; null if it is empty.
SharedCodec optional_codec(const SharedCodec& value, const OptionalAccess& access,
                           std::size_t offset = 0);

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

/// A member M of T, of a base, or of one of its members; or a V of what a std::optional M holds.
template <class T, class M, class V = typename Held<M>::Type>
struct MemberPath {
  using Type = V;
  static constexpr bool kIsOptional = Held<M>::kIsOptional;
  SharedCodec codec_for(const Value<V>& value) const {
    if constexpr (kIsOptional) {
      return optional_codec(value.codec, kOptionalAccess<typename Held<M>::Type>, inner);
    } else {
      return value.codec;
    }
  }
  std::size_t offset = 0;
  std::size_t inner = 0;  ///< in what the std::optional holds
};

/// A default-constructed object.
template <class T>
const T& blank() {
  static const T object{};
  return object;
}
/// T itself has the member, or a base of it.
template <class T, class B, class M>
MemberPath<T, M> path_in(M B::*member) {
  return {static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&(blank<T>().*member)) -
                                   reinterpret_cast<const std::byte*>(&blank<T>()))};
}
template <class T, class M, class V>
MemberPath<T, M, V> path_in(MemberPath<T, M, V> member) {
  return member;
}
template <class T, class M, class V>
MemberPath<T, V> path(M T::*outer, V M::*inner) {
  return {path_in<T>(outer).offset + path_in<M>(inner).offset};
}
template <class T, class M, class V>
MemberPath<T, std::optional<M>, V> path(std::optional<M> T::*outer, V M::*inner) {
  return {path_in<T>(outer).offset, path_in<M>(inner).offset};
}

}  // namespace chaintrue::grid::files
