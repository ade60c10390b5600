// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The inner loops of interp/linear_algebra.hpp, compiled for several processors. Only raw
/// pointers pass: the translation units behind the tables share no template with any other, so the
/// linker cannot put code for one processor in the place of code for another
/// (tests/layers/kernel_symbols.py).
#pragma once

#include <cstddef>

namespace chaintrue::linear::kernels {

/// Column major, `stride` numbers from one column to the next.
struct Input {
  const double* data;
  std::ptrdiff_t rows, columns, stride;
  bool transposed;  ///< means its transpose; rows and columns are as stored
};

struct Output {
  double* data;
  std::ptrdiff_t rows, columns, stride;
};

struct Table {
  /// c += scale a b, at most one of them transposed
  void (*add_product)(Output c, double scale, Input a, Input b);
  /// The lower triangle of c += scale a a'
  void (*add_square)(Output c, double scale, Input a);
  /// Replaces the lower triangle by its Cholesky factor L. \returns whether every pivot was positive.
  bool (*factorise)(Output a);
  /// x = l^-1 x, l a lower triangle or its transpose
  void (*solve_triangle)(Input l, Output x);
  /// a = Q J Q' of which the lower triangle is read; Q as reflections stays in `a` and `reflections`
  /// (n - 1), J as its diagonal (n) and subdiagonal (n - 1).
  void (*tridiagonalise)(Output a, double* reflections, double* diagonal, double* subdiagonal);
  /// x = Q' x
  void (*rotate)(Input a, const double* reflections, Output x);
};

extern const Table baseline;
extern const Table avx2;  ///< with FMA; in builds for x86-64 only

/// Null if this processor lacks AVX2 or FMA, or the build has no code for them.
const Table* avx2_here();
/// The best for this processor; the baseline if CHAINTRUE_BASELINE=1 is set in the environment.
const Table& chosen();

}  // namespace chaintrue::linear::kernels
