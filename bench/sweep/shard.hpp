// Parts of a sweep for several machines.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace sipplab::bench {

/// Every `count`-th case, from case `index` on. All shards together are the sweep, each case once.
struct Shard {
  std::size_t index = 0;  ///< counted from 0
  std::size_t count = 1;

  bool holds(std::size_t position) const { return position % count == index; }
};

/// "2/8" is the second of eight. None for anything else.
std::optional<Shard> parse_shard(const std::string& text);

}  // namespace sipplab::bench
