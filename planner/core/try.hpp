// Passing errors on in one word, for code that makes many calls that can fail.
#pragma once

#include <utility>

#include "sipplab/error.hpp"

namespace sipplab {
template <class Error>
Unexpected<Error> pass_on(const Error& error) {
  return {error};
}
}  // namespace sipplab

#define SIPPLAB_PASTE_(a, b) a##b
#define SIPPLAB_PASTE(a, b) SIPPLAB_PASTE_(a, b)
#define SIPPLAB_TRY_AS(tried, failed, ...)                \
  __extension__({                                         \
    auto tried = (__VA_ARGS__);                           \
    if (!tried.has_value()) return failed(tried.error()); \
    std::move(tried).value();                             \
  })

/// The value of an Expected. If it holds an error, the enclosing function returns that error.
#define SIPPLAB_TRY(...) SIPPLAB_TRY_AS(SIPPLAB_PASTE(tried_, __COUNTER__), ::sipplab::pass_on, __VA_ARGS__)
/// The same, but the enclosing function returns `failed(error)`.
#define SIPPLAB_TRY_OR(failed, ...) SIPPLAB_TRY_AS(SIPPLAB_PASTE(tried_, __COUNTER__), failed, __VA_ARGS__)
