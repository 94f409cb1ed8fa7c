#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <exception>
#include <mutex>

namespace parhelion {

/// Calls body(i) for every i in [0, count), on all cores, in any order.
///
/// Deterministic as long as body(i) writes only what belongs to i; also in failure: every range is attempted, then
/// the exception of the lowest failing index is thrown again.
/// @param grain  indices handed to a thread at a time, at least 1; raise it when body is tiny.
template <typename Body>
void parallelFor(std::size_t count, const Body& body, std::size_t grain = 1) {
    std::mutex mutex;
    std::size_t failedIndex = count;
    std::exception_ptr failure;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          std::size_t i = range.begin();
                          try {
                              for (; i != range.end(); ++i) body(i);
                          } catch (...) {
                              const std::lock_guard lock(mutex);
                              if (i >= failedIndex) return;
                              failedIndex = i;
                              failure = std::current_exception();
                          }
                      });
    if (failure) std::rethrow_exception(failure);
}

}  // namespace parhelion
