// Memory that one owner takes piece by piece and gives back all at once.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

namespace sipplab {

/// A bump allocator over chunks of pages. Chunks come from a store of the whole process, which keeps
/// their pages resident: in a fresh process a page fault costs as much as planning for some microseconds,
/// and later plans pay for none. Small chunks of all arenas are cut from the same huge pages. If the system
/// has none, new chunks are populated in one call if it can (madvise), else page by page as usual. For one
/// thread at a time; the store is for all threads.
class Arena {
 public:
  /// Bytes, on most machines; a greater chunk begins where one begins.
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;

  Arena() = default;
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;
  ~Arena() { reset(); }

  /// Room for `count` values, not initialised. Valid until it is given back or the arena is reset.
  template <class T>
  T* take(std::size_t count) {
    static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlignment);
    return static_cast<T*>(take_bytes(size_class(count * sizeof(T))));
  }

  /// For the next taker of as many bytes. REQUIRES: taken as `count` values.
  template <class T>
  void give_back(T* place, std::size_t count) {
    const std::size_t free_list = size_class(count * sizeof(T));
    const auto piece = reinterpret_cast<FreePiece*>(place);
    piece->next = free_[free_list];
    free_[free_list] = piece;
  }

  /// Takes back all memory at once.
  void reset();

 private:
  static constexpr std::size_t kAlignment = 64;
  struct FreePiece {
    FreePiece* next;
  };
  struct Chunk {
    std::byte* begin;
    std::size_t bytes;
  };
  friend class ChunkStore;

  /// Pieces have sizes of 2^n and 3 * 2^(n - 1) bytes, so that those given back fit later requests.
  static std::size_t size_class(std::size_t bytes);
  static std::size_t size_of(std::size_t size_class);
  void* take_bytes(std::size_t size_class);
  void add_chunk(std::size_t least_bytes);

  std::byte* next_ = nullptr;
  std::byte* end_ = nullptr;
  std::vector<Chunk> chunks_;
  std::array<FreePiece*, 2 * 48> free_{};  ///< by size class
};

/// The part of std::vector that plain values need, in an arena. Its values are lost when the arena is reset:
/// call abandon() first.
template <class T>
class ArenaVector {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit ArenaVector(Arena& arena) : arena_(&arena) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  T& back() { return data_[size_ - 1]; }
  const T* data() const { return data_; }

  void push_back(const T& value) {
    if (size_ == capacity_) grow(size_ + 1);
    data_[size_++] = value;
  }
  void pop_back() { --size_; }
  void clear() { size_ = 0; }
  void resize(std::size_t size, T value) {
    if (size > capacity_) grow(size);
    if (size > size_) std::fill(data_ + size_, data_ + size, value);
    size_ = size;
  }
  void assign(std::size_t size, T value) {
    clear();
    resize(size, value);
  }
  /// Empties it without giving memory back.
  void abandon() {
    data_ = nullptr;
    size_ = capacity_ = 0;
  }

 private:
  static constexpr std::size_t kFirstBytes = 256;

  void grow(std::size_t least) {
    const std::size_t capacity = std::max({least, 2 * capacity_, kFirstBytes / sizeof(T)});
    T* const data = arena_->take<T>(capacity);
    if (size_ > 0) std::memcpy(static_cast<void*>(data), data_, size_ * sizeof(T));
    if (data_ != nullptr) arena_->give_back(data_, capacity_);
    data_ = data;
    capacity_ = capacity;
  }

  Arena* arena_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace sipplab
