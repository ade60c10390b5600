// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The message of a broken precondition.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace chaintrue::testing_support {

inline std::string refusal_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("no invalid_argument but ") + error.what();
  }
  return "nothing thrown";
}

}  // namespace chaintrue::testing_support
