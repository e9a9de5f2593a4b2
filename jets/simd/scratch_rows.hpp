// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>

#include "jets/simd/pack.hpp"
#include "lattice/index.hpp"

namespace delf {

/// Rows of numbers aligned to packs, for the life of a function call. Calls may nest: a thread has a stack of memory that
/// they take it from, and what does not fit there comes from the heap.
class ScratchRows {
 public:
  ScratchRows(int rows, int count) : count_(count), before_(stack().used) {
    const std::size_t numbers = at(rows) * at(count);
    const std::size_t pointers = (at(rows) + lanes - 1) / lanes * lanes;
    Stack& own = stack();
    if (!own.memory) own.memory = std::make_unique<Pack[]>(Stack::size / lanes);
    if (own.used + numbers + pointers <= Stack::size) {
      begin_ = reinterpret_cast<double*>(own.memory.get()) + own.used;
      own.used += numbers + pointers;
    } else {
      heap_ = std::make_unique<Pack[]>((numbers + pointers) / lanes);
      begin_ = reinterpret_cast<double*>(heap_.get());
    }
    rows_ = reinterpret_cast<double**>(begin_ + numbers);
    for (int r = 0; r < rows; ++r) rows_[r] = (*this)[r];
  }
  ~ScratchRows() { stack().used = before_; }
  ScratchRows(const ScratchRows&) = delete;
  ScratchRows& operator=(const ScratchRows&) = delete;

  double* operator[](int r) const { return begin_ + static_cast<std::ptrdiff_t>(r) * count_; }
  double* const* data() const { return rows_; }

 private:
  struct Stack {
    static constexpr std::size_t size = 1 << 16;  ///< half a megabyte
    std::size_t used = 0;
    std::unique_ptr<Pack[]> memory;
  };
  static Stack& stack() {
    thread_local Stack own;
    return own;
  }

  int count_;
  std::size_t before_;
  std::unique_ptr<Pack[]> heap_;
  double* begin_;
  double** rows_;
};

}  // namespace delf
