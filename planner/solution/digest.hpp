// Digests of contents: the same numbers give the same 128-bit digest on every
// machine, whatever its byte order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sipplab/grid_map.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// Collects values as little-endian bytes and hashes them all (XXH3, 128 bits).
class Digest {
 public:
  /// `domain` keeps the digests of different kinds of content apart; its number
  /// changes when the encoding does.
  explicit Digest(std::string_view domain) { add(domain); }

  void add(std::uint64_t value);
  /// The exact bits, except that -0 counts as 0: equal numbers, equal digests.
  void add(double value);
  void add(Cell cell);
  /// Length first, so that no two sequences of texts give the same bytes.
  void add(std::string_view text);
  void add(const Trajectory& trajectory);

  /// 32 hexadecimal digits.
  std::string hex() const;

 private:
  std::string bytes_;
};

}  // namespace sipplab
