// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Words of a line: letters and the values of their expressions (NISTIR 6556, section 3.3).
#pragma once

#include <map>
#include <string>
#include <vector>

namespace chaintrue::follower {

struct Line {
  std::vector<int> g;  ///< codes in tenths
  std::vector<int> m;
  std::map<char, double> words;
  bool has(char letter) const { return words.contains(letter); }
  double value(char letter, double otherwise) const {
    const auto word = words.find(letter);
    return word == words.end() ? otherwise : word->second;
  }
};

/// Reads lines and keeps the numbered parameters.
class Reader {
 public:
  /// \throws std::runtime_error if the line is not understood.
  Line read(const std::string& raw);

 private:
  double real();
  double expression();
  double operand(int precedence);
  double function();
  std::string next_operator(int precedence);
  bool accept(const std::string& text);
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  std::string text_;
  std::size_t at_ = 0;
  std::map<int, double> parameters_;
};

}  // namespace chaintrue::follower
