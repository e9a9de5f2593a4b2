// SPDX-License-Identifier: MIT
#pragma once
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace delf {

/// While it lives, denormal numbers of this thread count as zero: fields decay into their vacua through them, and every
/// operation on one costs a hundred ordinary ones. Nothing is set, and nothing to wait for, where they do already: who
/// takes many steps may hold one for all of them.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : before_(_mm_getcsr()) {
    if (!are_flushed()) _mm_setcsr(before_ | both);
  }
  ~FlushDenormals() {
    if (!are_flushed()) _mm_setcsr(before_);
  }

 private:
  static constexpr unsigned both = 0x8040u;  // of results and of operands
  bool are_flushed() const { return (before_ & both) == both; }
  unsigned before_;
#else
  FlushDenormals() {}
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace delf
