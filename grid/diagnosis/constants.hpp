// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every constant that a verdict depends on: what it means, and where it comes from. Probabilities and
/// shares are plain numbers, strengths are in units of noise. docs/diagnosis_rates.md shows the effect of
/// halving and doubling each on the sealed rates; a probability was varied by its odds.
#pragma once

#include <array>
#include <cstddef>

namespace chaintrue::grid::diagnosis {

// Priors of causes and their strengths

/// Prior sigma of a cause's strength. Reason: usual sizes of the catalogue at 28 points with 0.2
/// and 0.3 mm noise: 6 to 22.
inline constexpr double kUsualSignalToNoise = 12.0;
/// The same for a worn or wrongly stated machine. Reason: a chain 1 % long, a chain zero off by
/// links.
inline constexpr double kWideSignalToNoise = 60.0;
/// Probability of the wide prior. Reason: one machine in seven.
inline constexpr double kWideSignalToNoisePrior = 0.15;
/// Prior probability of no cause. Reason: even odds: whoever runs a diagnosis suspects something.
inline constexpr double kPriorOfNothing = 0.50;
/// Prior probability of one cause. Reason: half of the remainder.
inline constexpr double kPriorOfOne = 0.25;
/// Prior probability of two causes. Reason: a fifth of one: Occam's razor.
inline constexpr double kPriorOfTwo = 0.05;
/// Prior probability of three causes. Reason: as above.
inline constexpr double kPriorOfThree = 0.02;
/// Prior probability of four causes. Reason: as above.
inline constexpr double kPriorOfFour = 0.01;
/// Prior probability of an unlisted smooth pattern. Reason: both real scans have one; one in five
/// still lets single causes be named.
inline constexpr double kDiscrepancyPrior = 0.20;
/// Factor on the odds of a cause given such a pattern. Reason: a machine with one fault is more
/// likely to have another; calibrates the probabilities of the sealed mixes with patterns.
inline constexpr double kCauseOddsGivenDiscrepancy = 4.0;
/// Scale of the half-Cauchy prior of its strength. Source: A. Gelman, Bayesian Analysis 1 (2006),
/// 515, section 4.3.
inline constexpr double kDiscrepancyScale = 10.0;
/// Prior probability that unnumbered marks were visited line by line. Reason: even odds: most
/// people drive along lines, but many record a different order.
inline constexpr double kOrderPrior = 0.50;
/// Odds of a slip at a visit, shared by the effects. Reason: one reading in a thousand for each
/// kind.
inline constexpr double kSlipOddsOfVisit = 0.5 / 34.0;

// Noise and outliers

/// Prior probability that noise is larger than stated. Reason: one person in sixteen
/// overestimates the tape's accuracy.
inline constexpr double kLargerNoisePrior = 0.06;
/// Prior probability that a unit is an outlier. Reason: one slip of the pen per hundred readings.
inline constexpr double kOutlierPrior = 0.01;
/// Spread of an outlier, sigmas. Reason: 10 mm at a noise of 0.25: one line of the tape, one and
/// a half links.
inline constexpr double kOutlierSpread = 40.0;
/// Largest share of rejected readings. Reason: beyond it the remaining readings cannot define the
/// fit (Huber and Ronchetti, section 1.4).
inline constexpr double kMostOutlierShare = 0.12;

// Thresholds of the verdict

/// Probability from which an order of visits is reported. Reason: nineteen to one.
inline constexpr double kOrderFound = 0.95;
/// Probability of naming a cause if there is none. Reason: one session in a hundred.
inline constexpr double kFalseAlarm = 0.01;
/// Probability of any cause from which causes are reported. Reason: keeps false names in empty
/// sets below 1 %.
inline constexpr double kCaused = 0.65;
/// Probability of one cause from which it is named alone. Reason: the level of the sealed rates.
inline constexpr double kNamedAlone = 0.95;
/// Probability in the table from which a cause is always among those named. Reason: a reader
/// regards it as certain.
inline constexpr double kSure = 0.99;
/// Probability that a set contains the cause. Reason: the level of the sealed rates.
inline constexpr double kSetHolds = 0.98;
/// Probability from which a partner is named with others. Reason: more likely than not.
inline constexpr double kLikelierThanNot = 0.50;
/// Collinearity from which two effects form one class. Reason: distinguishing them needs a
/// strength of 104.
inline constexpr double kOneClass = 0.9995;
/// Strength that an effect must be able to reach to be included. Reason: no design can name a
/// cause below it.
inline constexpr double kLeastReach = 4.0;

// With an unlisted pattern

/// Probability of a cause from which it is named given a pattern. Reason: keeps wrong names in
/// sealed mixes with patterns below 3 %.
inline constexpr double kNamedGivenDiscrepancy = 0.60;
/// Probability from which a pattern is reported. Reason: more likely than not.
inline constexpr double kDiscrepancyLikely = 0.50;
/// Prior probability that a pattern is a law of one variable, shared by all laws. Reason: a
/// quarter of a smooth pattern's: most unlisted errors have no such form.
inline constexpr double kLawPrior = 0.05;
/// Probability of all laws from which they are reported. Reason: more likely than not.
inline constexpr double kLawLikely = 0.50;
/// Probability from which one law is claimed and can be written. Reason: keeps false claims of
/// laws below 2 %.
inline constexpr double kLawClaimed = 0.90;

// How far is searched. They save time, and no verdict may depend on them. Weights are logarithms:
// e^-12 is a hundred-thousandth

/// Models this far below the best are dropped. Reason: a thousand of them weigh a ten-thousandth.
inline constexpr double kNegligibleModel = 16.0;
/// Pairs this far below the best are not compared within their bounds. Reason: a
/// hundred-thousandth each.
inline constexpr double kPairsWithin = 12.0;
/// Sets this far below the best are not extended. Reason: a hundred-thousandth each.
inline constexpr double kGrowWithin = 12.0;
/// Pairs compared within their bounds. Reason: a hundred or more regressors form over ten
/// thousand.
inline constexpr std::size_t kMostPairs = 3000;
/// Causes with whole links searched in pairs. Reason: the best of several hundred.
inline constexpr std::size_t kKeptFixed = 60;
/// Visits at which a shift of any size is searched in sets. Reason: of two shifts a visit, the
/// ones that explain most by themselves.
inline constexpr std::size_t kKeptShifts = 48;
/// Pairs and triples to extend. Reason: a beam: the causes of the catalogue, once each.
inline constexpr std::size_t kBeam = 24;
/// Extensions of each. Reason: as above.
inline constexpr std::size_t kChildren = 24;
/// Discrepancies this far below the best are not searched. Reason: a thousand of them weigh a
/// tenth.
inline constexpr double kDiscrepanciesWithin = 9.0;
/// Discrepancies searched. Reason: neighbours in length, direction and strength of the best.
inline constexpr std::size_t kMostDiscrepanciesSearched = 60;
/// Kernels tried again with different rejected points. Reason: neighbours in length and direction
/// of the best.
inline constexpr std::size_t kBestKernels = 24;
/// Regressors tried alone given a discrepancy. Reason: the causes of the catalogue, once each.
inline constexpr std::size_t kSinglesGivenDiscrepancy = 24;
/// Sets of each size tried from the search without a discrepancy. Reason: those with most of the
/// weight.
inline constexpr std::size_t kSetsGivenDiscrepancy = 6;
/// Sets extended given a discrepancy. Reason: a beam, over every discrepancy searched.
inline constexpr std::size_t kBeamGivenDiscrepancy = 4;
/// Outlier sets this far below the best are not compared. Reason: a hundred-thousandth.
inline constexpr double kNegligibleOutliers = 12.0;
/// Outlier sets returned by one search. Reason: two clumps, with and without a doubtful one.
inline constexpr std::size_t kMostFoundSets = 4;
/// Outlier sets in one comparison. Reason: those of no cause and of the leading causes.
inline constexpr std::size_t kMostOutlierSets = 8;
/// Outlier sets this far below the best are not tried given discrepancies. Reason: a
/// four-hundredth.
inline constexpr double kWorthDiscrepancies = 6.0;
/// Squared distance, in sigmas, within which whole links must explain an outlier to be tried
/// instead. Reason: two rows: 1 in 270 000.
inline constexpr double kLinksAlike = 25.0;

/// Multiples of the stated noise, equally likely: hurried or careless measuring.
inline constexpr std::array kLargerNoise = {1.5, 2.0, 2.7};
/// Strengths at which a discrepancy is tried: a quarter of a decade apart where it is hard to see.
inline constexpr std::array kDiscrepancyStrengths = {4.0, 6.5, 10.0, 16.0, 25.0, 60.0};

/// Below this residual share after projection on the settings, a signature is invisible.
inline constexpr double kAbsorbed = 1e-3;

}  // namespace chaintrue::grid::diagnosis
