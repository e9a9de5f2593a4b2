// SPDX-License-Identifier: MIT
#pragma once
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace delf::peers {

/// While it lives, denormal numbers of this thread count as zero, as they do in the engine's steps: FlushDenormals of
/// schemes/ written again, since peers include nothing of that room.
class FlushToZero {
 public:
#if defined(__SSE2__)
  FlushToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
  ~FlushToZero() { _mm_setcsr(before_); }

 private:
  unsigned before_;
#else
  FlushToZero() {}
#endif
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;
};

}  // namespace delf::peers
