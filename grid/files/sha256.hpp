// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// SHA-256 (NIST FIPS 180-4, 2015), for the files that a result was made from.
///
/// \code
///   sha256("abc");  // "ba7816bf 8f01cfea ..." without blanks
/// \endcode
#pragma once

#include <istream>
#include <string>

namespace chaintrue::grid::files {

/// 64 hexadecimal digits, of all that is left to read.
std::string sha256(std::istream& in);
std::string sha256(const std::string& bytes);

}  // namespace chaintrue::grid::files
