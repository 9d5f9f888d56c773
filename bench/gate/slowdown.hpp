// Faults on purpose, to measure what the gate can see. With SIPPLAB_INJECT_SLOWDOWN=0.03 in
// its environment a judged build spends 3 % of each planning time once more, doing nothing;
// with SIPPLAB_INJECT_INTO=read another task than planning (see laboratory.hpp);
// with SIPPLAB_INJECT_CHANGE=7 it plans its instance number 7 in another order. Left out of
// --help: they are for scripts/trials and tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace sipplab::bench {

inline constexpr const char* kSlowdownVariable = "SIPPLAB_INJECT_SLOWDOWN";
inline constexpr const char* kIntoVariable = "SIPPLAB_INJECT_INTO";
inline constexpr const char* kChangeVariable = "SIPPLAB_INJECT_CHANGE";

/// The share that the environment asks for, 0 if it asks for none or for nonsense.
double injected_slowdown();

/// The instance that the environment wants planned otherwise, by the order of loading.
std::optional<std::size_t> injected_change();

/// Processor time of the calling thread. Unlike the clock on the wall it stands still
/// while another process has the core.
std::int64_t thread_cpu_ns();

/// Keeps the core busy until `share` of `spent_ns` of processor time has passed.
void burn(double share, std::int64_t spent_ns);

}  // namespace sipplab::bench
