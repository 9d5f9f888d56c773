// The paper's cells against made-up ones: what counts as reproduced, and which claims hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bench/present/paper_report.hpp"

namespace sipplab::bench {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

MeasuredCell figure_cell(std::int64_t robots, double ssi_s, std::int64_t solved) {
  return {"empty", robots, ssi_s, "none", "shortest", 100, solved, 0.01, 40, 1000, 1, 10};
}

MeasuredCell table_cell(const PaperRow& paper) {
  return {"warehouse",
          paper.robots,
          5,
          paper.reschedule,
          "shortest",
          100,
          std::int64_t(paper.success * 100 + 0.5),
          paper.seconds.value_or(300),
          paper.makespan_s,
          paper.flowtime_s,
          0.1,
          0.1};
}

/// What the paper's authors saw, as far as the paper says it.
std::vector<MeasuredCell> the_papers_cells() {
  std::vector<MeasuredCell> cells;
  for (const PaperRow& paper : paper_table()) cells.push_back(table_cell(paper));
  for (const std::int64_t robots : {64, 192}) {
    const bool many = robots > 64;
    cells.push_back(figure_cell(robots, 0, many ? 0 : 90));
    for (const double ssi_s : {3.0, 5.0}) cells.push_back(figure_cell(robots, ssi_s, many ? 85 : 99));
    cells.push_back(figure_cell(robots, kInfinite, many ? 30 : 95));
  }
  MeasuredCell longest = cells[4];  // random, 128 robots
  longest.order = "longest";
  longest.mean_makespan_s = 55;
  cells.push_back(longest);
  return cells;
}

const Claim& claim(const std::vector<Claim>& claims, const std::string& id) {
  return *std::find_if(claims.begin(), claims.end(), [&](const Claim& each) { return each.id == id; });
}

TEST(Reproduction, ThePapersOwnFiguresAreReproducedAndItsClaimsHold) {
  const auto cells = the_papers_cells();
  for (const TableLine& line : compare_with_table(cells)) {
    EXPECT_EQ(line.success, Standing::kReproduced) << line.paper.robots << line.paper.reschedule;
    EXPECT_EQ(line.flowtime, line.paper.flowtime_s ? Standing::kReproduced : Standing::kNotMeasured);
  }
  const auto claims = check_claims(cells);
  EXPECT_EQ(claims.size(), 10u);
  for (const Claim& each : claims) {
    ASSERT_TRUE(each.holds) << each.id;
    EXPECT_TRUE(*each.holds) << each.id << ": " << each.figures;
  }
  EXPECT_TRUE(is_reproduced(cells));
}

TEST(Reproduction, WhatIsOutsideOfShareAndIntervalIsBetterOrDiffers) {
  auto cells = the_papers_cells();
  const auto line_of = [&cells] { return compare_with_table(cells)[11]; };  // deterministic, 128 robots
  ASSERT_EQ(line_of().paper.robots, 128);
  MeasuredCell& cell = cells[11];
  cell.mean_flowtime_s = 3322.52 * 1.011;
  EXPECT_EQ(line_of().flowtime, Standing::kDiffers);
  EXPECT_FALSE(is_reproduced(cells));
  cell.flowtime_error_s = 50;
  EXPECT_EQ(line_of().flowtime, Standing::kReproduced);
  cell.mean_makespan_s = 66.15 * 0.96;
  EXPECT_EQ(line_of().makespan, Standing::kBetter);
  cell.solved = 95;
  EXPECT_EQ(line_of().success, Standing::kDiffers);
}

TEST(Reproduction, ACostOfTooFewInstancesIsNotJudged) {
  auto cells = the_papers_cells();
  cells[11].mean_flowtime_s = 5 * 3322.52;
  cells[11].flowtime_error_s = kInfinite;
  EXPECT_EQ(compare_with_table(cells)[11].flowtime, Standing::kNotMeasured);
}

TEST(Reproduction, MakespansAreComparedWhereBothSolveMost) {
  auto cells = the_papers_cells();
  const auto claim = [&cells] { return check_claims(cells).back(); };
  ASSERT_EQ(claim().id, "tab1-f");
  EXPECT_TRUE(claim().holds);
  for (MeasuredCell& cell : cells) cell.solved = cell.order == "longest" ? cell.runs / 2 : cell.solved;
  EXPECT_FALSE(claim().holds) << "of half the instances, the easier ones";
}

TEST(Reproduction, NoClaimIsJudgedByAFewInstances) {
  auto cells = the_papers_cells();
  for (MeasuredCell& cell : cells) cell.instances = kFewestInstances;
  const auto judged = [&cells] {
    const std::vector<Claim> claims = check_claims(cells);
    return std::count_if(claims.begin(), claims.end(),
                         [](const Claim& claim) { return claim.holds.has_value(); });
  };
  EXPECT_GT(judged(), 5);
  for (MeasuredCell& cell : cells) cell.instances = kFewestInstances - 1;
  EXPECT_EQ(judged(), 0);
}

TEST(Reproduction, SeedsOfOneInstanceDoNotNarrowTheIntervalOfSuccess) {
  MeasuredCell cell = figure_cell(192, 3, 60);
  const db::statistics::ConfidenceInterval of_runs = cell.success_interval();
  cell.independent_runs = 10;
  const db::statistics::ConfidenceInterval of_instances = cell.success_interval();
  EXPECT_NEAR(of_runs.low, 0.502, 0.001);       // Wilson, 60 of 100
  EXPECT_NEAR(of_instances.low, 0.313, 0.001);  // 6 of 10
  EXPECT_NEAR(of_instances.high, 0.832, 0.001);
}

TEST(Reproduction, ChartsHoldEveryMeasuredCell) {
  const auto cells = the_papers_cells();
  const Chart figure = figure_chart(cells, "run 1a2b3c4d");
  EXPECT_EQ(figure.caption, "run 1a2b3c4d; n = 100 results a point, bars: 95 % (Wilson)");
  ASSERT_EQ(figure.lines.size(), 4u);  // start-safe intervals
  ASSERT_EQ(figure.lines[0].points.size(), 2u);
  EXPECT_EQ(figure.lines[0].points[0].x, 64);
  EXPECT_EQ(figure.lines[0].points[0].y, 0.9);
  ASSERT_TRUE(figure.lines[0].points[0].interval);
  EXPECT_LT(figure.lines[0].points[0].interval->first, 0.9);
  EXPECT_GT(figure.lines[0].points[0].interval->second, 0.9);
  const Chart table = table_chart(cells, "run 1a2b3c4d");
  EXPECT_EQ(table.caption, "run 1a2b3c4d; n = 100 results a point; dashed: the paper's, of another machine");
  ASSERT_EQ(table.lines.size(), 5u);  // three methods, two of them beside the paper's
  EXPECT_EQ(table.lines[0].label, "deterministic, shortest");
  EXPECT_EQ(table.lines[0].points.size(), 7u);
  EXPECT_EQ(table.lines[1].label, "deterministic, shortest, paper");
  EXPECT_TRUE(table.lines[1].dashed);
  EXPECT_EQ(table.lines[1].colour, table.lines[0].colour);
  EXPECT_EQ(table.lines[1].points[4].x, 128);
  EXPECT_EQ(table.lines[1].points[4].y, 1.40);
  EXPECT_NE(table.lines[2].colour, table.lines[0].colour);
}

TEST(Reproduction, EachClaimCanFail) {
  const auto fails = [](const char* id, auto change) {
    auto cells = the_papers_cells();
    for (MeasuredCell& cell : cells) change(cell);
    const auto claims = check_claims(cells);
    EXPECT_EQ(claim(claims, id).holds, std::optional(false)) << id << ": " << claim(claims, id).figures;
  };
  const auto is_figure = [](const MeasuredCell& cell, double ssi_s) {
    return cell.environment == "empty" && cell.robots == 192 && cell.ssi_s == ssi_s;
  };
  const auto is_table = [](const MeasuredCell& cell, const char* reschedule, std::int64_t robots) {
    return cell.environment == "warehouse" && cell.reschedule == reschedule && cell.robots == robots;
  };
  fails("fig1-a", [&](MeasuredCell& cell) {
    if (is_figure(cell, 3)) cell.solved = 80;
  });
  fails("fig1-b", [&](MeasuredCell& cell) {
    if (is_figure(cell, 0)) cell.solved = 1;
  });
  fails("fig1-c", [&](MeasuredCell& cell) {
    if (is_figure(cell, 0)) cell.solved = 85;
  });
  fails("fig1-d", [&](MeasuredCell& cell) {
    if (is_figure(cell, kInfinite)) cell.solved = 99;
  });
  fails("tab1-a", [&](MeasuredCell& cell) {
    if (is_table(cell, "deterministic", 192)) cell.solved = 50;
  });
  fails("tab1-b", [&](MeasuredCell& cell) {
    if (is_table(cell, "random", 160)) cell.solved = 50;
  });
  fails("tab1-c", [&](MeasuredCell& cell) {
    if (is_table(cell, "deterministic", 128)) cell.mean_seconds = 6;
  });
  fails("tab1-d", [&](MeasuredCell& cell) {
    if (is_table(cell, "deterministic", 128)) cell.mean_flowtime_s = 3600;
  });
  fails("tab1-e", [&](MeasuredCell& cell) {
    if (is_table(cell, "deterministic", 128)) cell.mean_makespan_s = 62;
  });
  fails("tab1-f", [&](MeasuredCell& cell) {
    if (cell.order == "longest") cell.mean_makespan_s = 70;
  });
}

TEST(Reproduction, WhatWasNotMeasuredIsSaidSo) {
  const std::vector<MeasuredCell> cells = {figure_cell(192, 3, 90)};
  for (const Claim& each : check_claims(cells))
    EXPECT_EQ(each.holds.has_value(), each.id == "fig1-a") << each.id;
  EXPECT_EQ(compare_with_table(cells).front().success, Standing::kNotMeasured);
  EXPECT_TRUE(is_reproduced(cells));
  EXPECT_NE(reproduction_text(cells).find("not measured"), std::string::npos);
  const std::string page =
      *reproduction_page(cells, "a <run>", {figure_chart(cells, ""), table_chart(cells, "")});
  EXPECT_NE(page.find("a &lt;run&gt;"), std::string::npos);
  EXPECT_NE(page.find("<td class=\"good\">holds</td>"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace sipplab::bench
