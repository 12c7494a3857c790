// Loops over needles, shared among threads.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>

#include "kernels/default_arithmetic.h"

namespace needlework::kernels {

/// Calls work(begin, end) on each of `threads` threads, or on fewer if they are not to be had, with
/// a share of the numbers from 0 to n - 1. `work` must not throw.
template <class Work>
void in_parallel(std::size_t n, int threads, const Work& work) {
  // Fewer numbers take less time than it takes to ask another thread.
  constexpr std::size_t least_share = 1024;
  const std::size_t worth_it = std::max<std::size_t>(n / least_share, 1);
  const int sharing = static_cast<int>(std::min(static_cast<std::size_t>(threads), worth_it));
#pragma omp parallel num_threads(sharing) if (sharing > 1)
  {
    // OpenMP's threads may have been made by a host program, with its choice of arithmetic.
    const DefaultArithmetic arithmetic;
    const auto share = static_cast<std::size_t>(omp_get_thread_num());
    const auto shares = static_cast<std::size_t>(omp_get_num_threads());
    work(n * share / shares, n * (share + 1) / shares);
  }
}

}  // namespace needlework::kernels
