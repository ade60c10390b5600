// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A simulated grid without noise compared with the 40-digit tables of fixtures/reference, for
/// every model of the chain.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "grid/synthetic/generator.hpp"

namespace chaintrue::grid::synthetic {
namespace {

struct Table {
  const char* file;
  model::Feed feed;
  double ring_mm;
};

struct Column {
  const char* key;
  model::Model model;
};

constexpr Table kTables[] = {{"table_over_top.json", model::Feed::over_top, 139.1},
                             {"table_off_bottom.json", model::Feed::off_bottom, 139.1},
                             {"table_over_top_rho0.json", model::Feed::over_top, 0.0}};
constexpr Table kTables3d[] = {{"table_3d_over_top.json", model::Feed::over_top, 139.1},
                               {"table_3d_off_bottom.json", model::Feed::off_bottom, 139.1}};
constexpr Column kColumns[] = {{"a_straight", model::Model::straight},
                               {"b_wrap", model::Model::wrap},
                               {"c_inextensible", model::Model::inextensible},
                               {"d_elastic", model::Model::elastic},
                               {"f_firmware", model::Model::firmware},
                               {"g_holey_oneshot", model::Model::one_shot}};

nlohmann::json load(const char* file) {
  std::ifstream in(std::string(CHAINTRUE_FIXTURES) + "/reference/" + file);
  return nlohmann::json::parse(in);
}

double number(const nlohmann::json& text) { return std::stod(text.get<std::string>()); }

// The tables' machine, from the numbers in their head.
model::Machine machine_of(const Table& table) {
  model::Machine machine;
  machine.feed = table.feed;
  machine.attachment = model::Ring{table.ring_mm};
  machine.chain.compliance_per_n = 5.1685e-6;
  return machine;
}

void compare(const Table& table, const nlohmann::json& records, const Column& column) {
  std::vector<model::Visit> visits;
  for (const auto& record : records) {
    visits.push_back(
        {{number(record.at("x")), number(record.at("y"))}, static_cast<int>(visits.size())});
  }
  const PlacesRead read = read_places(machine_of(table), {}, visits, column.model);
  EXPECT_TRUE(read.unreachable.empty());
  ASSERT_EQ(read.grid.points.size(), records.size());
  constexpr double kPromisedMm = 1e-9;
  for (std::size_t i = 0; i < records.size(); ++i) {
    EXPECT_NEAR(
        read.grid.points[i].lengths->left_mm, number(records[i].at(column.key)[0]), kPromisedMm)
        << i;
    EXPECT_NEAR(
        read.grid.points[i].lengths->right_mm, number(records[i].at(column.key)[1]), kPromisedMm)
        << i;
  }
}

TEST(Reference, GridsWithoutNoiseAgreeWithTheTables) {
  for (const Table& table : kTables) {
    const nlohmann::json json = load(table.file);
    for (const Column& column : kColumns) {
      if (!json.at("bed")[0].contains(column.key)) continue;
      SCOPED_TRACE(std::string(table.file) + " " + column.key);
      compare(table, json.at("bed"), column);
    }
  }
}

TEST(Reference, GridsOfTheThreeDimensionalSagAgreeWithTheTables) {
  for (const Table& table : kTables3d) {
    const nlohmann::json json = load(table.file);
    SCOPED_TRACE(table.file);
    compare(table, json.at("bed"), {"h_3d", model::Model::elastic_3d});
  }
}

}  // namespace
}  // namespace chaintrue::grid::synthetic
