// Work on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace sipplab {

/// Calls work(worker, index) once for each index below `count`, on up to `workers` threads at
/// once, the caller's included, and returns when all are done. Calls that run at the same time
/// differ in `worker` < `workers`. Indices are begun in ascending order. Threads are made for
/// the call and joined: some ten microseconds each.
template <class Work>
void for_each_in_parallel(std::size_t workers, std::size_t count, Work&& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&](std::size_t worker) {
    for (std::size_t index = next++; index < count; index = next++) work(worker, index);
  };
  std::vector<std::thread> others;
  for (std::size_t worker = 1; worker < std::min(workers, count); ++worker) others.emplace_back(run, worker);
  run(0);
  for (std::thread& other : others) other.join();
}

}  // namespace sipplab
