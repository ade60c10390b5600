// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/check_document.hpp"

#include <fmt/format.h>

namespace chaintrue::cli {
namespace {

/// `what` is the table's heading.
Table table_of(std::string what, bool has_sign) {
  return {.columns = {{.heading = std::move(what), .width = 30},
                      {.heading = "mm", .is_number = true, .has_sign = has_sign, .width = 10},
                      {.heading = "sigma", .is_number = true, .width = 10}},
          .is_headed = true};
}

Document document_of(const grid::Check& check, Table table) {
  Document document;
  document.title = "Check";
  document.verdict = {check.sentence};
  document.remarks = {"What the readings do not show", {Paragraph{check.not_separable}}};
  document.sections = {
      {"How sure",
       {Paragraph{fmt::format(
           "Still valid {:.1f} %, valid after re-zeroing {:.1f} %, no longer valid {:.1f} %.",
           100.0 * check.probability[0],
           100.0 * check.probability[1],
           100.0 * check.probability[2])}},
       false,
       Detail::always,
       /*is_titled=*/false},
      {"What was measured", {std::move(table)}}};
  return document;
}

}  // namespace

Document map_check_document(const grid::Check& check) {
  Table table = table_of("Measured less map", true);
  for (const grid::CheckResidual& one : check.residuals)
    table.rows.push_back({{one.name, one.residual_mm, one.sigma_mm}});
  Document document = document_of(check, std::move(table));
  for (const std::string& note : check.notes) document.remarks.blocks.emplace_back(Paragraph{note});
  return document;
}

Document anchors_check_document(const grid::Check& check) {
  Table table = table_of("Error of one belt", false);
  for (const grid::CheckUnit& place : check.units) {
    table.rows.push_back(
        {{place.name, place.rms_mm(check.residuals), place.sigma_mm(check.residuals)}});
  }
  return document_of(check, std::move(table));
}

}  // namespace chaintrue::cli
