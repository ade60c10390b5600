// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Damage to a file's text, by a seed: what disks, editors, spreadsheets and hurried people do, and
/// what somebody would do who means harm.
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
  /// One to four slips; or numbers that are a little, or much, others; or entries of a JSON
  /// document that are gone, doubled, exchanged or of another kind.
  [[nodiscard]] std::string damaged(std::string text);
  /// odd: one of odd_number; near: in the neighbourhood, of the same form
  enum class NumberKind { odd, near };
  /// One number of the text is another one.
  [[nodiscard]] std::string with_number(std::string text, NumberKind kind);
  /// What a person or a script may give an option that wants a number.
  [[nodiscard]] std::string odd_number();

 private:
  void slip(std::string& text);
  [[nodiscard]] std::string near_number(const std::string& number);
  [[nodiscard]] std::string with_another_entry(const std::string& text);
  std::mt19937_64 bits_;
};

}  // namespace chaintrue::torture
