// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/number_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <utility>

#include "grid/containers.hpp"

namespace chaintrue::grid::input_checks {
namespace {

// Logarithms of the number of alternative values, for one of four numbers of four or five digits in
// a row.
constexpr double kSign = 2.1;       // 2 numbers and their exchange, by 4 ways to go wrong
constexpr double kTapeMark = 3.0;   // two lengths, either way, 4 numbers
constexpr double kExchanged = 2.8;  // 4 pairs of digits, 4 numbers
constexpr double kPoint = 1.0;      // 4 places of the point; more often lost than a digit
constexpr double kDoubled = 3.0;    // 5 digits to take away, 4 numbers
constexpr double kWrong = 5.2;      // 5 digits of 9, 4 numbers
constexpr double kDropped = 5.5;    // 6 places for 10 digits, 4 numbers

class Slips {
 public:
  explicit Slips(double written) : written_(written) {}

  void add(double value, std::string question, double penalty) {
    if (value == written_ || !std::isfinite(value)) return;
    for (const NumberError& other : slips_) {
      if (other.value == value) return;  // the simpler kind comes first
    }
    slips_.push_back({value, std::move(question), penalty});
  }
  void add_digits(const std::string& text, double penalty) {
    const double size = std::strtod(text.c_str(), nullptr);
    const double value = std::signbit(written_) ? -size : size;
    add(value, rather(value), penalty);
  }
  std::string rather(double value) const {
    return fmt::format("is it {} rather than {}?", digits_of(value), digits_of(written_));
  }
  [[nodiscard]] std::vector<NumberError> take() { return std::move(slips_); }

 private:
  double written_;
  std::vector<NumberError> slips_;
};

constexpr std::string_view kDigits = "0123456789";
bool is_digit(char c) { return contains(kDigits, c); }

void add_digit_errors(const std::string& text, Slips& slips) {
  const auto replace = [&](std::size_t at, std::size_t count, const std::string& by,
                           double penalty) {
    slips.add_digits(std::string(text).replace(at, count, by), penalty);
  };
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const std::size_t j = text[i + 1] == '.' ? i + 2 : i + 1;
    if (j >= text.size() || text[i] == '.') continue;
    std::string exchanged = text;
    std::swap(exchanged[i], exchanged[j]);
    slips.add_digits(exchanged, kExchanged);
  }
  for (const auto i : each_index(text)) {
    if (!is_digit(text[i]) || text.size() < 2) continue;
    replace(i, 1, "", kDoubled);
  }
  for (const auto i : each_index(text)) {
    if (!is_digit(text[i])) continue;
    for (const char c : kDigits) replace(i, 1, {c}, kWrong);
  }
  for (std::size_t i = 0; i <= text.size(); ++i) {
    for (const char c : kDigits) replace(i, 0, {c}, kDropped);
  }
}

}  // namespace

std::string digits_of(double value) { return fmt::format("{:.10g}", value); }

std::vector<NumberError> number_errors(double written, bool is_signed) {
  Slips slips(written);
  if (is_signed) {
    slips.add(-written, written > 0.0 ? "is the minus missing?" : "is there a minus too many?",
              kSign);
  }
  const auto tape = [&](double by_mm, const char* why) {
    for (const double value : {written + by_mm, written - by_mm}) {
      if (is_signed || value > 0.0) {
        slips.add(
            value,
            fmt::format("is it {} rather than {} ({})?", digits_of(value), digits_of(written), why),
            kTapeMark);
      }
    }
  };
  tape(kTapeMarkMm, "the tape held at its 100 mm mark");
  tape(kMmPerFoot, "a foot miscounted");
  for (const double factor : {10.0, 0.1, 100.0, 0.01}) {
    slips.add(written * factor, slips.rather(written * factor), kPoint);
  }
  slips.add(written * kMmPerInch,
            fmt::format("is it in inches, {} mm?", digits_of(written * kMmPerInch)), kPoint);
  add_digit_errors(digits_of(std::abs(written)), slips);
  return slips.take();
}

}  // namespace chaintrue::grid::input_checks
