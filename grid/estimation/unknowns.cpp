// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/unknowns.hpp"

#include "grid/containers.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::estimation {
namespace {

constexpr auto kSheet = std::ssize(model::kSheetSettings);

}  // namespace

Unknowns::Unknowns(const ObservationSet& set, SurfaceColumns surface)
    : stated_(set.mechanism), surface_(surface), of_set_(as_size(set.stated_value.size())) {
  const bool frame_is_laid = !set.parts.empty() && set.parts.front().sheet.has_value();
  settings_ = parameters() + (frame_is_laid ? kSheet : 0);
  total_ = settings_ + scales() + 2 * (surface.polynomials + surface.penalised);
  for (std::size_t i = 0; i < set.parts.size(); ++i) {
    sheet_.push_back(-1);
    if (set.parts[i].sheet) {
      sheet_.back() = i == 0 ? parameters() : total_;
      if (i > 0) total_ += kSheet;
    }
    const auto zeros = as_index(set.parts[i].zero_columns.size());
    zeros_.push_back(zeros > 0 ? total_ : -1);
    total_ += zeros;
    nuisance_.push_back(total_);
    total_ += set.parts[i].observation->nuisance_sigma().size();
  }
  sigma_ = Eigen::VectorXd::Zero(total_);
  for (std::size_t i = 0; i < set.parts.size(); ++i) {
    const ObservationPart& part = set.parts[i];
    const std::vector<Eigen::Index> own = columns_of(i);
    const std::vector<Eigen::Index> there = set.columns_of(part);
    for (std::size_t k = 0; k < own.size(); ++k) {
      of_set_[as_size(there[k])] = own[k];
      sigma_[own[k]] = set.stated_sigma[there[k]];
    }
    for (std::size_t z = 0; z < part.zero_columns.size(); ++z) {
      const Eigen::Index column = zeros_[i] + as_index(z);
      of_set_[as_size(part.zero_columns[z])] = column;
      sigma_[column] = set.stated_sigma[part.zero_columns[z]];
    }
    for (std::size_t q = 0; q < part.nuisance_columns.size(); ++q) {
      of_set_[as_size(part.nuisance_columns[q])] = nuisance_[i] + as_index(q);
    }
  }
}

std::vector<Eigen::Index> Unknowns::columns_of(std::size_t observation) const {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < parameters(); ++i) columns.push_back(i);
  for (Eigen::Index i = 0; sheet_[observation] >= 0 && i < kSheet; ++i)
    columns.push_back(sheet_[observation] + i);
  return columns;
}

std::shared_ptr<const model::Mechanism> Unknowns::mechanism_at(
    const Eigen::VectorXd& unknowns) const {
  return stated_->with_values(stated_->values() + unknowns.head(parameters()));
}

Eigen::VectorXd Unknowns::stated_deviations() const {
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(parameters());
  for (Eigen::Index i = 0; i < parameters(); ++i) {
    const auto& stated = stated_->parameters()[as_size(i)].stated;
    if (stated) deviations[i] = *stated - stated_->values()[i];
  }
  return deviations;
}

model::SheetPlacement Unknowns::sheet_at(const Eigen::VectorXd& unknowns,
                                         std::size_t observation) const {
  const Eigen::Index first = sheet_[observation];
  if (first < 0) return {};
  return {unknowns[first], unknowns[first + 1], unknowns[first + 2]};
}

}  // namespace chaintrue::grid::estimation
