#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "report/table.hpp"

namespace eg {
namespace {

Table sample() {
  Table table(
      {{.key = "name"}, {.key = "dt", .title = "Δt", .unit = "s"}, {.key = "count"}, {.key = "ratio", .digits = 3}});
  table.add({"Rayleigh", 3.14159e-7, std::int64_t{12}, 0.25});
  table.add({"√(m/K)", NAN, std::int64_t{12345}, std::monostate{}});
  return table;
}

TEST(Table, TextIsAligned) {
  EXPECT_EQ(sample().text(),
            "name         Δt [s]  count  ratio\n"
            "────────  ─────────  ─────  ─────\n"
            "Rayleigh  3.142e-07     12   0.25\n"
            "√(m/K)            —  12345      —\n");
}

TEST(Table, JsonKeepsKeysAndAllDigits) {
  const auto json = sample().json();
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["name"], "Rayleigh");
  EXPECT_EQ(json[0]["dt"].get<double>(), 3.14159e-7);
  EXPECT_EQ(json[0]["count"], 12);
  EXPECT_TRUE(json[1]["dt"].is_null());
  EXPECT_TRUE(json[1]["ratio"].is_null());
  EXPECT_TRUE(json[1].contains("ratio"));
}

TEST(Table, NotFiniteIsNullInJsonButInfinityIsReadable) {
  Table table({{.key = "x"}});
  table.add({std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(table.json()[0]["x"].is_null());
  EXPECT_NE(table.text().find("inf"), std::string::npos);
}

TEST(Table, EmptyHasHeaderAndEmptyList) {
  const Table table({{.key = "a"}, {.key = "b"}});
  EXPECT_EQ(table.text(), "a  b\n─  ─\n");
  EXPECT_EQ(table.json().dump(), "[]");
}

TEST(Table, PlacesCountCodePoints) { EXPECT_EQ(text_places("Δt ≤ √2"), 7u); }

}  // namespace
}  // namespace eg
