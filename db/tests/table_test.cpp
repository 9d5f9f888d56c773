// The three forms of a table, to the byte.
#include "db/table.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

const Table kTable{{"name", "n", "x"},
                   {{std::string{"warehouse"}, std::int64_t{64}, 0.1 + 0.2},
                    {std::string{"a,\"b\"\nc"}, Null{}, test::kInfinity},
                    {std::string{}, std::int64_t{-5}, -test::kInfinity},
                    {std::string{"größe"}, std::int64_t{7}, 5.0}}};

TEST(Table, aligned) {
  EXPECT_EQ(format_aligned(kTable),
            "name          n                    x\n"
            "---------  ----  -------------------\n"
            "warehouse    64  0.30000000000000004\n"
            "a,\"b\"\\nc   NULL                  inf\n"
            "             -5                 -inf\n"
            "größe         7                    5\n");
}

TEST(Table, aligned_shows_control_characters_as_escapes) {
  EXPECT_EQ(format_aligned({{"t"}, {{std::string{"\x1b[31m\x7f\t"}}}}),
            "t\n--------------\n\\x1b[31m\\x7f\\t\n");
}

TEST(Table, csv) {
  EXPECT_EQ(format_csv(kTable),
            "name,n,x\r\n"
            "warehouse,64,0.30000000000000004\r\n"
            "\"a,\"\"b\"\"\nc\",,inf\r\n"
            "\"\",-5,-inf\r\n"
            "größe,7,5\r\n");
  EXPECT_EQ(format_csv({{"a,b", "n"}, {{Null{}, Blob{std::string("\0\xff", 2)}}}}), "\"a,b\",n\r\n,00ff\r\n");
}

TEST(Table, json) {
  const auto rows = nlohmann::ordered_json::parse(format_json(kTable));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].dump(), R"({"name":"warehouse","n":64,"x":0.30000000000000004})");
  EXPECT_EQ(rows[1].dump(), R"({"name":"a,\"b\"\nc","n":null,"x":"inf"})");
  EXPECT_EQ(rows[2].dump(), R"({"name":"","n":-5,"x":"-inf"})");
  EXPECT_EQ(rows[3].dump(), R"({"name":"größe","n":7,"x":5.0})");
}

TEST(Table, json_of_odd_tables) {
  EXPECT_EQ(format_json({{"a"}, {}}), "[]\n");
  const auto rows = nlohmann::ordered_json::parse(
      format_json({{"a", "a", "a"}, {{std::int64_t{1}, std::int64_t{2}, std::string{"\xff"}}}}));
  EXPECT_EQ(rows[0].dump(), "{\"a\":1,\"a:1\":2,\"a:2\":\"\xef\xbf\xbd\"}");
}

TEST(Table, names_of_formats) {
  EXPECT_EQ(parse_output_format("table"), OutputFormat::kTable);
  EXPECT_EQ(parse_output_format("csv"), OutputFormat::kCsv);
  EXPECT_EQ(parse_output_format("json"), OutputFormat::kJson);
  EXPECT_FALSE(parse_output_format("xml"));
}

}  // namespace
}  // namespace sipplab::db
