// Loops over needles, shared among threads.
#pragma once

#include <omp.h>

#include <cstddef>

#include "kernels/default_arithmetic.h"

namespace needlework::kernels {

/// Calls work(begin, end) on each of `threads` threads with a share of the numbers from 0 to n - 1;
/// on one alone if these are few, and on fewer if OpenMP gives fewer. `work` must not throw.
template <class Work>
void in_parallel(std::size_t n, int threads, const Work& work) {
  // Fewer numbers take less time than it takes to ask another thread.
  constexpr std::size_t least_share = 1024;
  // All or one: GCC's OpenMP ends the threads that a smaller team does not need.
  const bool shared = threads > 1 && n / least_share >= static_cast<std::size_t>(threads);
#pragma omp parallel num_threads(threads) if (shared)
  {
    // OpenMP's threads may have been made by a host program, with its choice of arithmetic.
    const DefaultArithmetic arithmetic;
    const auto share = static_cast<std::size_t>(omp_get_thread_num());
    const auto shares = static_cast<std::size_t>(omp_get_num_threads());
    work(n * share / shares, n * (share + 1) / shares);
  }
}

}  // namespace needlework::kernels
