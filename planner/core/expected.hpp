// A value or the reason why there is none. std::expected is C++23; this is the
// part of it that the project uses.
#pragma once

#include <utility>
#include <variant>

#include "planner/core/assert.hpp"

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

}  // namespace sipplab
