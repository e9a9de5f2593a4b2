// SPDX-License-Identifier: MIT
#pragma once
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace delf {

/// While it lives, denormal numbers of this thread count as zero: fields decay into their vacua through them, and every
/// operation on one costs a hundred ordinary ones. Within another one of the thread it does nothing, and asks the
/// processor nothing: who takes many steps may hold one for all of them.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() {
    if (held_++ > 0) return;
    before_ = _mm_getcsr();
    _mm_setcsr(before_ | 0x8040u);  // of results and of operands
  }
  ~FlushDenormals() {
    if (--held_ == 0) _mm_setcsr(before_);
  }

 private:
  static inline thread_local unsigned held_ = 0, before_ = 0;
#else
  FlushDenormals() {}
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace delf
