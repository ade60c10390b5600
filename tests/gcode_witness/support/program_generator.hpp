// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random programs over the whole accepted language, each a function of its seed.
///
/// The generator tracks the program's position, so that arcs end on their circles and cycles go
/// down: most programs are accepted. One in eight is then damaged in one place, so that rejections
/// are compared too.
#pragma once

#include <cstdint>
#include <string>

namespace chaintrue::witness {

enum class Scope {
  language,  ///< everything that our interpreter reads
  path,  ///< NIST IR 6556 alone: no O-words, polar words, G52, L20, named parameters; always accepted
};

struct GeneratorOptions {
  Scope scope = Scope::language;
  int statements = 14;           ///< approximate number
  double half_width_mm = 200.0;  ///< of the area that it works in, about the machine's zero
  double half_height_mm = 150.0;
};

std::string random_program(std::uint64_t seed, const GeneratorOptions& options = {});

}  // namespace chaintrue::witness
