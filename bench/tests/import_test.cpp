// Reports of Google Benchmark, as its versions write them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "bench/import/google_benchmark.hpp"
#include "bench/temporary_folder.hpp"

namespace sipplab::bench {
namespace {

Expected<db::MeasurementRun, std::string> imported(const std::string& report) {
  const auto folder = TemporaryFolder::make();
  EXPECT_TRUE(folder);
  const std::string path = (folder->path() / "report.json").string();
  std::ofstream(path, std::ios::binary) << report;
  auto run = read_google_benchmark(path, {});
  if (run) return run;
  EXPECT_TRUE(run.error().starts_with(path + ":")) << run.error();
  return Unexpected{run.error().substr(path.size() + 1)};
}

constexpr const char* kContext = R"("date": "2026-01-31T12:00:00+00:00", "executable": "./sort")";

Expected<db::MeasurementRun, std::string> with_rows(const std::string& rows,
                                                    const std::string& context = kContext) {
  return imported(fmt::format(R"({{"context": {{{}}}, "benchmarks": [{}]}})", context, rows));
}

/// Rows as "name repetition iterations real_time_ns aggregate", which is what most cases are about.
std::string rows_of(const Expected<db::MeasurementRun, std::string>& run) {
  if (!run) return run.error();
  std::string text;
  for (const db::Measurement& row : run->measurements) {
    text += fmt::format("{} {} {} {} {};", row.benchmark, row.repetition, row.iterations,
                        row.real_time_ns.value_or(-1), row.aggregate);
  }
  return text;
}

TEST(Import, takes_the_dates_of_all_versions) {
  const auto started = [](const std::string& date) {
    const auto run =
        with_rows(R"({"name": "a", "iterations": 1, "real_time": 1})", R"("date": ")" + date + '"');
    return run ? run->started_utc : run.error();
  };
  EXPECT_EQ(started("2026-01-31T12:00:00+01:00"), "2026-01-31T11:00:00.000Z");
  EXPECT_EQ(started("2020-06-09T17:58:05-00:00"), "2020-06-09T17:58:05.000Z");
  EXPECT_EQ(started("2020-06-09 17:58:05"), "2020-06-09T17:58:05.000Z") << "versions 1.4 to 1.5.1";
  EXPECT_EQ(started("06/09/20 17:58:05"), "2020-06-09T17:58:05.000Z") << "the same on Windows";
  for (const char* date :
       {"2020-06-09", "06/09/20", "06/09/20 17:58:05 PM", "31/01/20 17:58:05", "2020-06-09x17:58:05",
        "2020-06-09 17:58:05 PM", "09.06.2020 17:58:05", "2020-06-09T17:58:05+24:00", ""}) {
    EXPECT_EQ(started(date), "1: no date in its context, expected one such as 2026-01-31T12:00:00+00:00")
        << date;
  }
}

TEST(Import, takes_words_that_are_no_numbers_as_missing) {
  const auto run = with_rows(
      R"({"name": "Infinity \"NaN\" \\", "iterations": 0, "real_time": Infinity, "cpu_time": -Infinity,
          "a": NaN, "b": -NaN, "c": inf, "d": -nan, "e": -nan(ind), "f": 1.#INF, "g": -1.#IND, "h": 2, "i": 1e-3})");
  ASSERT_TRUE(run) << run.error();
  const db::Measurement& row = run->measurements.at(0);
  EXPECT_EQ(row.benchmark, "Infinity \"NaN\" \\");
  EXPECT_FALSE(row.real_time_ns);
  EXPECT_FALSE(row.cpu_time_ns);
  EXPECT_EQ(row.counters, (std::vector<std::pair<std::string, double>>{{"h", 2}, {"i", 1e-3}}));
}

TEST(Import, takes_a_fit_whose_error_is_a_percentage) {
  EXPECT_EQ(
      rows_of(with_rows(R"({"name": "a/8", "iterations": 9, "real_time": 4}, {"name": "a_BigO", "big_o": "N"},
                                 {"name": "a_RMS", "rms": 12%})")),
      "a/8 0 9 4 ;");
}

TEST(Import, takes_text_that_version_1_4_did_not_escape) {
  const auto run = with_rows(R"({"name": "a", "iterations": 1, "real_time": 1})",
                             R"("date": "01/31/26 12:00:00", "executable": "C:\Work\sort.exe")");
  ASSERT_TRUE(run) << run.error();
  EXPECT_EQ(run->info.command_line, R"(C:\Work\sort.exe)");
  EXPECT_EQ(run->info.suite, "sort");
}

TEST(Import, names_the_suite_after_the_program_of_any_system) {
  const auto suite = [](const std::string& program) {
    const auto run = with_rows(R"({"name": "a", "iterations": 1, "real_time": 1})",
                               R"("date": "2026-01-31T12:00:00Z", "executable": ")" + program + '"');
    return run ? run->info.suite : run.error();
  };
  EXPECT_EQ(suite("./build/sort"), "sort");
  EXPECT_EQ(suite("sort"), "sort");
  EXPECT_EQ(suite(R"(C:\\new\\sort.exe)"), "sort");
  EXPECT_EQ(suite(""), "google-benchmark");
}

TEST(Import, leaves_out_aggregates_of_repetitions_that_are_there) {
  EXPECT_EQ(rows_of(with_rows(R"(
    {"name": "a", "run_name": "a", "run_type": "iteration", "iterations": 5, "real_time": 1, "time_unit": "us"},
    {"name": "a", "run_name": "a", "run_type": "iteration", "iterations": 6, "real_time": 3, "time_unit": "us"},
    {"name": "a_mean", "run_name": "a", "run_type": "aggregate", "aggregate_name": "mean", "iterations": 2, "real_time": 2},
    {"name": "a_BigO", "run_name": "a", "run_type": "aggregate", "aggregate_name": "BigO", "cpu_coefficient": 1}
  )")),
            "a 0 5 1000 ;a 1 6 3000 ;");
}

TEST(Import, takes_the_median_or_the_mean_where_only_aggregates_are_reported) {
  EXPECT_EQ(rows_of(with_rows(R"(
    {"name": "a_mean", "run_name": "a", "run_type": "aggregate", "aggregate_name": "mean", "iterations": 3, "real_time": 2},
    {"name": "a_median", "run_name": "a", "run_type": "aggregate", "aggregate_name": "median", "iterations": 3, "real_time": 1},
    {"name": "a_stddev", "run_name": "a", "run_type": "aggregate", "aggregate_name": "stddev", "iterations": 3, "real_time": 9},
    {"name": "b_mean", "run_name": "b", "run_type": "aggregate", "aggregate_name": "mean", "iterations": 3, "real_time": 4},
    {"name": "c", "run_name": "c", "run_type": "iteration", "iterations": 7, "real_time": 5}
  )")),
            "c 0 7 5 ;a 0 3 1 median;b 0 3 4 mean;");
}

TEST(Import, knows_the_aggregates_of_version_1_4_by_their_names) {
  constexpr const char* kRows = R"(
    {"name": "a/8", "iterations": 10, "real_time": 10}, {"name": "a/8", "iterations": 10, "real_time": 12},
    {"name": "a/8_mean", "iterations": 10, "real_time": 11}, {"name": "a/8_median", "iterations": 10, "real_time": 11},
    {"name": "a/8_stddev", "iterations": 0, "real_time": 1}, {"name": "a_BigO", "cpu_coefficient": 1, "big_o": "N"},
    {"name": "a_RMS", "rms": 0.02},
    {"name": "b_mean", "iterations": 5, "real_time": 7}, {"name": "b_median", "iterations": 5, "real_time": 6},
    {"name": "b_stddev", "iterations": 0, "real_time": 1},
    {"name": "arithmetic_mean", "iterations": 3, "real_time": 4})";
  EXPECT_EQ(rows_of(with_rows(kRows)), "a/8 0 10 10 ;a/8 1 10 12 ;arithmetic_mean 0 3 4 ;b 0 5 6 median;");
}

TEST(Import, takes_the_first_of_two_equal_keys) {
  const auto run = with_rows(
      R"({"name": "a", "iterations": 10, "real_time": 1, "cpu_time": 2, "real_time": 77, "iterations": 0.5, "x": 3})");
  EXPECT_EQ(rows_of(run), "a 0 10 1 ;");
  EXPECT_EQ(run->measurements.at(0).counters, (std::vector<std::pair<std::string, double>>{{"x", 3}}));
}

TEST(Import, keeps_label_threads_and_custom_context) {
  const auto run = with_rows(
      R"({"name": "a", "iterations": 1, "real_time": 1, "threads": 4, "label": "gcc -O3"})",
      std::string(kContext) + R"(, "commit": "abc1234", "compiler": "gcc", "nodes": 2, "caches": [])");
  ASSERT_TRUE(run) << run.error();
  EXPECT_EQ(run->measurements.at(0).label, "gcc -O3");
  EXPECT_EQ(run->measurements.at(0).threads, 4);
  EXPECT_EQ(run->info.options, "commit=abc1234 compiler=gcc nodes=2");
  ASSERT_TRUE(run->info.commit);
  EXPECT_EQ(run->info.commit->hash, "abc1234");
}

TEST(Import, blames_the_report_for_numbers_that_no_program_counts) {
  for (const char* iterations : {"1e30", "-1", "9.3e18"}) {
    const std::string row = fmt::format(R"({{"name": "a", "iterations": {}, "real_time": 1}})", iterations);
    EXPECT_TRUE(rows_of(with_rows(row)).starts_with("1: a: iterations ")) << rows_of(with_rows(row));
  }
}

TEST(Import, says_the_line_where_a_report_is_cut_off) {
  EXPECT_EQ(rows_of(imported("{\"context\": {\"a\": NaN,\n\"b\": NaN},\n\"benchmarks\": [")),
            "3: not JSON, expected what --benchmark_format=json writes");
}

}  // namespace
}  // namespace sipplab::bench
