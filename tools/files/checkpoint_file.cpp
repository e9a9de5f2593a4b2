// SPDX-License-Identifier: MIT
#include "tools/files/checkpoint_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

#include "tools/report/failure.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view magic = "delf checkpoint\n";
using Sum = boost::crc_32_type::value_type;

}  // namespace

CheckpointWriter::CheckpointWriter(const fs::path& path)
    : path_(path), part_(path.string() + ".part"), file_(std::fopen(part_.c_str(), "wb"), std::fclose) {
  if (!file_) fail();
  std::string head(magic);
  transfer(head.data(), head.size());
}

CheckpointWriter::~CheckpointWriter() {
  if (std::error_code none; file_) fs::remove(part_, none);
}

void CheckpointWriter::transfer(void* bytes, std::size_t count) {
  if (count == 0) return;  // an empty vector has no address
  sum_.process_bytes(bytes, count);
  if (std::fwrite(bytes, 1, count, file_.get()) != count) fail();
}

void CheckpointWriter::close() {
  const Sum sum = sum_.checksum();
  if (std::fwrite(&sum, sizeof sum, 1, file_.get()) != 1 || std::fflush(file_.get()) != 0 ||
      fsync(fileno(file_.get())) != 0)
    fail();
  std::error_code error, none;
  fs::rename(path_, path_.string() + ".previous", none);  // there may be none
  fs::rename(part_, path_, error);
  if (error) {
    errno = error.value();
    fail();
  }
  file_.reset();
}

void CheckpointWriter::fail() const {
  throw SystemFailure(
      fmt::format("{}: {}; check that its disk has room and may be written to", path_.string(), std::strerror(errno)));
}

CheckpointReader::CheckpointReader(const fs::path& path) : file_(std::fopen(path.c_str(), "rb"), std::fclose) {
  std::error_code error;
  const auto size = file_ ? fs::file_size(path, error) : 0;
  if (!file_ || error)
    throw BadInput("", fmt::format("cannot be read ({})", error ? error.message() : std::strerror(errno)));
  std::string head(magic.size(), '\0');
  if (size < magic.size() + sizeof(Sum) || std::fread(head.data(), head.size(), 1, file_.get()) != 1 || head != magic)
    throw BadInput("", "is no checkpoint, or a damaged one");
  boost::crc_32_type found;
  found.process_bytes(head.data(), head.size());
  std::vector<char> block(1 << 20);
  const std::uint64_t all = size - magic.size() - sizeof(Sum);
  for (left_ = all; left_ > 0;) {
    const std::size_t count = std::min<std::uint64_t>(left_, block.size());
    if (std::fread(block.data(), count, 1, file_.get()) != 1) break;
    found.process_bytes(block.data(), count);
    left_ -= count;
  }
  Sum sum = 0;
  if (left_ > 0 || std::fread(&sum, sizeof sum, 1, file_.get()) != 1 || sum != found.checksum())
    throw BadInput("", "is damaged: its checksum is another one");
  left_ = all;
  std::fseek(file_.get(), static_cast<long>(magic.size()), SEEK_SET);
}

void CheckpointReader::transfer(void* bytes, std::size_t count) {
  if (count > left_ || (count > 0 && std::fread(bytes, count, 1, file_.get()) != 1))
    throw BadInput("", "ends before the state is complete");
  left_ -= count;
}

}  // namespace delf
