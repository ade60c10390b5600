// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random damage to a file's text: errors of disks, editors, spreadsheets and people, and malicious
/// changes.
#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace chaintrue::torture {

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : bits_(seed) {}

  /// 0 to count - 1.
  [[nodiscard]] std::size_t below(std::size_t count) { return bits_() % count; }
  template <class List>
  [[nodiscard]] const auto& one_of(const List& list) {
    return list[below(std::size(list))];
  }
  /// One to four random errors; or numbers changed slightly or strongly; or entries of a JSON
  /// document that are removed, doubled, exchanged or of another kind.
  [[nodiscard]] std::string damaged(std::string text);
  /// odd: one of odd_number; near: a similar number of the same form
  enum class NumberKind { odd, near };
  /// One number of the text is changed.
  [[nodiscard]] std::string with_number(std::string text, NumberKind kind);
  /// A value that a user or a script may give to a numeric option.
  [[nodiscard]] std::string odd_number();

 private:
  void slip(std::string& text);
  [[nodiscard]] std::string near_number(const std::string& number);
  [[nodiscard]] std::string with_another_entry(const std::string& text);
  std::mt19937_64 bits_;
};

}  // namespace chaintrue::torture
