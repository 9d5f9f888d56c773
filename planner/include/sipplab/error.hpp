// How failures are told: a value or the reason why there is none, bad input as one line, broken invariants.
#pragma once

#include <string>
#include <utility>
#include <variant>

// PLANNER_ASSERT(condition): an invariant of ours, never a check of input. Alive
// in debug, property and fuzz builds (SIPPLAB_ASSERTIONS), free elsewhere.
#ifdef SIPPLAB_ASSERTIONS
#include <cstdio>
#include <cstdlib>
#define PLANNER_ASSERT(condition)                                                            \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::fprintf(stderr, "%s:%d: broken invariant: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                          \
    }                                                                                        \
  } while (false)
#else
#define PLANNER_ASSERT(condition) static_cast<void>(0)
#endif

namespace sipplab {

/// Wraps an error so that Expected<T, E> can be built from it even when T and E
/// convert into each other.
template <class E>
struct Unexpected {
  E error;
};
template <class E>
Unexpected(E) -> Unexpected<E>;

/// Either a T or an E. Reading the one that is not there breaks an invariant.
template <class T, class E>
class [[nodiscard]] Expected {
 public:
  Expected(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Expected(Unexpected<E> unexpected) : state_(std::in_place_index<1>, std::move(unexpected.error)) {}

  bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  T& value() & {
    PLANNER_ASSERT(has_value());
    return *std::get_if<0>(&state_);
  }
  const T& value() const& {
    PLANNER_ASSERT(has_value());
    return *std::get_if<0>(&state_);
  }
  T&& value() && {
    PLANNER_ASSERT(has_value());
    return std::move(*std::get_if<0>(&state_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const E& error() const {
    PLANNER_ASSERT(!has_value());
    return *std::get_if<1>(&state_);
  }

 private:
  std::variant<T, E> state_;
};

struct InputError {
  std::string file;
  int line = 0;  ///< counted from 1; 0 if no line can be named
  std::string what;
  std::string expected;

  /// "file:line: what, expected what", without line break.
  std::string message() const;
};

template <class T>
using Input = Expected<T, InputError>;

}  // namespace sipplab
