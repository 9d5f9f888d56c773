// Digests of contents; see digest.hpp.
#include "planner/solution/digest.hpp"

#include <xxhash.h>

#include <bit>

namespace sipplab {

void Digest::add(std::uint64_t value) {
  for (int shift = 0; shift < 64; shift += 8) bytes_.push_back(static_cast<char>((value >> shift) & 0xff));
}

void Digest::add(double value) { add(std::bit_cast<std::uint64_t>(value + 0.0)); }

void Digest::add(Cell cell) {
  const auto bits = [](std::int32_t value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value));
  };
  add(bits(cell.x) << 32 | bits(cell.y));
}

void Digest::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  bytes_.append(text);
}

void Digest::add(const Trajectory& trajectory) {
  add(trajectory.start);
  add(static_cast<std::uint64_t>(trajectory.motions.size()));
  for (const TimedMotion& motion : trajectory.motions) {
    add(motion.begin_s);
    add(motion.end_s);
    add(motion.from);
    add(motion.to);
    if (motion.turn_to_deg) {  // plans without turns keep the digests from before there were any
      add(std::string_view("turn"));
      add(*motion.turn_to_deg);
    }
  }
}

std::string Digest::hex() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes_.data(), bytes_.size()));
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    text.push_back(kDigits[byte >> 4]);
    text.push_back(kDigits[byte & 15]);
  }
  return text;
}

}  // namespace sipplab
