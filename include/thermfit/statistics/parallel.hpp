#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace thermfit {

/// Calls work(i) for i = 0 … count-1 on `threads` threads (0: all cores). What each call writes must be its own place
/// in a container made beforehand, so that the result does not depend on the order. The first exception is thrown on.
template <class Work>
void in_parallel(std::size_t count, unsigned threads, const Work& work) {
  const std::size_t wanted = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex lock;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (...) {
        const std::lock_guard<std::mutex> guard(lock);
        if (!failure) failure = std::current_exception();
        next = count;
      }
  };
  std::vector<std::thread> pool;
  for (std::size_t k = 1; k < std::min(wanted, count); ++k) pool.emplace_back(run);
  run();
  for (std::thread& one : pool) one.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace thermfit
