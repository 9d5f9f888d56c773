// Pieces of an arena: apart from each other, used again, and none left after a reset.
#include "planner/core/arena.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <vector>

namespace sipplab {
namespace {

TEST(Arena, PiecesLieApartAndOnCacheLines) {
  Arena arena;
  struct Piece {
    std::uint8_t* begin;
    std::size_t size;
  };
  std::vector<Piece> pieces;
  for (std::size_t size : {1U, 63U, 64U, 65U, 4096U, 96U, 100'000U, 3'000'000U, 7U, 200'000U}) {
    pieces.push_back({arena.take<std::uint8_t>(size), size});
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pieces.back().begin) % 64, 0U);
    std::fill_n(pieces.back().begin, size, static_cast<std::uint8_t>(pieces.size()));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto [begin, size] = pieces[i];
    EXPECT_TRUE(std::all_of(begin, begin + size, [i](std::uint8_t byte) { return byte == i + 1; }));
  }
}

TEST(Arena, WhatIsGivenBackIsTakenAgain) {
  Arena arena;
  auto* const first = arena.take<std::uint64_t>(100);
  auto* const second = arena.take<std::uint64_t>(100);
  EXPECT_NE(first, second);
  arena.give_back(first, 100);
  EXPECT_EQ(arena.take<std::uint64_t>(110), first);  // of the same size class
}

TEST(Arena, AResetForgetsWhatWasGivenBack) {
  Arena arena;
  std::set<std::uint64_t*> taken;
  arena.give_back(arena.take<std::uint64_t>(8), 8);
  arena.reset();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(taken.insert(arena.take<std::uint64_t>(8)).second);
}

TEST(Arena, LargeChunksBeginWhereAHugePageBegins) {
  for (int round = 0; round < 2; ++round) {  // the second time they are kept ones
    Arena arena;
    for (const std::size_t size : {3'000'000U, 5'000'000U, 9'000'000U}) {
      auto* const place = arena.take<std::uint8_t>(size);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(place) % Arena::kHugePage, 0U);
      std::fill_n(place, size, std::uint8_t{1});
    }
  }
}

TEST(Arena, SmallArenasShareHugePages) {
  constexpr std::size_t kArenas = 400;  // more than there are kept chunks of other tests
  std::array<Arena, kArenas> arenas;
  std::set<std::uintptr_t> huge_pages;
  std::set<std::uint8_t*> places;
  for (Arena& arena : arenas) {
    auto* const place = arena.take<std::uint8_t>(1);
    places.insert(place);
    huge_pages.insert(reinterpret_cast<std::uintptr_t>(place) / Arena::kHugePage);
  }
  EXPECT_EQ(places.size(), kArenas);
  EXPECT_LE(huge_pages.size(), kArenas / 2);
}

TEST(Arena, VectorsGrowAndKeepWhatTheyHold) {
  Arena arena;
  ArenaVector<int> numbers(arena);
  ArenaVector<int> others(arena);
  for (int i = 0; i < 5000; ++i) {
    numbers.push_back(i);
    others.push_back(-i);
  }
  others.resize(6000, 7);
  for (int i = 0; i < 5000; ++i) {
    EXPECT_EQ(numbers[static_cast<std::size_t>(i)], i);
    EXPECT_EQ(others[static_cast<std::size_t>(i)], -i);
  }
  EXPECT_EQ(others.back(), 7);
  EXPECT_EQ(others.size(), 6000U);
}

}  // namespace
}  // namespace sipplab
