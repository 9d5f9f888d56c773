// First orders and their successors.
#include "planner/prioritized/priority_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace sipplab {
namespace {

const std::vector<double> kLengths = {3, 1, 2, 1, 3, 0};

PriorityOrder first_order(InitialOrder kind, std::uint64_t seed = 1) {
  Random random(seed);
  return initial_order(kind, kLengths, random);
}

PriorityOrder sorted(PriorityOrder order) {
  std::sort(order.begin(), order.end());
  return order;
}

TEST(InitialOrder, BreaksTiesByInputPosition) {
  EXPECT_EQ(first_order(InitialOrder::kFifo), (PriorityOrder{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(first_order(InitialOrder::kShortestFirst), (PriorityOrder{5, 1, 3, 2, 0, 4}));
  EXPECT_EQ(first_order(InitialOrder::kLongestFirst), (PriorityOrder{0, 4, 2, 1, 3, 5}));
}

TEST(InitialOrder, RandomIsAPermutationThatTheSeedDecides) {
  std::set<PriorityOrder> seen;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const PriorityOrder order = first_order(InitialOrder::kRandom, seed);
    EXPECT_EQ(sorted(order), (PriorityOrder{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(order, first_order(InitialOrder::kRandom, seed));
    seen.insert(order);
  }
  EXPECT_GT(seen.size(), 40u);
}

TEST(InitialOrder, OfNobodyIsEmpty) {
  Random random(1);
  for (const InitialOrder kind : {InitialOrder::kFifo, InitialOrder::kShortestFirst,
                                  InitialOrder::kLongestFirst, InitialOrder::kRandom}) {
    EXPECT_TRUE(initial_order(kind, {}, random).empty());
  }
}

TEST(OrderSequence, NoneHasNoNextOrder) {
  OrderSequence orders(Rescheduling::kNone, {2, 0, 1}, Random(1));
  EXPECT_FALSE(orders.advance(1));
  EXPECT_EQ(orders.current(), (PriorityOrder{2, 0, 1}));
}

TEST(OrderSequence, DeterministicMovesTheFailedRobotToTheFront) {
  OrderSequence orders(Rescheduling::kDeterministic, {0, 1, 2, 3}, Random(1));
  ASSERT_TRUE(orders.advance(2));
  EXPECT_EQ(orders.current(), (PriorityOrder{2, 0, 1, 3}));
  ASSERT_TRUE(orders.advance(3));
  EXPECT_EQ(orders.current(), (PriorityOrder{3, 2, 0, 1}));
  ASSERT_TRUE(orders.advance(2));
  EXPECT_EQ(orders.current(), (PriorityOrder{2, 3, 0, 1}));
  // 3 2 0 1 was tried.
  EXPECT_FALSE(orders.advance(3));
}

TEST(OrderSequence, DeterministicEndsWhenTheFirstRobotFails) {
  OrderSequence orders(Rescheduling::kDeterministic, {1, 0}, Random(1));
  EXPECT_FALSE(orders.advance(1));
}

TEST(OrderSequence, DeterministicEndsWhenItComesBackToTheFirstOrder) {
  OrderSequence orders(Rescheduling::kDeterministic, {0, 1}, Random(1));
  ASSERT_TRUE(orders.advance(1));
  EXPECT_FALSE(orders.advance(0));
}

/// All orders of a random sequence over n robots, in turn.
std::vector<PriorityOrder> all_random_orders(std::size_t n, std::uint64_t seed) {
  PriorityOrder first(n);
  for (std::size_t i = 0; i < n; ++i) first[i] = i;
  OrderSequence orders(Rescheduling::kRandom, first, Random(seed));
  std::vector<PriorityOrder> all{orders.current()};
  constexpr std::size_t kMoreThanThereAre = 1000;
  while (all.size() < kMoreThanThereAre && orders.advance(0)) all.push_back(orders.current());
  return all;
}

TEST(OrderSequence, RandomTriesEveryOrderOnce) {
  std::size_t factorial = 1;
  for (std::size_t n = 1; n <= 5; ++n) {
    factorial *= n;
    const std::vector<PriorityOrder> all = all_random_orders(n, 7);
    EXPECT_EQ(all.size(), factorial);
    EXPECT_EQ(std::set<PriorityOrder>(all.begin(), all.end()).size(), factorial);
    for (const PriorityOrder& order : all) EXPECT_EQ(sorted(order), sorted(all[0]));
  }
}

TEST(OrderSequence, RandomIsDecidedByTheSeed) {
  EXPECT_EQ(all_random_orders(4, 3), all_random_orders(4, 3));
  EXPECT_NE(all_random_orders(4, 3), all_random_orders(4, 4));
}

TEST(OrderSequence, RandomDoesNotFavourAnOrder) {
  // The second of three robots' six orders: each of the five left comes up a fifth of
  // the time; 1,000 draws are off by 75 with a probability below 1e-8.
  constexpr int kDraws = 1000;
  std::map<PriorityOrder, int> counts;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) ++counts[all_random_orders(3, seed)[1]];
  ASSERT_EQ(counts.size(), 5u);
  for (const auto& [order, count] : counts) EXPECT_NEAR(count, kDraws / 5, 75);
}

}  // namespace
}  // namespace sipplab
