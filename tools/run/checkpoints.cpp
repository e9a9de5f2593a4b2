// SPDX-License-Identifier: MIT
#include "tools/run/checkpoints.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "jets/simd/pack.hpp"
#include "tools/files/checkpoint_file.hpp"
#include "tools/files/state_in_memory.hpp"
#include "tools/report/failure.hpp"

namespace delf {

std::string instruction_set() {
  std::string set = fmt::format("{} lanes", lanes);
#ifdef __FMA__
  set += ", fused multiply-add";
#endif
#if defined(__x86_64__)
  // the C library chooses its functions by these
  set += __builtin_cpu_supports("avx512f") ? ", avx512" : __builtin_cpu_supports("avx2") ? ", avx2" : ", sse";
  if (__builtin_cpu_supports("fma")) set += ", fma";
#endif
  return set;
}

Checkpoints::Checkpoints(const std::filesystem::path& folder, CheckpointHead head, double seconds)
    : path_(folder / file_name), head_(std::move(head)), due_(seconds), wanted_(seconds > 0) {}

void Checkpoints::write(std::int64_t row, const std::function<void(SavedState&)>& state) {
  if (!wanted_) return;
  head_.row = row;
  if (memory_) {
    memory_->clear();
    StateWriter writer(*memory_);
    head_.visit(writer);
    return state(writer);
  }
  try {
    CheckpointWriter writer(path_);
    head_.visit(writer);
    state(writer);
    writer.close();
  } catch (const SystemFailure& failure) {
    if (!reported_) std::fputs(fmt::format("delf: no checkpoint: {}\n", failure.what()).c_str(), stderr);
    reported_ = true;
  }
  due_.restart();
}

}  // namespace delf
