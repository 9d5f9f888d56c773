// The memory of a program and of all that it started.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace sipplab::bench {

/// Bytes that `program`, the processes of its group and the descendants of all of them hold in memory now.
/// Address space that nobody has touched does not count. Up to `limit_bytes` it may be too much, since pages
/// that several processes share count for each; beyond, such a page counts once.
std::uint64_t resident_bytes(pid_t program, std::uint64_t limit_bytes);

}  // namespace sipplab::bench
