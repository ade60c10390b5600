// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From measurements to what is wrong with the machine: the entry points of this folder.
///
/// \code
///   Measured measured(grid);          // points
///   measured.add(holes);              // and a tape's distances, of the same machine
///   const auto found = diagnose(measured);
///   if (found) fmt::print("{}\n", found->sentence);
///   else fmt::print("{}\n", found.error().sentence());
/// \endcode
///
/// The same input gives the same answer to the last bit, whatever the order of the points, the
/// distances or the holes in it.
#pragma once

#include <tl/expected.hpp>

#include "grid/belts/measured_belts.hpp"
#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/options.hpp"
#include "grid/observation/measured.hpp"
#include "grid/plotter/test_drawing.hpp"

namespace chaintrue::grid::diagnosis {

/// The order of visits is unknown for holes, and for points without numbers. Fails with a sentence
/// if there is no machine, too little was measured, or a place is out of the machine's reach.
[[nodiscard]] tl::expected<Diagnosis, DiagnosisFailure> diagnose(
    const Measured& measured, const DiagnosisOptions& options = {});

/// A router on four belts, from the lengths that it measured by itself. Gain, follow-ups and other
/// results of chains stay empty: `belts` holds those of belts. Fails with a sentence where
/// fit_belts() fails. `indices`: positions of the points in their file; the answer uses the file's
/// numbers.
[[nodiscard]] tl::expected<Diagnosis, DiagnosisFailure> diagnose(
    const MeasuredBelts& belts, const DiagnosisOptions& options = {},
    const PointIndices& indices = {});

/// A V-plotter, from what was measured on its test drawing. The order of the lines is not known.
/// Held-out errors and what to measure next stay empty: `drawing` holds the settings and the
/// measures. Fails with a sentence if fit_drawing() refuses the drawing for a slip.
[[nodiscard]] tl::expected<Diagnosis, DiagnosisFailure> diagnose(
    const TestDrawing& drawing, const DiagnosisOptions& options = {});

/// How well the model found on one grid predicts another of the same machine. Fails with a sentence
/// if either has no machine, or if the machine found cannot reach the other's points.
[[nodiscard]] tl::expected<Transfer, DiagnosisFailure> transfer(const MeasuredGrid& from,
                                                                const Diagnosis& diagnosis,
                                                                const MeasuredGrid& to);

}  // namespace chaintrue::grid::diagnosis
