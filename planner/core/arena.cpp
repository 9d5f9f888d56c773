#include "planner/core/arena.hpp"

#include <cstdint>
#include <mutex>
#include <new>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace sipplab {
namespace {

/// Bytes of the first chunk. Each further one of an arena is as large as all before it together, up to
/// kLargestChunk.
constexpr std::size_t kFirstChunk = std::size_t{64} << 10;
constexpr std::size_t kLargestChunk = std::size_t{8} << 20;
/// Bytes given back that are kept for later; of more, chunks larger than a huge page go back to the system.
constexpr std::size_t kMostKept = std::size_t{256} << 20;
constexpr std::size_t kSmallestPiece = 64;

#if defined(__linux__)
/// Whole pages, aligned to huge ones.
std::byte* pages(std::size_t bytes) {
  void* const place =
      mmap(nullptr, bytes + Arena::kHugePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc{};
  auto* const begin = static_cast<std::byte*>(place);
  const std::size_t skipped = -reinterpret_cast<std::uintptr_t>(begin) % Arena::kHugePage;
  if (skipped > 0) munmap(begin, skipped);
  munmap(begin + skipped + bytes, Arena::kHugePage - skipped);
  madvise(begin + skipped, bytes, MADV_HUGEPAGE);  // harmless if the system has none
  return begin + skipped;
}

void give_back_pages(std::byte* begin, std::size_t bytes) { munmap(begin, bytes); }

/// Populates the pages in one call; harmless if the system cannot.
void make_ready(std::byte* begin, std::size_t bytes) {
  constexpr int kPopulateWrite = 23;  // Linux 5.14; older C libraries do not name it
  madvise(begin, bytes, kPopulateWrite);
}
#else
std::byte* pages(std::size_t bytes) {
  return static_cast<std::byte*>(operator new (bytes, std::align_val_t{Arena::kHugePage}));
}

void give_back_pages(std::byte* begin, std::size_t) {
  operator delete (begin, std::align_val_t{Arena::kHugePage});
}

void make_ready(std::byte*, std::size_t) {}
#endif

}  // namespace

/// Chunks that no arena holds at the moment.
class ChunkStore {
 public:
  static ChunkStore& of_process() {
    static ChunkStore* const store = new ChunkStore;  // outlives every arena, whatever is destroyed first
    return *store;
  }

  Arena::Chunk take(std::size_t least_bytes) {
    Arena::Chunk fresh{nullptr, least_bytes};
    {
      const std::lock_guard lock(mutex_);
      // The smallest that is large enough, since large ones are costly.
      auto best = kept_.end();
      for (auto chunk = kept_.begin(); chunk != kept_.end(); ++chunk) {
        if (chunk->bytes >= least_bytes && (best == kept_.end() || chunk->bytes < best->bytes)) best = chunk;
      }
      if (best != kept_.end()) {
        const Arena::Chunk chunk = *best;
        kept_.erase(best);
        kept_bytes_ -= chunk.bytes;
        return chunk;
      }
      if (least_bytes <= Arena::kHugePage) fresh.begin = cut(least_bytes);
    }
    if (fresh.begin == nullptr) fresh.begin = pages(least_bytes);
    make_ready(fresh.begin, fresh.bytes);
    return fresh;
  }

  void give_back(const Arena::Chunk& chunk) {
    const std::lock_guard lock(mutex_);
    if (chunk.bytes > Arena::kHugePage && kept_bytes_ + chunk.bytes > kMostKept) {
      give_back_pages(chunk.begin, chunk.bytes);
    } else {
      keep(chunk);
    }
  }

 private:
  void keep(const Arena::Chunk& chunk) {
    kept_bytes_ += chunk.bytes;
    kept_.push_back(chunk);
  }
  /// From the last huge page, or from a new one.
  std::byte* cut(std::size_t bytes) {
    if (page_.bytes < bytes) {
      if (page_.bytes > 0) keep(page_);
      page_ = {pages(Arena::kHugePage), Arena::kHugePage};
    }
    page_.bytes -= bytes;
    return std::exchange(page_.begin, page_.begin + bytes);
  }

  std::mutex mutex_;
  std::vector<Arena::Chunk> kept_;
  std::size_t kept_bytes_ = 0;
  Arena::Chunk page_{nullptr, 0};  ///< what is left of the last huge page
};

std::size_t Arena::size_class(std::size_t bytes) {
  bytes = std::max(bytes, kSmallestPiece);
  const auto log = static_cast<std::size_t>(std::bit_width(bytes - 1));  // 2^log >= bytes
  const bool three_quarters = bytes <= (std::size_t{3} << log) / 4;
  return 2 * log - (three_quarters ? 1 : 0);
}

std::size_t Arena::size_of(std::size_t size_class) {
  const std::size_t log = (size_class + 1) / 2;
  return size_class % 2 == 0 ? std::size_t{1} << log : (std::size_t{3} << log) / 4;
}

void* Arena::take_bytes(std::size_t size_class) {
  if (FreePiece* const piece = free_[size_class]; piece != nullptr) {
    free_[size_class] = piece->next;
    return piece;
  }
  const std::size_t bytes = (size_of(size_class) + kAlignment - 1) / kAlignment * kAlignment;
  if (static_cast<std::size_t>(end_ - next_) < bytes) add_chunk(bytes);
  std::byte* const piece = next_;
  next_ += bytes;
  return piece;
}

void Arena::add_chunk(std::size_t least_bytes) {
  std::size_t bytes = kFirstChunk;
  for (const Chunk& chunk : chunks_) bytes += chunk.bytes;
  bytes = std::min(std::bit_ceil(bytes), kLargestChunk);
  const Chunk chunk = ChunkStore::of_process().take(std::max(bytes, std::bit_ceil(least_bytes)));
  chunks_.push_back(chunk);
  next_ = chunk.begin;
  end_ = chunk.begin + chunk.bytes;
}

void Arena::reset() {
  for (const Chunk& chunk : chunks_) ChunkStore::of_process().give_back(chunk);
  chunks_.clear();
  free_.fill(nullptr);
  next_ = end_ = nullptr;
}

}  // namespace sipplab
