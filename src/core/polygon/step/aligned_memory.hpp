#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>
#include <new>

namespace clog {

/// Zeroed numbers that begin on a cache line. @throws std::bad_alloc
inline hwy::AlignedFreeUniquePtr<double[]> aligned_zeros(std::size_t size) {
  auto memory = hwy::AllocateAligned<double>(size);
  if (!memory) throw std::bad_alloc();
  std::fill_n(memory.get(), size, 0.0);
  return memory;
}

}  // namespace clog
